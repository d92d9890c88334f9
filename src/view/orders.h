/* orders.h - what the window wants to see, and what comes back */
#ifndef WEFT_VIEW_ORDERS_H
#define WEFT_VIEW_ORDERS_H

#include "view/viewer.h"

/* Sends what is wanted where it is something else than before, or can be drawn better now. */
void orders_send(Viewer *v);

/* Whether the picture that is shown is right but for its finish. */
bool orders_finer(const Viewer *v);

/* Takes the newest picture; waits a little for one where one is due. */
void orders_await(Viewer *v);
void orders_truth(Viewer *v);

/* Where a camera of the scene stands is known once it has been drawn through. */
void orders_camera(Viewer *v);

/* What has become of tasks. */
void orders_news(Viewer *v);

#endif
