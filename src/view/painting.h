/* painting.h - the inside of the painter: what its thread has at hand, for the files that are its parts */
#ifndef WEFT_VIEW_PAINTING_H
#define WEFT_VIEW_PAINTING_H

#include <pthread.h>

#include "view/painter.h"
#include "view/studies.h"
#include "view/watchman.h"
#include "weft/pick.h"

enum { RING = 3, TASKS = 32, NEWS = 64, SAID = 4096 };

struct Painter {
    Window *window;
    Truth *truth;
    char *shader_dir;
    int occlusion;
    pthread_t thread;
    pthread_mutex_t lock;
    pthread_cond_t change;
    /* under the lock */
    Order order;
    unsigned number;
    bool ordered, quit, working;
    WeftScene *gift;                    /* that is to be taken over */
    unsigned gift_number, scene_number; /* of it, and of the one at hand */
    Look gift_look;
    Folders gift_folders;
    Task tasks[TASKS];
    int task_count;
    News news[NEWS];
    int news_count;
    Painted painted;
    int newest, shown; /* of the ring; -1 none */
    bool fresh;
    char said[SAID];
    /* of the thread alone */
    WeftScene *scene;
    WeftRaster *raster;
    WeftPick *pick;
    Look is;        /* what the scene is dressed as */
    Around refused; /* a light from a file that could not be had, and why; "": none */
    char refusal[512];
    unsigned readings; /* of files of lights, that were asked for */
    LookWorn worn;
    Order done;
    unsigned done_number;
    bool stale; /* a picture of the same order would be another one */
    bool started;
    Folders folders;    /* that are worn, and watched */
    int surveyed;       /* variant of which the window knows who wears what */
    Watchman *watchman; /* of the files of textures, and of those folders */
    int coarse;         /* pixels a side that become one while the hand moves */
    double coarse_seconds, whole_seconds, smooth_seconds; /* that pictures take */
    bool smooth_known, surprised;
    Study study; /* that is under way */
    unsigned textures[RING], targets[RING];
    int widths[RING], heights[RING];
};

/* painter.c */
WeftLog painter_log(Painter *painter);           /* of warnings, for painter_said */
void painter_tell(Painter *painter, News *news); /* takes them over */
void painter_watch(Painter *painter); /* the files of the scene's textures, the folders worn, no others */

/* painting.c: brings the scene to a look, and draws an order into the next texture. A light from a file that
 * cannot be had leaves the one before; painting_refuses then tells why, and the file is left alone until it
 * has changed. */
WeftResult painting_wear(Painter *painter, const Look *look, WeftError *error);
const char *painting_refuses(const Painter *painter, const Look *look); /* NULL: it does not */
/* The look that the panels show. */
const Look *painting_edited(const Order *order);
void painting_draw(Painter *painter, const Order *order, unsigned number);

/* tasks.c */
void tasks_survey(Painter *painter, const Order *order); /* of who wears what, to the window */
void tasks_do(Painter *painter, const Task *task, const Order *order);
void tasks_study(Painter *painter); /* one more picture of the sheet that is under way */
/* A file whose picture does not come whole leaves the one before, until it changes again. */
WeftResult tasks_reload(Painter *painter, int texture, WeftError *error);

#endif
