/* renderer_state.h - the renderer's data, for the files that run in its thread: renderer.c, pictures.c, tasks.c */
#pragma once

#include <pthread.h>

#include "view/files/file_watch.h"
#include "view/render/renderer.h"
#include "view/render/studies.h"
#include "weft/pick.h"

enum { RING = 4, TASKS = 32, EVENTS = 64, WARNINGS_SIZE = 4096 };

struct Renderer {
    Window *window;
    ReferenceView *reference;
    char *shader_dir;
    int occlusion; /* WeftRasterDesc */
    pthread_t thread;
    pthread_mutex_t lock;
    pthread_cond_t change; /* signalled when there may be work */
    /* read and written under the lock */
    FrameRequest request; /* the latest one */
    unsigned number;      /* number of `request` */
    bool requested, quit;
    bool working;                          /* false while the thread waits and nothing is made in the background */
    WeftScene *pending_scene;              /* the scene to be taken over */
    unsigned pending_number, scene_number; /* numbers of that scene and of the current one */
    SceneState pending_state;
    Folders pending_folders;
    Task tasks[TASKS];
    int task_count;
    RenderEvent events[EVENTS];
    int event_count;
    RenderedFrame rendered;
    int newest, shown, before; /* indices of `textures`, before: of RenderedFrame; -1: none */
    bool fresh;                /* `rendered` has changed since the window took it */
    char warnings[WARNINGS_SIZE];
    /* used by the thread alone */
    WeftScene *scene;
    WeftRaster *raster;
    WeftPick *pick;
    SceneState is;            /* the current state of the scene */
    EnvironmentState refused; /* an environment whose file cannot be read */
    char refusal[512];        /* the reason; "": none was refused */
    unsigned readings;        /* how often files of environments were read */
    BoundNaps naps;           /* textures of brushed naps in the scene */
    FrameRequest drawn;       /* a copy of the request that was drawn last */
    unsigned drawn_number;
    bool stale;            /* the same request would give another picture now */
    bool spare;            /* memory was freed, perhaps, since some was last returned */
    bool started;          /* drawing of this scene has begun */
    Folders folders;       /* folders of maps in use, and watched */
    int surveyed;          /* variant whose coverage by materials the window has (TASK_SURVEY) */
    FileWatch *file_watch; /* watches the files of textures, and these folders */
    int coarse;            /* shading rate of a coarse picture */
    double coarse_seconds, whole_seconds, smooth_seconds; /* s, that a picture of each effort took */
    bool smooth_timed;                                    /* smooth_seconds was measured, not estimated */
    bool surprised;                         /* the last picture took so long that its time was not counted */
    bool sums;                              /* frames are to be summed for the picture that was drawn last */
    bool sum_begun;                         /* the raster has begun to */
    double drawn_at;                        /* when that picture was drawn */
    int summed;                             /* frames in the sum */
    Study study;                            /* the sheet under way, of one material under every profile */
    unsigned textures[RING], targets[RING]; /* shown, newest, before, and one to draw into */
    int widths[RING], heights[RING];
};

/* Makes a log of warnings, which renderer_take_warnings returns (renderer.c, as the next two). */
WeftLog renderer_log(Renderer *renderer);
void renderer_post(Renderer *renderer, RenderEvent *event); /* takes the event over */
/* Watches the scene's texture files and the folders of maps in use, no others. */
void renderer_watch_files(Renderer *renderer);

/* Applies a state to the scene (pictures.c, as the next three). If the file of an environment
 * cannot be read, the environment stays as it was; frame_refusal then returns the reason, and the file is not
 * reread until it has changed. */
WeftResult frame_apply_state(Renderer *renderer, const SceneState *state, WeftError *error);
const char *frame_refusal(const Renderer *renderer, const SceneState *state); /* NULL: nothing was refused */
/* Returns the state that the panels edit. */
const SceneState *frame_edited_state(const FrameRequest *request);
void frame_draw(Renderer *renderer, const FrameRequest *request, unsigned number);
/* Draws a part of a frame of the sum, and publishes the mean whenever a frame is complete. */
void frame_sum(Renderer *renderer);

/* Sends the coverage by each material (tasks.c, as the next three). */
void tasks_survey(Renderer *renderer, const FrameRequest *request);
void tasks_do(Renderer *renderer, const Task *task, const FrameRequest *request);
void tasks_study(Renderer *renderer); /* draws one more picture of the sheet under way */
/* Rereads a texture file. If it cannot be read, the old picture stays until the next change of the file. */
WeftResult tasks_reload(Renderer *renderer, int texture, WeftError *error);
