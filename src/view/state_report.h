/* state_report.h - the window's contents as lines of JSON, for a program that drives it */
#pragma once

#include "view/state/viewer.h"

/* Prints an object in one line on standard output: scene, camera, materials, lights, message, rates, memory, and every
 * control that is shown with its box. */
void report_state(const Viewer *v);
