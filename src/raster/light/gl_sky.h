/* gl_sky.h - the importance map of an environment in a texture, by which shaders draw directions (glsl/sky.glsl)
 *
 * The texture has one float a texel. Row k has the cumulative probabilities of the columns of the map's row k, and
 * behind them that of the rows up to k (trace/light/sky.h).
 *
 * All calls are for the context that is current. */
#pragma once

#include "scene/record/scene.h"

/* The map is never finer: its cells are then a mean of several texels. */
enum { SKY_WIDTH_MOST = 1024 };

typedef struct GlSky {
    unsigned table; /* 0: none */
    bool made;
    unsigned version; /* of the environment, as in Environment */
} GlSky;

/* Makes the table of an environment with an image, unless it is made already. Fails with WEFT_MESSAGE_MEMORY or
 * _GL_MEMORY. */
WeftResult sky_table_make(GlSky *self, const Environment *environment, WeftError *error);
void sky_table_destroy(GlSky *self);
