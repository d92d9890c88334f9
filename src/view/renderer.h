/* renderer.h - the thread that owns the scene and draws it, so that the window never waits for a shader, a
 * table or a file
 *
 * The window says what it wants to see, as often as it likes: the renderer takes the latest, brings the scene
 * to it and hands over a finished picture as a texture that both contexts share. What is done once (a file to
 * write, a pixel to look at) is a task: tasks are done in their order and answered by events. */
#ifndef WEFT_VIEW_RENDERER_H
#define WEFT_VIEW_RENDERER_H

#include "view/loader.h"
#include "view/orbit.h"
#include "view/reference_view.h"
#include "view/scene_state.h"
#include "view/window.h"
#include "weft/raster.h"

typedef struct Renderer Renderer;

/* The arrangement of two states in one picture. */
typedef enum Split { SPLIT_NONE, SPLIT_LINE, SPLIT_SIDES } Split;

/* The quality of a picture: fewer pixels while the mouse moves if all would take long, then all pixels, then
 * smooth edges. */
typedef enum Effort { EFFORT_COARSE, EFFORT_WHOLE, EFFORT_SMOOTH } Effort;

/* A request for a picture. It holds only values that change the picture. */
typedef struct FrameRequest {
    unsigned scene;          /* number of the scene (renderer_set_scene) */
    int edited;              /* tasks are done to `state` (0) or to `other` (1) */
    SceneState state, other; /* `other` on the right, where they share it; empty otherwise */
    Split split;
    float at;            /* SPLIT_LINE: share of the width that is left of it */
    WeftRasterView view; /* size, background, part, ambient; the camera is the text below */
    char camera[ORBIT_TEXT];
    float behind[3];  /* light of the display, where the picture is transparent */
    bool laid_behind; /* also in pictures that are saved */
    WeftTonemap tonemap;
    float exposure;
    Effort effort;  /* the least that is asked for */
    bool reference; /* nothing is to be drawn: the path tracer does it */
    bool compare;   /* a linear copy is to be handed to the path tracer */
} FrameRequest;

/* Copies a request; the copy shares the parts of its states. Returns false if memory is short, and leaves
 * `copy` alone. */
bool frame_request_copy(FrameRequest *copy, const FrameRequest *request);
void frame_request_free(FrameRequest *request); /* frees its states */

typedef enum TaskKind {
    TASK_SHOT,      /* a picture of `view`'s size to `path` */
    TASK_SAVE,      /* the scene, or material `index`, to `path` */
    TASK_PROBE,     /* what is at x, y of the request's picture */
    TASK_PICK,      /* the same without the parts of its light */
    TASK_PROFILES,  /* small pictures with material `index` under every profile */
    TASK_ASSIGN,    /* `path` is a material file, or "preset:NAME", or a picture for `input` of `index` */
    TASK_BIND_MAPS, /* the maps of folder `path` on material `index`, -1: the cloth */
    TASK_LIGHT,     /* `path` is a picture, or the folder of a cubemap, that lights the scene from far away */
    TASK_SCENE,     /* an event only: another scene was taken, or failed */
    TASK_SURVEY     /* an event only: a variant has changed which meshes use the materials */
} TaskKind;

typedef struct Task {
    TaskKind kind;
    unsigned scene; /* number of its scene; tasks of another scene are dropped */
    char path[STATE_PATH];
    int index, input;
    float x, y;
    int width, height;
    bool transparent, reference;
    bool nap;       /* TASK_PICK: with the nap that the material has by itself */
    unsigned stamp; /* comes back with its event */
} Task;

/* The parts of a pixel. */
typedef struct Probe {
    bool hit;
    int material;
    float position[3], normal[3], texcoord[2], distance, texel;
    float tangent[3], bitangent[3];
    float value[WEFT_PART_COUNT][3];
} Probe;

typedef struct RenderEvent {
    TaskKind kind;
    unsigned scene; /* number of the scene this event is about */
    bool failed;
    WeftResult result;     /* TASK_SCENE */
    char text[512];        /* a line for people */
    char path[STATE_PATH]; /* TASK_BIND_MAPS: the folder */
    unsigned stamp;
    Probe probe;
    WeftImage image;    /* TASK_PROFILES: U8 RGB; TASK_PICK: a nap, where none was brushed; owned */
    bool state_changed; /* and `state` is what the scene is configured as now; owned */
    SceneState state;
    Facts maps;      /* where they are others: the maps alone; owned */
    float *coverage; /* TASK_SURVEY: survey.h; owned, may be NULL */
    int index;
} RenderEvent;

/* The latest picture and its state. */
typedef struct RenderedFrame {
    unsigned texture; /* 0: nothing yet */
    int width, height;
    unsigned scene;      /* number of the scene that is shown */
    unsigned number;     /* of the request it shows */
    bool focused;        /* `target` is what is in the middle of the picture */
    Effort effort;       /* how well it is drawn; a coarse one's texture is stretched */
    float seconds;       /* s, for this picture */
    float whole_seconds; /* s, for a picture with all pixels */
    float eye[3], target[3], fov;
    int programs, compiled;
    bool busy;           /* more is to come: shaders, or what the background looks for */
    char complaint[512]; /* shader text that does not compile */
    char failure[512];   /* why there is no newer picture */
    char driver[128];
} RenderedFrame;

/* window and reference must outlive the renderer. shader_dir may be NULL. NULL where memory or a context
 * is short. */
Renderer *renderer_start(Window *window, ReferenceView *reference, const char *shader_dir, int occlusion);
void renderer_stop(Renderer *renderer);

/* Takes the scene over, with the state it has; the old one is released once the new one can be drawn, and an
 * event of TASK_SCENE reports the outcome. number is the scene's own: requests and tasks of another one are
 * dropped. Folders of maps in use are watched. */
void renderer_set_scene(Renderer *renderer, WeftScene *scene, const SceneState *state, const Folders *folders,
                        unsigned number);

/* Copies the request; returns its number. */
unsigned renderer_request(Renderer *renderer, const FrameRequest *request);
void renderer_add_task(Renderer *renderer, const Task *task);

/* The newest picture; its texture stays as it is until the next call. True where it is another one. */
bool renderer_take_frame(Renderer *renderer, RenderedFrame *rendered);

/* Returns true if a picture or an event waits. */
bool renderer_has_output(Renderer *renderer);

/* The oldest event; false where there is none. Release with render_event_free. */
bool renderer_take_event(Renderer *renderer, RenderEvent *event);
void render_event_free(RenderEvent *event);

/* Returns true if all requests and tasks are done. */
bool renderer_is_idle(Renderer *renderer);

/* Warnings that were said since the last call, one line each; NULL: none. Release with free. */
char *renderer_take_warnings(Renderer *renderer);

#endif
