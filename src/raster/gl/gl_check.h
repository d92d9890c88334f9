/* gl_check.h - helpers of all passes: errors of the driver, textures that are read texel by texel */
#ifndef WEFT_RASTER_GL_CHECK_H
#define WEFT_RASTER_GL_CHECK_H

#include "weft/result.h"

/* Fails with WEFT_MESSAGE_GL_MEMORY, or _GL_CONTEXT for what should not happen, where a call since the last
 * check did. */
WeftResult gl_check(WeftError *error, const char *what);

/* No filter, and no smaller copies, without which a texture would count as not complete. */
void texture_plain(unsigned target);

#endif
