/* context.h - OpenGL: a context of its own without a window, through EGL, or one that a window has
 *
 * Drawing goes to framebuffer objects; a context of its own has no surface. A context belongs to one thread
 * at a time. Several may be alive at once, in one thread too: every call of this folder makes its own current
 * while it works, and puts back what was there. */
#pragma once

#include "raster/gl/state.h"
#include "text/assemble/text.h"

typedef struct GlContext GlContext;

/* Creates a context for shaders of a language: desktop OpenGL 3.3 core (TEXT_GLSL_330), or OpenGL ES 3.0 with
 * floating-point targets (TEXT_GLSL_ES_300); a driver may give a later version. Fails with WEFT_MESSAGE_GL_CONTEXT
 * if there is no EGL, no driver, or no such version, and with _MEMORY. */
WeftResult context_create(TextLanguage language, GlContext **out, WeftError *error);

/* Creates a context that shares textures, buffers and programs with another (not framebuffers nor vertex arrays), for
 * work in another thread. An object made there is complete for all contexts once glFinish has returned and the threads
 * are joined. Returns NULL if the driver refuses or memory is short, and for a context adopted from GLX, which makes
 * contexts for a screen's visual that it does not report. Release with context_destroy. */
GlContext *context_share(const GlContext *context);

/* Adopts the context that is current in this thread, whatever made it. It stays its owner's, and context_enter requires
 * it to be current. Fails with WEFT_MESSAGE_GL_CONTEXT if there is none, or its version is lower than those above. */
WeftResult context_adopt(GlContext **out, WeftError *error);
bool context_adopted(const GlContext *context);

/* Releases a context, except an adopted one, which only loses its record; may be NULL. Objects made in it must be
 * destroyed before. */
void context_destroy(GlContext *context);

/* The context that was current in a thread before. */
typedef struct GlOuter {
    void *display, *context, *draw, *read;
    unsigned api;
    GlPlace place; /* in a context that was adopted */
} GlOuter;

/* Makes the context current in this thread until context_leave(outer). Pairs may lie inside each other,
 * but not of one that was adopted, whose state is brought to that of a new context at either end (state.h).
 * Returns false if the driver refuses, since the context is in use in another thread, or if an adopted one is not
 * current. */
bool context_enter(GlContext *context, GlOuter *outer);
void context_leave(GlContext *context, const GlOuter *outer);

/* Releases what EGL keeps for this thread; called before the thread ends. */
void context_thread_ends(void);

/* Returns the language of its shaders. */
TextLanguage context_language(const GlContext *context);

/* Returns the driver's name ("llvmpipe (LLVM 15.0.6, 256 bits)"), which lives as long as the context. */
const char *context_driver(const GlContext *context);
