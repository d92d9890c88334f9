/* renderer_state.h - the inside of the renderer: what its thread has at hand, for the files that are its parts */
#ifndef WEFT_VIEW_RENDERER_STATE_H
#define WEFT_VIEW_RENDERER_STATE_H

#include <pthread.h>

#include "view/file_watch.h"
#include "view/renderer.h"
#include "view/studies.h"
#include "weft/pick.h"

enum { RING = 3, TASKS = 32, EVENTS = 64, WARNINGS_SIZE = 4096 };

struct Renderer {
    Window *window;
    ReferenceView *reference;
    char *shader_dir;
    int occlusion;
    pthread_t thread;
    pthread_mutex_t lock;
    pthread_cond_t change;
    /* under the lock */
    FrameRequest request;
    unsigned number;
    bool requested, quit, working;
    WeftScene *pending_scene;              /* the scene to be taken over */
    unsigned pending_number, scene_number; /* of it, and of the one at hand */
    SceneState pending_state;
    Folders pending_folders;
    Task tasks[TASKS];
    int task_count;
    RenderEvent events[EVENTS];
    int event_count;
    RenderedFrame rendered;
    int newest, shown; /* of the ring; -1 none */
    bool fresh;
    char warnings[WARNINGS_SIZE];
    /* of the thread alone */
    WeftScene *scene;
    WeftRaster *raster;
    WeftPick *pick;
    SceneState is;            /* what the scene is configured as */
    EnvironmentState refused; /* a light from a file that could not be had, and why; "": none */
    char refusal[512];
    unsigned readings; /* of files of lights, that were asked for */
    BoundNaps naps;
    FrameRequest drawn;
    unsigned drawn_number;
    bool stale; /* a picture of the same request would be another one */
    bool started;
    Folders folders;       /* folders of maps in use, and watched */
    int surveyed;          /* variant of which the window knows who wears what */
    FileWatch *file_watch; /* of the files of textures, and of those folders */
    int coarse;            /* pixels a side that become one while the hand moves */
    double coarse_seconds, whole_seconds, smooth_seconds; /* s, that pictures of each effort take */
    bool smooth_known, surprised;
    Study study; /* the sheet under way */
    unsigned textures[RING], targets[RING];
    int widths[RING], heights[RING];
};

/* renderer.c */
WeftLog renderer_log(Renderer *renderer);                   /* of warnings, for renderer_take_warnings */
void renderer_post(Renderer *renderer, RenderEvent *event); /* takes them over */
void renderer_watch_files(
    Renderer *renderer); /* the files of the scene's textures, the folders worn, no others */

/* frame.c: brings the scene to a state, and draws a request into the next texture. A light from a file that
 * cannot be read leaves the one before; frame_refusal then returns the reason, and the file is left alone
 * until it has changed. */
WeftResult frame_apply_state(Renderer *renderer, const SceneState *state, WeftError *error);
const char *frame_refusal(const Renderer *renderer, const SceneState *state); /* NULL: it does not */
/* The state shown in the panels. */
const SceneState *frame_edited_state(const FrameRequest *request);
void frame_draw(Renderer *renderer, const FrameRequest *request, unsigned number);

/* tasks.c */
void tasks_survey(Renderer *renderer, const FrameRequest *request); /* of who wears what, to the window */
void tasks_do(Renderer *renderer, const Task *task, const FrameRequest *request);
void tasks_study(Renderer *renderer); /* draws one more picture of the sheet under way */
/* A file whose picture does not come whole leaves the one before, until it changes again. */
WeftResult tasks_reload(Renderer *renderer, int texture, WeftError *error);

#endif
