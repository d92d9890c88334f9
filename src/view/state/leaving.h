/* leaving.h - the question that is asked before changes are lost: the window is to be closed, or another scene opened */
#pragma once

#include "view/state/viewer.h"

typedef struct LeavingState {
    enum { LEAVING_NOT, LEAVING_WINDOW, LEAVING_SCENE } what;
    char path[STATE_PATH]; /* LEAVING_SCENE: of the next scene */
    bool saves;            /* the dialog that saves is open, or the renderer saves */
} LeavingState;

/* Closes the window; asks first if changes are not saved, or a picture or a baked file is being made. */
void leaving_quit(Viewer *v);

/* Asks whether to leave the scene for another if changes are not saved. Returns false if there is nothing to ask. */
bool leaving_asks(Viewer *v, const char *path);

/* Leaves after a scene or material was saved, if that was the answer; asks again if changes remain. */
void leaving_saved(Viewer *v, bool failed);

/* Ends the wait for the dialog that saves, since another one opens. */
void leaving_stop_waiting(Viewer *v);

/* Stays. */
void leaving_cancel(Viewer *v);
void leaving_draw(Viewer *v);
