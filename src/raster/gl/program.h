/* program.h - shader text compiled and linked */
#ifndef WEFT_RASTER_PROGRAM_H
#define WEFT_RASTER_PROGRAM_H

#include "text/assemble/text.h"

/* A whole shader: what a Text holds, and perhaps lines of the caller's own behind it. */
typedef struct ShaderSource {
    const char *bytes;
    const Text *text; /* knows the files that the lines come from; may be NULL */
} ShaderSource;

/* A program in the context that is current; 0 on failure. Fails with WEFT_MESSAGE_GL_COMPILE as complain
 * does; `name` is what the shader is for. Release with glDeleteProgram. */
unsigned program_create(const char *name, ShaderSource vertex, ShaderSource fragment, WeftError *error);

#endif
