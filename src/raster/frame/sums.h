/* sums.h - the mean of frames that are drawn one after the other, each with its own random numbers and a little aside
 *
 * The picture from before the first frame counts as SUMS_START frames, or as SUMS_START_BOUNCED where light bounces, of
 * which a frame has more noise; fewer with each frame and none after a quarter of them, so that the picture changes
 * without a jump.
 *
 * All calls are for the context that is current. */
#pragma once

#include "raster/gl/target.h"
#include "scene/record/camera.h"
#include "text/assemble/text.h"
#include "weft/raster.h"

enum { SUMS_START = 8, SUMS_START_BOUNCED = 48 };

typedef struct Sums {
    Target frame;         /* the frame that is being drawn, one sample a pixel */
    unsigned textures[3]; /* the sum, of 32-bit floats; the picture from before; the next sum, unless floats blend */
    unsigned framebuffers[3];
    int count; /* textures: 2 or 3 */
    unsigned program;
    int weights; /* location of a uniform of it */
    int width, height;
    WeftRasterView view; /* complete, without the camera's name */
    View seen;           /* the camera of the sum */
    bool begun;          /* what is summed is still what was asked for */
    bool starts;         /* from a picture */
    int frames, done;    /* to be drawn, and drawn */
    int row;             /* of the frame that is being drawn: the first row from below that is missing */
    int rows;            /* a strip */
} Sums;

/* Gives the sums a size and makes them zero. picture: of the same view, or NULL. Fails with WEFT_MESSAGE_GL_MEMORY,
 * _GL_CONTEXT or _GL_COMPILE. */
WeftResult sums_begin(Sums *sums, const TextDesc *desc, int width, int height, const Target *picture, WeftError *error);

/* Returns the view of the next frame, aside by a random part of the path tracer's filter of a pixel (trace/path/lens.h). */
View sums_view(const Sums *sums);

/* Adds the frame, and writes the mean to a picture of the same size. */
void sums_add(Sums *sums, const Target *picture);

void sums_destroy(Sums *sums);
