/* view.c - `weft view`: the options of the window */
#include "view/render/view.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cli/console/interrupt.h"
#include "cli/console/report.h"
#include "cli/operands/command.h"
#include "cli/operands/root.h"
#include "cli/render/scene_options.h"
#include "cli/verbs/verbs.h"

enum { FRAMES = 256 }; /* default of --accumulate */

static const Option view_options[] = {
    OPTION_HEADING("Window"),
    OPTION_WHOLE("--width", "PIXELS", NULL, 320, 16384, "width of the window [as it was last time, 1280]"),
    OPTION_WHOLE("--height", "PIXELS", NULL, 240, 16384, "height of the window [as it was last time, 720]"),
    OPTION_NUMBER("--scale", "FACTOR", NULL, 0.5, 4, "size of its panels and words [as the display asks, 1]"),
    OPTION_WHOLE("--occlusion", "RAYS", "64", 0, 4096,
                 "look from each vertex along so many rays, for what lies in creases and in shadow of a map"),
    OPTION_WHOLE("--accumulate", "COUNT", NULL, 0, WEFT_RASTER_FRAMES_MOST,
                 "while nothing changes, take the mean of so many frames, which converges to the path tracer's direct "
                 "light; 0: never [256; 0 with --script]"),
    OPTION_WHOLE("--bounces", "COUNT", "1", 0, 1,
                 "and let light bounce once between surfaces in them, until it is switched off; 0: not at first"),
    OPTION_TEXT("--shader-dir", "DIR", NULL,
                "shader text found here wins over the built-in one, and is compiled anew as it changes"),

    OPTION_ROOT,
    SCENE_OPTIONS,

    OPTION_HEADING("Automation"),
    OPTION_TEXT("--script", "FILE", NULL, "replay the actions in FILE; docs/view.md lists them"),
    OPTION_WHOLE("--frames", "COUNT", NULL, 1, 1e9, "close after so many frames, once the scene has been read"),
    OPTION_SWITCH("--windowless", "run without a window, for replays without a display"),
    OPTION_SWITCH("--forget", "neither read nor write settings and sessions"),
    OPTION_SWITCH("--json", "print a line of JSON whenever the window comes to rest: what it shows, and where its "
                            "controls are"),
    OPTION_END,
};

static WeftResult configure_scene(void *user, WeftScene *scene, EnvironmentState *environment, const WeftLog *log,
                                  WeftError *error) {
    const SceneOptions *scene_options = user;
    environment->rotation = (float)scene_options->env_rotation;
    environment->strength = (float)scene_options->env_strength;
    environment->ambient = (float)scene_options->env_ambient;
    environment->reflection = (float)scene_options->env_reflection;
    if (scene_options->env_is_color) {
        environment->kind = ENVIRONMENT_COLOR;
        memcpy(environment->color, scene_options->env_color, sizeof environment->color);
    } else if (scene_options->env && strlen(scene_options->env) < sizeof environment->path) {
        environment->kind = ENVIRONMENT_FILE;
        snprintf(environment->path, sizeof environment->path, "%s", scene_options->env);
    }
    return scene_options_apply(scene_options, 0, scene, log, error);
}

/* Returns the folder of maps that is put on the cloth by default: in the current folder, or beside the program. */
static const char *materials_beside(char path[4096]) {
    static const char folder[] = "Models/Materials/0";
    struct stat s;
    if (stat(folder, &s) == 0 && S_ISDIR(s.st_mode)) return folder;
    ssize_t length = readlink("/proc/self/exe", path, 4096 - sizeof folder - 1);
    while (length > 0 && path[length - 1] != '/') length--;
    if (length <= 0) return NULL;
    memcpy(path + length, folder, sizeof folder);
    return stat(path, &s) == 0 && S_ISDIR(s.st_mode) ? path : NULL;
}

static bool read_sizes(const Options *options, ViewDesc *desc) {
    double scale = 0.0;
    if (option_given(options, "--scale") && !option_number(options, "--scale", &scale)) return false;
    desc->scale = (float)scale;
    return option_integer(options, "--width", &desc->width) && option_integer(options, "--height", &desc->height) &&
           option_integer(options, "--frames", &desc->frames) &&
           option_integer(options, "--accumulate", &desc->accumulate) &&
           option_integer(options, "--bounces", &desc->bounces) &&
           option_integer(options, "--occlusion", &desc->occlusion);
}

static int view_verb_run(const Options *options) {
    SceneOptions scene_options;
    ViewDesc desc = {.scene = options->operand_count ? options->operands[0] : NULL};
    char why[512], beside[4096];
    if (!scene_options_read(options, desc.scene ? desc.scene : "builtin:cloth", &scene_options) ||
        !read_sizes(options, &desc))
        return WEFT_USAGE;
    if (scene_options.assignment.count > 1)
        return report(WEFT_USAGE, "%s: the window shows one picture: give one value",
                      scene_options.assignment.varied[0].option);
    desc.configure = configure_scene;
    desc.moment = scene_options.moves ? &scene_options.moment : NULL;
    desc.user = &scene_options;
    desc.camera = scene_options.camera;
    desc.background = scene_options.background;
    memcpy(desc.background_color, scene_options.background_color, sizeof desc.background_color);
    desc.floor = scene_options.floor;
    desc.stage = scene_options.stage;
    desc.hide_lights = scene_options.hide_lights;
    desc.tonemap = scene_options.tone.curve;
    desc.exposure = scene_options.tone.exposure;
    desc.metered = scene_options.meter_exposure;
    desc.kelvin = scene_options.kelvin, desc.tint = scene_options.tint;
    desc.balanced = scene_options.find_white;
    desc.shader_dir = option_text(options, "--shader-dir");
    if (!option_given(options, "--materials")) desc.materials = materials_beside(beside);
    desc.lobes = lobes_taken();
    desc.script = option_text(options, "--script");
    if (!desc.script && !option_given(options, "--accumulate")) desc.accumulate = FRAMES;
    desc.unseen = option_given(options, "--windowless");
    desc.forget = option_given(options, "--forget");
    desc.report = option_given(options, "--json");
    char *configured = command_assign_text(options);
    desc.options = configured;
    desc.interrupted = interrupt_seen;
    interrupt_watch();
    int code = view_run(&desc, why);
    free(configured);
    return code ? report(code, "%s", why) : 0;
}

const Verb verb_view = {
    .name = "view",
    .operands = "[SCENE] [options]",
    .help = "opens a look-dev window: edit a scene, compare with ground truth",
    .operands_least = 0,
    .operands_most = 1,
    .options = view_options,
    .notes = "SCENE is a .gltf or .glb file, builtin:NAME or a material .u3m, which\n"
             "builtin:cloth then has; without it, builtin:cloth. Files can be dropped on the\n"
             "window: scenes, light (.hdr .exr, or a folder with a cube map: posx.jpg,\n"
             "negx.jpg and so on), materials (.json .u3m .u3ma), lobes of your own (.h),\n"
             "pictures. Files that change on disk are reloaded. ? in the window lists keys and\n"
             "mouse.\n\n"
             "Examples\n"
             "  weft view SheenChair.glb\n"
             "  weft view builtin:cloth --preset velvet --light \"sun;-1,-2,-1;3,3,3\"\n"
             "  weft view velvet.glb --materials maps/ --env studio.hdr\n"
             "  weft view --windowless --script tour.txt --frames 2000\n",
    .run = view_verb_run,
};
