/* target.h - the render target of a picture: linear colours of 16 bits, several samples a pixel, and their
 * mean
 *
 * All calls are for the context that is current. */
#pragma once

#include "weft/image.h"

typedef struct Target {
    int width, height, samples;
    unsigned drawn, resolved; /* framebuffers; the same with one sample. drawn is 0 where only the mean is kept */
    unsigned color, depth;    /* renderbuffers of drawn */
    unsigned mean;            /* texture of resolved */
} Target;

/* Gives the target a size and number of samples a pixel, which is reduced to what the driver has. Does nothing if it
 * has these. Fails with WEFT_MESSAGE_GL_MEMORY or _GL_CONTEXT; the target is then empty. */
WeftResult target_resize(Target *target, int width, int height, int samples, WeftError *error);
void target_destroy(Target *target);

/* Frees all but the mean. target_resize makes the target whole again. */
void target_keep_mean(Target *target);

/* Averages the samples into `resolved` within a box: x, y from below, width, height. */
void target_resolve(const Target *target, const int box[4]);

/* Reads the picture as F32 RGBA with straight alpha. Fails with WEFT_MESSAGE_MEMORY, _GL_MEMORY or _GL_CONTEXT. */
WeftResult target_read(const Target *target, WeftImage *out, WeftError *error);
