/* viewer.h - the window's state, which panels, stage and replay share, one frame after another / */
#ifndef WEFT_VIEW_VIEWER_H
#define WEFT_VIEW_VIEWER_H

#include "view/files/file_watch.h"
#include "view/files/settings.h"
#include "view/render/loader.h"
#include "view/render/renderer.h"
#include "view/render/view.h"
#include "view/state/history.h"
#include "weft/measure.h"
#include "weft/reflection.h"

/* The content of the stage: OpenGL, the path tracer, or their difference. */
typedef enum Mode { MODE_LIVE, MODE_REFERENCE, MODE_DIFFERENCE } Mode;
typedef enum Tool { TOOL_ORBIT, TOOL_PROBE, TOOL_BRUSH } Tool;

/* The kind of picture that is shown. */
typedef enum Shows { SHOWS_NOTHING, SHOWS_DRAWN, SHOWS_TRACED } Shows;

enum { TRACE_SAMPLES = 1024, MESSAGE_SIZE = 512 };

/* The panels at the side, in the order of their tabs. */
enum { PANEL_MATERIAL, PANEL_LIGHT, PANEL_VIEW, PANEL_INSPECT, PANEL_DOCTOR };

typedef struct Inspection Inspection;
struct Examination;

/* ---- the rooms: each is written by the one file that its comment names, through rooms.h, and read by all ---- */

/* viewer.c: what belongs to the window and to this frame. */
typedef struct WindowRoom {
    Settings settings;
    UiInput input;
    double clock; /* s, of this frame */
    long long number;
    bool ending;
    UiBox stage; /* pixels of the window */
    char message[MESSAGE_SIZE];
    bool message_grave;
    double frame_seconds; /* mean of late */
    double picture_seconds;
    double worst_seconds; /* longest frame since the last report */
} WindowRoom;

/* opening.c: files that are read, and watched. */
typedef struct OpeningRoom {
    Loader *loader;    /* NULL: nothing is being read */
    Loader *leaving;   /* a loader that is stopping; NULL: none */
    WeftResult opened; /* why there is none, where the first could not be had */
    FileWatch *file_watch;
    char configured[STATE_PATH];         /* path of the scene that is configured as the command line has it */
    char watched[STATE_PATH];            /* light whose file is watched */
    char lobes[STATE_LOBES][STATE_PATH]; /* files of lobes, which are watched too */
    int lobe_count;
    unsigned scenes; /* number of the last scene that was read */
    Loaded pending;  /* read, and with the renderer: its state and facts, until that has taken it */
    bool has_pending;
} OpeningRoom;

/* opening.c: the scene that is shown. */
typedef struct ShownRoom {
    bool any;
    unsigned number;
    Facts facts;
    Folders folders;       /* of maps that the scene uses */
    unsigned maps_texture; /* the pictures of its maps */
    char warnings[8192];   /* of scene and files, one a line */
} ShownRoom;

enum { ASSIGNMENTS = 16 };

/* A material that a task is about to replace, as it was when the task was sent. */
typedef struct Assignment {
    unsigned stamp;
    int material;
    WeftMaterial was;
} Assignment;

/* edit.c: what is edited, and what was. */
typedef struct EditRoom {
    SceneState state, first, before; /* as it is edited; as it was read; a frame ago */
    SceneState other;                /* the other of A and B; empty without a comparison */
    int side;                        /* side that `state` holds: 0 is A */
    Split split;
    History history, other_history;
    int material, light; /* shown in the panels */
    WeftMaterial copied;
    bool has_copied;
    Assignment assignments[ASSIGNMENTS]; /* under way, in the order they were sent */
    int assignment_count;
    unsigned stamp; /* of the last */
} EditRoom;

/* view_options.c: how the scene is seen. */
typedef struct ViewOptions {
    Mode mode;
    float split_at;
    WeftBackground background;
    float background_color[3];
    WeftFloor floor;
    bool hide_lights;
    WeftTonemap tonemap;
    float exposure; /* stops */
    WeftPart part;
    WeftAmbient ambient;
    Tool tool;
    float brush_radius;   /* m */
    float brush_strength; /* 0 to 1, of a stroke */
    int panel;            /* the open panel: PANEL_MATERIAL ... */
} ViewOptions;

/* view_camera.c: where it is seen from. */
typedef struct CameraRoom {
    Orbit orbit;
    bool at_home;  /* home and reach are known */
    float home[3]; /* what the first camera looks at, m */
    float reach;   /* half the distance from there, m: how large things are */
} CameraRoom;

/* frame_requests.c: frames that were asked for, and what came back. */
typedef struct RequestsRoom {
    RenderedFrame rendered;
    unsigned requested;   /* number of the last request */
    FrameRequest request; /* the last request; the states are empty */
    SceneState sent;      /* as last requested */
    bool ask;             /* a request is due */
    double changed;       /* when the last one was another than the one before, s */
    bool late;            /* the renderer is at something long: it is not waited for */
    unsigned reference_texture;
    ReferenceFrame traced; /* without its image */
    Probe probe;
    bool has_probe;
    char shader_complaint[512], failure[512]; /* last reported to the user */
} RequestsRoom;

/* dialogs.c: dialogs, and what is entered in them. */
typedef struct DialogsRoom {
    struct Browser *browser;
    bool help, warnings_shown;
    char due[32]; /* to be opened in this frame */
    char save_path[STATE_PATH], shot_path[STATE_PATH];
    int shot_width, shot_height;
    bool shot_transparent, shot_traced;
    char dropped[STATE_PATH]; /* an image whose input is still to be chosen */
    int dropped_input;
    bool profiles_open, profiles_made;
    WeftImage profiles; /* sheet of all profiles */
    unsigned profiles_texture;
} DialogsRoom;

/* The brush's stroke that is under way. */
typedef struct Stroke {
    bool down;
    bool known;         /* `at` is where it was last */
    float at[3], uv[2]; /* last place, in the world and on the map */
    int material;
} Stroke;

/* stage.c: what the mouse does on the picture. */
typedef struct DragRoom {
    bool pressed[3], moved;
    float press_x, press_y, last_x, last_y;
    int light; /* whose handle is dragged, -1 none */
    bool split;
    unsigned stamps;
    Stroke stroke;
} DragRoom;

/* weave_panel.c: yarns that are being changed. */
typedef struct WeaveRoom {
    unsigned scene; /* number of the scene */
    int cloth;      /* of it, as it is shown; 0: none */
    WeftYarn yarns[2];
    bool changed; /* and not yet woven */
} WeaveRoom;

typedef struct Viewer {
    const ViewDesc *desc;
    Window *window;
    Renderer *renderer;
    ReferenceView *reference;
    struct Replay *replay;
    Inspection *inspection; /* inspect_panel.c's */
    struct Examination
        *examination; /* doctor_panel.c's: of the file that is open; NULL: it was not asked for */
    const WindowRoom *frame;
    const OpeningRoom *opening;
    const ShownRoom *shown;
    const EditRoom *edit;
    const ViewOptions *options;
    const CameraRoom *camera;
    const RequestsRoom *requests;
    const DialogsRoom *dialogs;
    const DragRoom *drag;
    const WeaveRoom *weave;
    struct Rooms *rooms; /* the same, for their owners */
} Viewer;

/* Makes one with empty rooms; NULL where memory is short. Release with free, and what is in its rooms before. */
Viewer *viewer_create(const ViewDesc *desc);

/* A line for the status bar; a grave one is in a warning's colour. */
void viewer_say(Viewer *v, bool grave, const char *format, ...) __attribute__((format(printf, 3, 4)));

/* Ends the program after this frame. */
void viewer_quit(Viewer *v);

void viewer_set_settings(Viewer *v, const Settings *settings);
void viewer_opened(Viewer *v, const char *path); /* makes a path the first of the recent files */

/* Opens what a path is: a scene is read in the background; an environment lights the scene, a material file is
 * assigned, a lobe is taken, a picture asks what it is for, the maps of a folder are bound. */
void viewer_open(Viewer *v, const char *path);

/* Actions of menus, keys and replays. */
void viewer_light_by(Viewer *v, const char *path); /* a picture, or the folder of a cubemap */
void viewer_task(Viewer *v, TaskKind kind, const char *path, int index, int input);
void viewer_copy_command(Viewer *v);

/* edit.c. SceneState *edit_state is what panels change; what differs at the end of a frame is a step of history. */
SceneState *edit_state(Viewer *v);
void edit_begin(Viewer *v, const SceneState *state, const SceneState *before,
                const SceneState *first); /* takes them */
void edit_forget(Viewer *v);
void edit_note_changes(Viewer *v, bool held); /* at the end of a frame; held: it goes on in the next */
void edit_choose_material(Viewer *v, int material);
void edit_choose_light(Viewer *v, int light);
void edit_forget_copy(Viewer *v);
void edit_match_other(Viewer *v); /* makes the other of A and B equal */
void edit_take_light(Viewer *v,
                     const EnvironmentState *environment); /* takes a light that the renderer has read */
unsigned edit_assign(Viewer *v,
                     int material); /* a stamp for a task that replaces a material; 0: none is left */
void edit_end_assign(Viewer *v, unsigned stamp);
/* Takes what a task has made; of a material with a stamp, what was changed since the task was sent stays. */
void edit_take_assigned(Viewer *v, SceneState *state, unsigned stamp);
void viewer_undo(Viewer *v);
void viewer_redo(Viewer *v);
void viewer_copy_material(Viewer *v);
void viewer_paste_material(Viewer *v);
void viewer_set_material(Viewer *v, int index, const WeftMaterial *material);
void viewer_split(Viewer *v, Split split);
void viewer_swap(Viewer *v);                  /* edits the other of A and B */
void viewer_next_material(Viewer *v, int by); /* of those that something uses */
void viewer_make_fibre(Viewer *v);            /* gives the chosen material a sheen with a nap to brush */

/* view_options.c */
void options_begin(Viewer *v);
void options_set(Viewer *v, const ViewOptions *options); /* into their ranges */
void viewer_show_mode(Viewer *v, Mode mode);
void viewer_mode(Viewer *v, Mode mode); /* or OpenGL, where it is that mode already */
void viewer_part(Viewer *v, WeftPart part);
void viewer_panel(Viewer *v, int panel);
void viewer_tool(Viewer *v, Tool tool);
void viewer_toggle_floor(Viewer *v);
void viewer_toggle_lights(Viewer *v);

/* view_camera.c */
void camera_set(Viewer *v, const Orbit *orbit);
void camera_stand_at(Viewer *v, const char *name); /* a camera of the scene, by name or number */
void camera_begin(Viewer *v, const WeftScene *scene, const char *name); /* of a scene that was read */
void camera_found(Viewer *v, const RenderedFrame *frame); /* where a camera of the scene stands */
void viewer_frame_selection(Viewer *v);
void viewer_reset_camera(Viewer *v);

/* dialogs.c. A path of NULL asks for one. */
bool dialogs_begin(Viewer *v);
void dialogs_end(Viewer *v); /* the folder of the browser goes to the settings */
void dialogs_draw(Viewer *v);
void dialogs_toggle_help(Viewer *v);
void dialogs_toggle_warnings(Viewer *v);
void dialogs_close_windows(Viewer *v);
void dialogs_forget_paths(Viewer *v);
void dialogs_ask_use(Viewer *v, const char *path, int input); /* what a picture is for, an input proposed */
void dialogs_choose_map(Viewer *v, int input);
void dialogs_take_profiles(Viewer *v, WeftImage *sheet); /* takes it; NULL: it is out of date */
void viewer_dialog(Viewer *v, const char *name);
void viewer_shot(Viewer *v, const char *path);
void viewer_shot_stage(Viewer *v, const char *path); /* of the stage's size, path traced if that is shown */
void viewer_save(Viewer *v, const char *path);
void viewer_profiles(Viewer *v);

/* The newest picture of the scene: the path traced one where it is asked for, or where OpenGL has none of
 * that request yet. */
Shows viewer_shows(const Viewer *v);
const char *shows_name(Shows shows); /* "nothing", "drawn", "traced" */

/* Returns true if all that was requested is shown: nothing is being read, drawn or compiled. */
bool viewer_is_idle(const Viewer *v);

/* The size of the frames that are asked for: the stage, 16 pixels at least. */
void viewer_picture_size(const Viewer *v, int *width, int *height);

/* Returns width over height of the stage. */
float viewer_aspect(const Viewer *v);

/* A texture from U8 RGB or RGBA. */
void viewer_upload(unsigned *texture, const WeftImage *image);

/* stage.c: the picture, and what the mouse does on it */
void stage_begin(Viewer *v);
void stage_input(Viewer *v);
void stage_draw(Viewer *v);
/* Takes the surface point under the mouse, which the stage asked for. */
void stage_picked(Viewer *v, const RenderEvent *event);

/* panels, one file each */
void menu_draw(Viewer *v);
void status_draw(Viewer *v);
void material_panel(Viewer *v);
void weave_section(Viewer *v, const WeftMaterial *m); /* of the material's panel, where it is woven */
void light_panel(Viewer *v);
void view_panel(Viewer *v);
void inspect_panel(Viewer *v);
void doctor_panel(Viewer *v);
bool doctor_busy(const Viewer *v); /* returns true if more is to come in a later frame */
void doctor_forget(Viewer *v);     /* what was found in a file that is no longer open */
void keys_input(Viewer *v);
void inspection_free(Inspection *inspection);
bool inspection_busy(const Inspection *inspection); /* returns true if measuring goes on in the next frame */

/* render_command.c: the command line that draws what the window shows. Release with free; NULL where memory is
 * short; `lost` (may be NULL) is set if a painted nap is not in it. */
char *command_line(const Viewer *v, bool *lost);

#endif
