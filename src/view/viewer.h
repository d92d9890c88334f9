/* viewer.h - the window's state, which panels, stage and replay share, one frame after another / */
#ifndef WEFT_VIEW_VIEWER_H
#define WEFT_VIEW_VIEWER_H

#include "view/file_watch.h"
#include "view/history.h"
#include "view/loader.h"
#include "view/renderer.h"
#include "view/settings.h"
#include "view/view.h"
#include "weft/measure.h"
#include "weft/reflection.h"

/* The content of the stage: OpenGL, the path tracer, or their difference. */
typedef enum Mode { MODE_LIVE, MODE_REFERENCE, MODE_DIFFERENCE } Mode;
typedef enum Tool { TOOL_ORBIT, TOOL_PROBE, TOOL_BRUSH } Tool;

/* The kind of picture that is shown. */
typedef enum Shows { SHOWS_NOTHING, SHOWS_DRAWN, SHOWS_TRACED } Shows;

enum { TRACE_SAMPLES = 1024, MESSAGE_SIZE = 512 };

/* The brush that lays the nap. */
typedef struct Brush {
    float radius;       /* m */
    float strength;     /* 0 .. 1, of a stroke */
    bool down;          /* a stroke is under way */
    bool known;         /* `at` is where it was last */
    float at[3], uv[2]; /* last place, in the world and on the map */
    int material;
} Brush;

typedef struct Inspection Inspection;
struct Examination;

/* The panels at the side, in the order of their tabs. */
enum { PANEL_MATERIAL, PANEL_LIGHT, PANEL_VIEW, PANEL_INSPECT, PANEL_DOCTOR };

typedef struct Viewer {
    const ViewDesc *desc;
    Window *window;
    Renderer *renderer;
    ReferenceView *reference;
    Loader *loader;  /* NULL: nothing is being read */
    Loader *leaving; /* a loader that is stopping; NULL: none */
    struct Replay *replay;
    FileWatch *file_watch;
    Settings settings;
    UiInput input;
    double clock; /* s, of this frame */
    long long frame;
    bool ending;

    /* the scene */
    bool has_scene;
    WeftResult opened;                   /* why there is none, where the first could not be had */
    char configured[STATE_PATH];         /* path of the scene that is configured as the command line has it */
    char watched[STATE_PATH];            /* light whose file is watched */
    char lobes[STATE_LOBES][STATE_PATH]; /* files of lobes, which are watched too */
    int lobe_count;
    unsigned scene, scenes; /* number of the one that is shown; of the last one that was read */
    Loaded pending;         /* read, and with the renderer: its state and facts, until that has taken it */
    bool has_pending;
    Facts facts;
    SceneState state, first, before,
        sent;         /* as it is edited; as it was read; a frame ago; as last requested */
    SceneState other; /* the other of A and B; empty without a comparison */
    int side;         /* side that `state` holds: 0 is A */
    History history, other_history;
    int material, light; /* shown in the panels */
    Folders folders;     /* of maps that the scene wears */
    unsigned thumbs;     /* texture: the pictures of its maps */
    WeftMaterial copied;
    bool has_copied;

    /* how it is seen */
    Orbit orbit;
    bool at_home;  /* home and reach are known */
    float home[3]; /* what the first camera looks at, m */
    float reach;   /* half the distance from there, m: how large things are */
    Mode mode;
    Split split;
    float split_at;
    WeftBackground background;
    float background_color[3];
    WeftFloor floor;
    bool hide_lights;
    WeftTonemap tonemap;
    float exposure;
    WeftPart part;
    WeftAmbient ambient;
    Tool tool;
    Brush brush;
    UiBox stage; /* pixels of the window */
    int panel;   /* the open panel: PANEL_MATERIAL ... */

    /* what came back */
    RenderedFrame rendered;
    unsigned requested;   /* number of the last request */
    FrameRequest request; /* the last request; the states are empty */
    bool ask;             /* a request is due */
    double changed;       /* when the last one was another than the one before, s */
    bool late;            /* the renderer is at something long: it is not waited for */
    unsigned reference_texture;
    int reference_width, reference_height;
    ReferenceFrame traced; /* without its image */
    Probe probe;
    bool has_probe;
    unsigned profiles_texture; /* sheet of all profiles */
    int profiles_width, profiles_height;
    bool profiles_open, profiles_made;
    WeftImage profiles;
    Inspection *inspection;
    struct Examination *examination; /* of the file that is open; NULL: it was not asked for */

    /* words */
    char message[MESSAGE_SIZE];
    bool message_grave;
    char warnings[8192];                      /* of scene and files, one a line */
    char shader_complaint[512], failure[512]; /* last reported to the user */

    /* dialogs */
    struct Browser *browser;
    bool help_open, warnings_open;
    char open_dialog[32]; /* to be opened in this frame */
    char save_path[STATE_PATH], shot_path[STATE_PATH];
    int shot_width, shot_height;
    bool shot_transparent, shot_traced;
    char dropped[STATE_PATH]; /* an image whose input is still to be chosen */
    int dropped_input;

    /* of the mouse on the stage */
    bool pressed[3], moved;
    float press_x, press_y, last_x, last_y;
    int dragged_light; /* whose handle is dragged, -1 none */
    bool dragged_split;
    unsigned stamps;

    /* rates */
    double frame_seconds; /* mean of late */
    double picture_seconds;
    double worst_seconds; /* longest frame since the last report */
} Viewer;

/* A line for the status bar; a grave one is in a warning's colour. */
void viewer_say(Viewer *v, bool grave, const char *format, ...) __attribute__((format(printf, 3, 4)));

/* Opens what a path is: a scene is read in the background; an environment lights the scene, a material file
 * dresses it, a lobe is taken, a picture asks what it is for, a folder of maps is worn. */
void viewer_open(Viewer *v, const char *path);

/* Actions of menus, keys and replays. */
void viewer_accept_state(
    Viewer *v); /* accepts a state that undo or an event has set: it makes no step of history */
void viewer_undo(Viewer *v);
void viewer_copy_material(Viewer *v);
void viewer_paste_material(Viewer *v);
void viewer_light_by(Viewer *v, const char *path); /* a picture, or the folder of a cubemap */
void viewer_redo(Viewer *v);
void viewer_mode(Viewer *v, Mode mode);
void viewer_split(Viewer *v, Split split);
void viewer_next_material(Viewer *v, int by); /* of those that something wears */
void viewer_make_fibre(Viewer *v);            /* gives the chosen material a sheen with a nap to brush */
void viewer_swap(Viewer *v);                  /* edits the other of A and B */
void viewer_frame_selection(Viewer *v);
void viewer_reset_camera(Viewer *v);
void viewer_shot(Viewer *v, const char *path);
void viewer_save(Viewer *v, const char *path);
void viewer_task(Viewer *v, TaskKind kind, const char *path, int index, int input);
void viewer_copy_command(Viewer *v);
void viewer_profiles(Viewer *v);
void viewer_dialog(Viewer *v, const char *name);

/* Changes a material of the state. */
void viewer_set_material(Viewer *v, int index, const WeftMaterial *material);

/* The newest picture of the scene: the path traced one where it is asked for, or where OpenGL has none of
 * that request yet. */
Shows viewer_shows(const Viewer *v);
const char *shows_name(Shows shows); /* "nothing", "drawn", "traced" */

/* Returns true if all that was requested is shown: nothing is being read, drawn or compiled. */
bool viewer_is_idle(Viewer *v);

/* "WxH" pixels of the stage. */
float viewer_aspect(const Viewer *v);

/* Shows the maps of the facts. */
void viewer_show_maps(Viewer *v);

/* A texture from U8 RGB or RGBA. */
void viewer_upload(unsigned *texture, const WeftImage *image);

/* stage.c: the picture, and what the mouse does on it */
void stage_input(Viewer *v);
void stage_draw(Viewer *v);
/* Takes the surface point under the mouse, which the stage asked for. */
void stage_picked(Viewer *v, const RenderEvent *event);

/* panels, one file each */
void menu_draw(Viewer *v);
void status_draw(Viewer *v);
void material_panel(Viewer *v);
void light_panel(Viewer *v);
void view_panel(Viewer *v);
void inspect_panel(Viewer *v);
void doctor_panel(Viewer *v);
bool doctor_busy(const Viewer *v); /* returns true if more is to come in a later frame */
void dialogs_draw(Viewer *v);
void keys_input(Viewer *v);
void inspection_free(Inspection *inspection);
bool inspection_busy(const Inspection *inspection); /* returns true if measuring goes on in the next frame */

/* command.c: the command line that draws what the window shows. Release with free; NULL where memory is
 * short; `lost` (may be NULL) is set if a painted nap is not in it. */
char *command_line(const Viewer *v, bool *lost);

#endif
