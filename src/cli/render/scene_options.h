/* scene_options.h - the options of every verb that shows a scene: scene, materials, lights, camera */
#pragma once

#include "cli/render/assign_options.h"
#include "weft/render.h"

enum { SCENE_LIGHTS_MOST = 64 };

/* The rows of the option table that all these verbs have: camera and lights, how a .png shows them, and materials. */
#define LIGHT_OPTIONS                                                                                                  \
    OPTION_HEADING("View and light"),                                                                                  \
        OPTION_TEXT("--camera", "CAMERA", NULL,                                                                        \
                    "auto, which frames the scene, a camera's name or index, or \"eye;target;fov\" as "                \
                    "\"x,y,z;x,y,z;degrees\" [auto; the first camera of a built-in scene]"),                           \
        OPTION_NUMBER("--time", "SECONDS", NULL, -1e9, 1e9,                                                            \
                      "show the file's animation at this time; before its first key and after its last it stands "     \
                      "still [the file at rest]"),                                                                     \
        OPTION_TEXT("--animation", "NAME", NULL,                                                                       \
                    "the animation of --time, by its name or index, of a file that has several [the first]"),          \
        OPTION_TEXT("--env", "FILE|r,g,b", NULL,                                                                       \
                    "light from a lat-long picture or a cube map, a KTX 2 file, a folder or one of six files posx "    \
                    "negx posy negy posz negz; or one radiance (r,g,b or a number) from everywhere [a studio]"),       \
        OPTION_NUMBER("--env-rotation", "DEGREES", "0", -1e6, 1e6, "turn the environment about the vertical"),         \
        OPTION_NUMBER("--env-strength", "FACTOR", "1", 0, 1e6, "scale the environment"),                               \
        OPTION_NUMBER("--env-ambient", "FACTOR", "1", 0, 1e6, "scale what diffuse lobes and dust reflect of it"),      \
        OPTION_NUMBER("--env-reflection", "FACTOR", "1", 0, 1e6,                                                       \
                      "scale what specular, sheen and coat lobes reflect of it"),                                      \
        OPTION_LIST("--light", "LIGHT",                                                                                \
                    "add a light: \"sun;DIRECTION;COLOR\", \"point;POSITION;COLOR\", "                                 \
                    "\"spot;POSITION;DIRECTION;COLOR;INNER,OUTER\" or "                                                \
                    "\"polygon;POSITION;DIRECTION;W,H;COLOR;CORNERS,ROLL\", each x,y,z or r,g,b, cones and roll in "   \
                    "degrees, 3 to 8 corners; none drops those before it, the file's too")
#define TONE_OPTIONS                                                                                                   \
    OPTION_TEXT("--exposure", "STOPS|auto", "0",                                                                       \
                "brighten a .png by 2^STOPS, -32 to 32; auto: so that the mean of the picture is middle grey"),        \
        OPTION_TEXT("--white-balance", "KELVIN[,TINT]|auto", NULL,                                                     \
                    "show light of this temperature, 1700 to 25000, as white in a .png; a tint above 0, -50 to 50, "   \
                    "is of greener light; auto: the light of the picture [6504]"),                                     \
        OPTION_TEXT("--tonemap", "CURVE", "pbr-neutral",                                                               \
                    "of a .png: none, pbr-neutral, agx, or aces, which is Narkowicz' fit of the ACES curve")

/* Adds the options of a verb whose pictures have a background and a floor. */
#define SCENE_OPTIONS                                                                                                  \
    LIGHT_OPTIONS, TONE_OPTIONS,                                                                                       \
        OPTION_TEXT("--background", "WHAT", "auto",                                                                    \
                    "auto, environment, blurred, transparent or r,g,b, linear, which is shown as it is: "              \
                    "1,1,1 is white"),                                                                                 \
        OPTION_TEXT("--stage", "WHAT", "auto",                                                                         \
                    "auto: a matte floor, where the scene has neither light nor floor of its own, none is given, and " \
                    "the background is auto; none: nothing but what is given"),                                        \
        OPTION_SWITCH("--floor", "a floor that only catches the scene's shadow and mirrors it"),                       \
        OPTION_NUMBER("--floor-reflection", "SHARE", "0.1", 0, 1, "of the scene that the floor mirrors"),              \
        OPTION_NUMBER("--floor-roughness", "ROUGHNESS", "0.3", 0, 1, "of the floor's mirror"),                         \
        OPTION_SWITCH("--hide-lights", "polygon lights shine, but the camera looks through them"),                     \
                                                                                                                       \
        ASSIGN_OPTIONS

typedef struct SceneOptions {
    const Options *options;
    const char *scene;
    bool moves; /* the scene is shown at `moment` */
    WeftMoment moment;
    Assignments assignment;
    const char *camera, *env; /* NULL: none was named */
    WeftTone tone;
    float kelvin, tint;              /* of tone.white; 0: that of the display */
    bool meter_exposure, find_white; /* tone has them when the picture is there */
    double env_rotation, env_strength, env_ambient, env_reflection;
    bool env_is_color;
    float env_color[3];
    WeftBackground background;
    float background_color[3];
    WeftFloor floor;
    bool stage; /* weft_scene_stage says whether there is a floor */
    bool hide_lights;
    WeftLight lights[SCENE_LIGHTS_MOST];
    int light_count;
    bool no_lights; /* without the file's lights */
} SceneOptions;

/* Reads and checks all that can be judged without the scene, of a verb that has the rows of LIGHT_OPTIONS, TONE_OPTIONS and
 * ASSIGN_OPTIONS at least; others leave out what lies behind and below. False after one line on standard error. */
bool scene_options_read(const Options *options, const char *scene, SceneOptions *scene_options);

/* Returns the floor to draw under a scene to which the options were applied. */
WeftFloor scene_options_floor(const SceneOptions *scene_options, const WeftScene *scene);

/* Applies the options of picture number k to a fresh scene, from the asset to its details. */
WeftResult scene_options_apply(const SceneOptions *scene_options, int k, WeftScene *scene, const WeftLog *log,
                               WeftError *error);
