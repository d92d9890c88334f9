/* coarse.h - the shading points of a moving picture: one for a square of pixels, with what its pixels need of them
 *
 * All calls are for the context that is current. */
#pragma once

#include <stdbool.h>

#include "text/assemble/text.h"
#include "weft/result.h"

/* Side of the square of shading points that share the points on a polygon (glsl/soft_shadow.glsl). */
enum { COARSE_SIDE = 3 };

/* Light; light of polygons without shadows, with its luminance in shadow; guides (glsl/coarse_guide.glsl). The last is the
 * light with smooth shadows, with depth and number of the guide in place of opacity. */
enum { COARSE_LIGHT, COARSE_POLYGONS, COARSE_GUIDES, COARSE_SMOOTH, COARSE_COUNT };

typedef struct Coarse {
    bool resolving;    /* solid meshes are drawn with the light of the points */
    int width, height; /* shading points */
    unsigned textures[COARSE_COUNT], depth;
    unsigned drawn, smooth; /* framebuffers: of all but the last texture, and of it */
    unsigned program;
} Coarse;

/* Gives the points of a picture of this size their number: one for rate x rate pixels. Does nothing if they have it. Fails
 * with WEFT_MESSAGE_GL_MEMORY, _GL_CONTEXT or _GL_COMPILE. */
WeftResult coarse_begin(Coarse *coarse, const TextDesc *desc, int width, int height, int rate, WeftError *error);

/* Smooths the shadows of polygons. The uniform block Picture is that of the points. */
void coarse_filter(const Coarse *coarse);

/* Binds the smooth light to a unit. */
void coarse_bind(const Coarse *coarse, int unit);

void coarse_destroy(Coarse *coarse);
