/* program.h - shader text compiled and linked */
#pragma once

#include "text/assemble/text.h"

/* A whole shader: a text, and perhaps lines of the caller's own after it. */
typedef struct ShaderSource {
    const char *bytes;
    const Text *text; /* has the origin of each line; may be NULL */
} ShaderSource;

/* Compiles and links a program in the context that is current. Returns 0 on failure: WEFT_MESSAGE_GL_COMPILE, as
 * complain does; `name` is what the shader is for. Release with glDeleteProgram. */
unsigned program_create(const char *name, ShaderSource vertex, ShaderSource fragment, WeftError *error);

/* Makes a program whose fragments are those of a file, without tables, over all of the screen (glsl/screen.glsl). Fails as
 * program_create and text_end do; *program stays then. */
WeftResult program_on_screen(const char *name, const char *file, const TextDesc *desc, unsigned *program,
                             WeftError *error);
