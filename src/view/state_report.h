/* state_report.h - the window's contents as lines of JSON, for a program that drives it */
#ifndef WEFT_VIEW_STATE_REPORT_H
#define WEFT_VIEW_STATE_REPORT_H

#include "view/state/viewer.h"

/* Prints an object in one line on standard output: scene, camera, materials, lights, message, rates, memory, and every
 * control that is shown with its box. */
void report_state(const Viewer *v);

#endif
