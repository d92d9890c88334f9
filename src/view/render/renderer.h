/* renderer.h - the thread that owns the scene and draws it, so that the window never waits for a shader, a
 * table or a file
 *
 * The window requests frames as often as it likes. The renderer works on the latest request only: it applies the
 * requested state to the scene and returns a finished picture as a texture that both OpenGL contexts share. Work that
 * is done once, such as writing a file or probing a pixel, is a task. Tasks are done in order and answered by
 * events. */
#pragma once

#include "view/render/loader.h"
#include "view/render/orbit.h"
#include "view/render/reference_view.h"
#include "view/render/scene_state.h"
#include "view/ui/window.h"
#include "weft/raster.h"

typedef struct Renderer Renderer;

/* The arrangement of two states in one picture. */
typedef enum Split { SPLIT_NONE, SPLIT_LINE, SPLIT_SIDES } Split;

/* The quality of a picture. coarse: while the mouse moves, fewer points of shading if a full picture would be slow;
 * whole: one a pixel; smooth: antialiased edges too. */
typedef enum Effort { EFFORT_COARSE, EFFORT_WHOLE, EFFORT_SMOOTH } Effort;

/* A request for a picture. It holds only values that change the picture. */
typedef struct FrameRequest {
    unsigned scene;          /* number of the scene (renderer_set_scene) */
    int edited;              /* the state that tasks change: 0 is `state`, 1 is `other` */
    unsigned view_number;    /* of the path tracer's view (reference_request) */
    unsigned state_number;   /* of the edited state, incremented when it changes; not 0 */
    SceneState state, other; /* `other` is the right side of a split picture; empty without a split */
    Split split;
    float at;            /* SPLIT_LINE: position of the line, as a fraction of the width */
    WeftRasterView view; /* except its camera, which is the text below */
    char camera[ORBIT_TEXT];
    float behind[3];  /* linear colour behind transparent pixels, after tone mapping */
    bool laid_behind; /* saved pictures have this colour too; otherwise they stay transparent */
    WeftTonemap tonemap;
    float exposure; /* stops */
    float white[2]; /* as WeftTone has it */
    bool metered;   /* the picture's exposure and white are metered */
    Effort effort;  /* the requested quality */
    int accumulate; /* frames to sum once the picture is at rest (weft_raster_accumulate_begin); 0: none */
    bool reference; /* the path tracer shows this view: OpenGL draws only what `compare` needs */
    bool compare;   /* a linear copy of the picture goes to the path tracer */
} FrameRequest;

/* Copies a request; the copy shares the parts of its states. Returns false if memory is short, and leaves
 * `copy` alone. */
bool frame_request_copy(FrameRequest *copy, const FrameRequest *request);
void frame_request_free(FrameRequest *request); /* frees its states */

typedef enum TaskKind {
    TASK_SHOT,      /* writes a picture of `width` x `height` to `path` */
    TASK_SAVE,      /* writes the scene, or material `index`, to `path` */
    TASK_COPY,      /* saves the scene to `path`, without a word, for a picture in the background */
    TASK_PROBE,     /* describes the point at x, y of the request's picture, with the parts of its light */
    TASK_PICK,      /* describes the point without its light */
    TASK_PROFILES,  /* draws a sheet with material `index` under every profile */
    TASK_ASSIGN,    /* `path`: a material file or "preset:NAME" for `index`; a picture, if `input` >= 0 */
    TASK_BIND_MAPS, /* puts the maps in folder `path` on material `index`; -1: on the cloth of the scene */
    TASK_WEAVE,     /* weaves material `index` of other yarns, and inverts a crossing of its draft */
    TASK_WEAVE_KEY, /* sets `key` of the weave of material `index` to the text in `path` (weft_scene_weave) */
    TASK_LIGHT,     /* `path` is a picture, or the folder of a cubemap, that becomes the environment */
    TASK_SCENE,     /* no task, but an event: a new scene was taken over, or cannot be drawn */
    TASK_SURVEY     /* no task, but an event: coverage by each material, after a change of variant */
} TaskKind;

typedef struct Task {
    TaskKind kind;
    unsigned scene; /* number of its scene; tasks of another scene are dropped */
    char path[STATE_PATH];
    int index, input;  /* material (TASK_BIND_MAPS, TASK_ASSIGN: -1 for all cloth) and input (-1: none) */
    float x, y;        /* pixels of the request's picture, from the top left */
    int width, height; /* pixels; 0: as the request */
    bool transparent;  /* TASK_SHOT: the background of the file stays transparent */
    bool floor;        /* TASK_SHOT: with the floor of the request's view */
    bool reference;    /* TASK_SHOT: writes the path-traced picture with the samples that it has so far */
    bool nap;          /* TASK_PICK: the event has the material's own nap map too */
    unsigned stamp;    /* any number; the event has the same */
    WeftYarn yarns[2]; /* TASK_WEAVE: of warp and weft */
    int warp, pick;    /* TASK_WEAVE: the crossing; pick -1: none */
    char key[32];      /* TASK_WEAVE_KEY */
} Task;

/* The surface at a pixel, and the parts of its light. */
typedef struct Probe {
    bool hit;
    int material;
    float position[3], normal[3], texcoord[2], distance;
    float uv_per_metre; /* UV units that a metre on the surface spans */
    float tangent[3], bitangent[3];
    float value[WEFT_PART_COUNT][3]; /* by WeftPart; TASK_PROBE sets those that the window shows */
} Probe;

typedef struct RenderEvent {
    TaskKind kind;
    unsigned scene; /* number of the scene this event is about */
    bool failed;
    WeftResult result;     /* TASK_SCENE */
    char text[512];        /* a line for people */
    char path[STATE_PATH]; /* TASK_BIND_MAPS: the folder; TASK_COPY: the file */
    unsigned stamp;
    Probe probe;
    WeftImage image;    /* TASK_PROFILES: the sheet, U8 RGB; TASK_PICK: the nap map, if none was brushed; owned */
    bool state_changed; /* `state` is then the state of the scene after the task; owned */
    SceneState state;
    Facts maps;      /* set if maps changed; only its maps and cloths are filled; owned */
    float *coverage; /* TASK_SURVEY: share of the picture by each material (survey.h); owned, may be NULL */
    int index;       /* `index` of the task; TASK_BIND_MAPS: the number of maps */
} RenderEvent;

/* The latest picture and its state. */
typedef struct RenderedFrame {
    unsigned texture; /* 0: nothing yet */
    unsigned before;  /* picture in motion of the same view and size, which the finer one replaced; 0: none */
    int width, height;
    unsigned scene;               /* number of the scene that is shown */
    unsigned number;              /* number of the request that is shown (renderer_request) */
    bool focused;                 /* `target` is the surface point in the middle of the picture */
    Effort effort;                /* quality */
    int summed, sum_frames;       /* frames of a sum that the picture has, and will have; 0: it is not one */
    float seconds;                /* s, for this picture */
    float whole_seconds;          /* s, for a picture with all pixels */
    float eye[3], target[3], fov; /* m; fov in degrees, vertical */
    int programs, compiled;       /* shader programs in use, and compiled since the start */
    bool busy;                    /* shaders, tables or occlusion are still being computed */
    bool metered;                 /* exposure and white are those of the picture (weft_image_meter) */
    float exposure;               /* stops */
    float white[2];               /* as weft_image_find_white has it */
    char complaint[512];          /* the compiler's message about changed shader text; "" if all compiles */
    char failure[512];            /* the reason why there is no newer picture */
    char driver[128];
} RenderedFrame;

/* Starts the thread. window and reference must outlive the renderer; shader_dir (may be NULL) and occlusion are as in
 * WeftRasterDesc. Returns NULL if memory or threads are short. Without a second OpenGL context the frame has a
 * `failure`. */
Renderer *renderer_start(Window *window, ReferenceView *reference, const char *shader_dir, int occlusion);
void renderer_stop(Renderer *renderer);

/* Takes the scene over and copies `state`, which describes it. The old scene is released once the new one can be drawn.
 * An event of TASK_SCENE reports the outcome. Requests and tasks whose `scene` is not `number` are dropped. Folders of
 * maps in use are watched. */
void renderer_set_scene(Renderer *renderer, WeftScene *scene, const SceneState *state, const Folders *folders,
                        unsigned number);

/* Copies the request and returns its number, or the number of the request before if memory is short. */
unsigned renderer_request(Renderer *renderer, const FrameRequest *request);
bool renderer_add_task(Renderer *renderer, const Task *task);

/* Copies the newest picture over the last that was taken; returns true if it is newer. Its textures stay as they are until
 * the next call. */
bool renderer_take_frame(Renderer *renderer, RenderedFrame *rendered);

/* Returns true if a picture or an event is ready to be taken. */
bool renderer_has_output(Renderer *renderer);

/* Takes the oldest event; returns false if there is none. Release with render_event_free. */
bool renderer_take_event(Renderer *renderer, RenderEvent *event);
void render_event_free(RenderEvent *event);

/* Returns true if all requests and tasks are done. */
bool renderer_is_idle(Renderer *renderer);

/* Returns the warnings since the last call, one a line, or NULL if there are none. Release with free. */
char *renderer_take_warnings(Renderer *renderer);
