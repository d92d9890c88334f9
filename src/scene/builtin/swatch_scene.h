/* swatch_scene.h - the scene builtin:swatch: one cloth, so near that its threads can be seen */
#pragma once

#include "scene/record/scene.h"

/* Makes a cloth in folds, whose threads are not stretched, with texture coordinates in metres, on a sheet. The materials
 * are named after them; the camera main sees 3.4 cm of the cloth. */
WeftResult swatch_make(WeftScene *scene, WeftError *error);
