/* stills.h - the path-traced pictures that are made in the background */
#pragma once

#include "view/render/still.h"
#include "view/state/copies.h"

typedef struct StillsState {
    SceneCopy copy; /* of the scene, which the renderer saves first */
    StillDesc due;  /* what is made from the copy */
    Still *still;   /* NULL: none */
    double share;   /* of its samples, 0 to 1 */
} StillsState;

/* Begins a picture of the edited scene, or a turntable: what the choice leaves open is as the window shows it. One request
 * is carried out at a time. */
void stills_make(Viewer *v, const char *path, const StillChoice *choice);

/* Starts the thread, when the scene was saved to `scene`; failed: it was not. */
void stills_saved(Viewer *v, const char *scene, bool failed);

/* Returns true while a picture is made or due. */
bool stills_busy(const Viewer *v);

/* Takes progress and end of the picture. Returns true if something changed. */
bool stills_poll(Viewer *v);
void stills_cancel(Viewer *v);
void stills_end(Viewer *v);
