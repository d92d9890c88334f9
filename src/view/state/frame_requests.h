/* frame_requests.h - requests for frames, and their results */
#ifndef WEFT_VIEW_FRAME_REQUESTS_H
#define WEFT_VIEW_FRAME_REQUESTS_H

#include "view/state/viewer.h"

/* A request is due although nothing that is drawn has changed yet. */
void requests_due(Viewer *v);

/* Forgets what was asked of the scene before: its state, which is released, or the point that was probed. */
void requests_forget(Viewer *v);
void requests_forget_probe(Viewer *v);
void requests_end(Viewer *v);

/* Sends what is wanted where it is something else than before, or can be drawn better now. */
void requests_send(Viewer *v);

/* Returns true if the picture shown is of the latest request but could be drawn more finely. */
bool requests_can_refine(const Viewer *v);

/* Takes the newest picture; waits a little for one where one is due. */
void requests_wait_frame(Viewer *v);
void requests_take_reference(Viewer *v);

/* The place of a camera of the scene is known once a frame was drawn through it. */
void requests_read_camera(Viewer *v);

/* Takes the events of tasks. */
void requests_take_events(Viewer *v);

#endif
