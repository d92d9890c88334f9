/* painter.h - the thread that owns the scene and draws it, so that the window never waits for a shader, a
 * table or a file
 *
 * The window says what it wants to see, as often as it likes: the painter takes the latest, brings the scene
 * to it and hands over a finished picture as a texture that both contexts share. What is done once (a file to
 * write, a pixel to look at) is a task: tasks are done in their order and answered by news. */
#ifndef WEFT_VIEW_PAINTER_H
#define WEFT_VIEW_PAINTER_H

#include "view/loader.h"
#include "view/look.h"
#include "view/orbit.h"
#include "view/truth.h"
#include "view/window.h"
#include "weft/raster.h"

typedef struct Painter Painter;

/* How two looks share a picture. */
typedef enum Split { SPLIT_NONE, SPLIT_LINE, SPLIT_SIDES } Split;

/* How well a picture is drawn: while the hand moves one of fewer pixels may do, where a whole one takes long;
 * edges are smoothed last. */
typedef enum Effort { EFFORT_COARSE, EFFORT_WHOLE, EFFORT_SMOOTH } Effort;

/* What the window wants to see. Numbers that do not change the picture have no place here. */
typedef struct Order {
    unsigned scene;   /* that it is of: painter_give's number */
    int edited;       /* tasks are done to `look` (0) or to `other` (1) */
    Look look, other; /* `other` on the right, where they share it; empty otherwise */
    Split split;
    float at;            /* SPLIT_LINE: share of the width that is left of it */
    WeftRasterView view; /* size, background, part, ambient; its camera is the text below */
    char camera[ORBIT_TEXT];
    float behind[3];  /* light of the display, where the picture is transparent */
    bool laid_behind; /* also in pictures that are saved */
    WeftTonemap tonemap;
    float exposure;
    Effort effort; /* that is asked for at the least */
    bool truth;    /* nothing is to be drawn: the path tracer does it */
    bool compare;  /* a linear copy is to be handed to the path tracer */
} Order;

/* A copy that shares the parts of its looks; false where memory is short, and then `copy` is as it was. */
bool order_copy(Order *copy, const Order *order);
void order_free(Order *order); /* its looks */

typedef enum TaskKind {
    TASK_SHOT,     /* a picture of `view`'s size to `path` */
    TASK_SAVE,     /* the scene, or material `index`, to `path` */
    TASK_PROBE,    /* what is at x, y of the order's picture */
    TASK_PICK,     /* the same without the parts of its light */
    TASK_PROFILES, /* small pictures with material `index` under every profile */
    TASK_DRESS,    /* `path` is a material file, or "preset:NAME", or a picture for `input` of `index` */
    TASK_WEAR,     /* the maps of folder `path` on material `index`, -1: the cloth */
    TASK_LIGHT,    /* `path` is a picture, or the folder of a cubemap, that lights the scene from far away */
    TASK_SCENE,    /* news alone: another scene was taken, or could not be */
    TASK_SURVEY    /* news alone: a variant has others wear the scene's materials */
} TaskKind;

typedef struct Task {
    TaskKind kind;
    unsigned scene; /* that it is of; tasks of another one are dropped */
    char path[LOOK_PATH];
    int index, input;
    float x, y;
    int width, height;
    bool transparent, truth;
    bool nap;       /* TASK_PICK: with the nap that the material has by itself */
    unsigned stamp; /* comes back with its news */
} Task;

/* The parts of a pixel. */
typedef struct Probe {
    bool hit;
    int material;
    float position[3], normal[3], texcoord[2], distance, texel;
    float tangent[3], bitangent[3];
    float value[WEFT_PART_COUNT][3];
} Probe;

typedef struct News {
    TaskKind kind;
    unsigned scene; /* that it is of */
    bool failed;
    WeftResult result;    /* TASK_SCENE */
    char text[512];       /* a line for people */
    char path[LOOK_PATH]; /* TASK_WEAR: the folder */
    unsigned stamp;
    Probe probe;
    WeftImage image;   /* TASK_PROFILES: U8 RGB; TASK_PICK: a nap, where none was brushed; owned */
    bool look_changed; /* and `look` is what the scene is dressed as now; owned */
    Look look;
    Facts maps;    /* where they are others: the maps alone; owned */
    float *shares; /* TASK_SURVEY: survey.h; owned, may be NULL */
    int index;
} News;

/* What is told of the scene at hand. */
typedef struct Painted {
    unsigned texture; /* 0: nothing yet */
    int width, height;
    unsigned scene;      /* that it shows */
    unsigned number;     /* of the order it shows */
    bool focused;        /* `target` is what is in the middle of the picture */
    Effort effort;       /* how well it is drawn; a coarse one's texture is stretched */
    float seconds;       /* that it took */
    float whole_seconds; /* that one of all pixels takes */
    float eye[3], target[3], fov;
    int programs, compiled;
    bool busy;           /* more is to come: shaders, or what the background looks for */
    char complaint[512]; /* shader text that does not compile */
    char failure[512];   /* why there is no newer picture */
    char driver[128];
} Painted;

/* window must outlive it; truth too. shader_dir may be NULL. NULL where memory or a context is short. */
Painter *painter_start(Window *window, Truth *truth, const char *shader_dir, int occlusion);
void painter_stop(Painter *painter);

/* Takes the scene over, with the look it has; the old one is released once the new one can be drawn, and news
 * of TASK_SCENE tell. number is the scene's own: orders and tasks of another one are dropped. Folders that it
 * wears are watched. */
void painter_give(Painter *painter, WeftScene *scene, const Look *look, const Folders *folders,
                  unsigned number);

/* Copies the order; returns its number. */
unsigned painter_order(Painter *painter, const Order *order);
void painter_task(Painter *painter, const Task *task);

/* The newest picture; its texture stays as it is until the next call. True where it is another one. */
bool painter_look(Painter *painter, Painted *painted);

/* Whether a picture or news wait. */
bool painter_fresh(Painter *painter);

/* The oldest news; false where there is none. Release with news_free. */
bool painter_news(Painter *painter, News *news);
void news_free(News *news);

/* Whether all that was asked for is done. */
bool painter_idle(Painter *painter);

/* Warnings that were said since the last call, one line each; NULL: none. Release with free. */
char *painter_said(Painter *painter);

#endif
