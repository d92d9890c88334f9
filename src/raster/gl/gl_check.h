/* gl_check.h - helpers of all passes: errors of the driver, textures without a filter */
#pragma once

#include "weft/result.h"

/* Fails if an OpenGL call since the last check did: with WEFT_MESSAGE_GL_MEMORY, or _GL_CONTEXT for any other error. */
WeftResult gl_check(WeftError *error, const char *what);

/* Sets nearest-neighbour look-up without mipmaps, and clamping at the edges, for the texture bound to `target`. */
void texture_unfiltered(unsigned target);
