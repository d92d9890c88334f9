/* turntable.h - pictures on a circle around a scene */
#pragma once

#include "cli/render/job.h"

/* Makes and writes the request's pictures, each as it is done. The camera rotates about the vertical axis
 * through its target, counter-clockwise seen from above. */
WeftResult turntable_run(Job *job, WeftError *error);
