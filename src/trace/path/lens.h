/* lens.h - camera rays: where in a picture a sample is, and what the camera sees there */
#pragma once

#include "scene/record/camera.h"
#include "trace/path/chunk.h"

enum { LENS_STEPS = 256 };

typedef struct Lens {
    View view;
    int width, height;            /* of the picture */
    bool centred;                 /* all samples are at the middle of their pixel */
    float filter[LENS_STEPS + 1]; /* offset in pixels by its cumulative weight */
} Lens;

/* Fills the pixel filter. */
void lens_make(Lens *lens);

/* Pixels of a picture from (x, y) on, row by row, and the samples of each from `first` on. */
typedef struct LensPart {
    int x, y, width, height; /* width height <= 256 */
    int first, count;        /* count <= 1 << PATHS_SAMPLES_LOG2 */
    int half;                /* -1, or 0 or 1: of the samples take those 16 by 16 in turn */
    uint32_t seed;
} LensPart;

/* Fills keys, and paths with camera rays, pixel by pixel; returns how many. */
int lens_rays(const Lens *lens, const LensPart *part, PathKeys *keys, Paths *paths);
