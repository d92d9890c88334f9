/* photograph.h - reads a picture for display in a thread of its own */
#pragma once

#include <stdbool.h>

#include "view/ui/window.h"

enum { PHOTOGRAPH_SIDE = 4096 };

typedef struct PhotographLoad PhotographLoad;

/* Starts to read. Integers are display-referred and stay as they are; floats are linear light, which tonemap and exposure
 * (stops) map. Larger pictures are reduced to PHOTOGRAPH_SIDE. NULL where memory or threads are short. */
PhotographLoad *photograph_start(const char *path, WeftTonemap tonemap, float exposure, Window *window);
bool photograph_done(PhotographLoad *load);

/* Waits for the end. Fills the picture, U8 RGB, to be released; false, with one line in `why`, if it cannot be read. */
bool photograph_end(PhotographLoad *load, WeftImage *out, char why[512]);
