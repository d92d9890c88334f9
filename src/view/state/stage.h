/* stage.h - the picture in the middle of the window, and what the mouse does on it */
#pragma once

#include "view/state/viewer.h"

/* The brush's stroke that is under way. */
typedef struct Stroke {
    bool down;
    bool started;       /* the last place is valid */
    float at[3], uv[2]; /* last place, in the world (m) and on the map */
    int material;
} Stroke;

/* The mouse on the picture. */
typedef struct DragState {
    bool pressed[3], moved;
    float press_x, press_y, last_x, last_y;
    int light;        /* whose handle is dragged; -1: none */
    bool split, wipe; /* the line between A and B, or before a photograph, is dragged */
    unsigned stamps;
    Stroke stroke;
} DragState;

void stage_begin(Viewer *v);
void stage_input(Viewer *v);
void stage_draw(Viewer *v);

/* Takes the surface point under the mouse, which the stage has requested. */
void stage_picked(Viewer *v, const RenderEvent *event);
