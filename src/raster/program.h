/* program.h - shader text compiled and linked */
#ifndef WEFT_RASTER_PROGRAM_H
#define WEFT_RASTER_PROGRAM_H

#include "weft/result.h"

/* A program from whole shaders, in the context that is current; 0 on failure. Fails with
 * WEFT_MESSAGE_GL_COMPILE, whose detail is the first line that the driver says; `name` is what the shader is
 * for. Release with glDeleteProgram. */
unsigned program_create(const char *name, const char *vertex, const char *fragment, WeftError *error);

#endif
