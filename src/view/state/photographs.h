/* photographs.h - the photograph that the picture is compared with: beside it, behind a line, or over it */
#pragma once

#include "view/render/orbit.h"
#include "view/render/photograph.h"
#include "view/state/viewer.h"

typedef enum PhotographPlace { PHOTOGRAPH_OFF, PHOTOGRAPH_BESIDE, PHOTOGRAPH_WIPE, PHOTOGRAPH_OVER } PhotographPlace;

/* The view of a photograph. */
typedef struct PhotographView {
    PhotographPlace place;
    float at;       /* WIPE: the line, a fraction of the width */
    float opacity;  /* OVER: 0 to 1 */
    float size;     /* 1: as large as fits */
    float shift[2]; /* right and down, fractions of the height of the picture */
    bool follows;   /* the photograph grows as the camera comes nearer */
    float reach;    /* height of what the camera sees at its target where the size is as it is given, m; 0: as now */
} PhotographView;

typedef struct PhotographsState {
    char path[STATE_PATH]; /* "": none */
    PhotographView view;
    unsigned texture; /* 0: nothing was read */
    int width, height;
    bool linear;          /* tone curve and exposure change it */
    PhotographLoad *load; /* NULL: none */
    WeftTonemap tonemap;  /* of the load */
    float exposure;
} PhotographsState;

void photographs_begin(Viewer *v);
void photographs_end(Viewer *v);

/* Begins to read a picture, which is shown beside the scene's if none was shown. */
void photographs_open(Viewer *v, const char *path);
void photographs_remove(Viewer *v);

/* Sets how it is seen, clamped to the ranges. It stays as large as it is where `follows` changes. */
void photographs_set(Viewer *v, const PhotographView *view);

/* Sets the height of what the camera saw where the size is as it is given, m. */
void photographs_reach(Viewer *v, float reach);

/* Keeps the size where the camera, which stood so before, fits the scene into a picture of another shape: nothing has come
 * nearer. */
void photographs_reframed(Viewer *v, const Orbit *before);

/* Takes a picture that was read. Returns true if one was. */
bool photographs_poll(Viewer *v);

/* Returns the box of the whole photograph, pixels of the window, part of which may be hidden; empty if none is shown. */
UiBox photographs_box(const Viewer *v);
void photographs_draw(const Viewer *v);
