/* gl.h - whether OpenGL is to be had here, for tests that skip where it is not */
#ifndef WEFT_TEST_RASTER_GL_H
#define WEFT_TEST_RASTER_GL_H

#include "raster/gl/context.h"

static bool no_gl;

/* For a group of tests to begin with; says what is missing. */
static inline int gl_begin(void **state) {
    (void)state;
    GlContext *context;
    WeftError error;
    no_gl = context_create(TEXT_GLSL_330, &context, &error) != WEFT_OK;
    if (no_gl) print_message("%s\n", error.text);
    if (!no_gl) context_destroy(context);
    return 0;
}

static inline void need_gl(void) {
    if (no_gl) skip();
}

#endif
