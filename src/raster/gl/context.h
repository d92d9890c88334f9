/* context.h - OpenGL: a context of its own without a window, through EGL, or one that a window has
 *
 * Drawing goes to framebuffer objects; a context of its own has no surface. A context belongs to one thread
 * at a time. Several may be alive at once, in one thread too: every call of this folder makes its own current
 * while it works, and puts back what was there. */
#ifndef WEFT_RASTER_CONTEXT_H
#define WEFT_RASTER_CONTEXT_H

#include "raster/gl/state.h"
#include "text/assemble/text.h"

typedef struct GlContext GlContext;

/* A context for shaders of that language: desktop OpenGL 3.3 core (TEXT_GLSL_330), or OpenGL ES 3.0 with
 * targets of floats (TEXT_GLSL_ES_300); a driver may give a later version. Fails with WEFT_MESSAGE_GL_CONTEXT
 * where there is no EGL, no driver, or no such version. */
WeftResult context_create(TextLanguage language, GlContext **out, WeftError *error);

/* Another context that has the same textures, buffers and programs (not framebuffers nor vertex arrays), for
 * work in another thread: what is made there is there for all once glFinish and whatever joins the threads
 * are past. NULL where the driver or memory refuses, and of one that was adopted from GLX, which makes
 * contexts for a screen's visual that it does not report. Release with context_destroy. */
GlContext *context_share(const GlContext *context);

/* The context that is current in this thread, whatever made it; it stays its owner's, and context_enter asks
 * that it be current. Fails with WEFT_MESSAGE_GL_CONTEXT where there is none, or it is older than those
 * above.
 */
WeftResult context_adopt(GlContext **out, WeftError *error);
bool context_adopted(const GlContext *context);

/* Makes it current nowhere and releases it, but for one that was adopted; NULL is fine. What was made in it
 * must be destroyed before. */
void context_destroy(GlContext *context);

/* The context that was current in a thread before. */
typedef struct GlOuter {
    void *display, *context, *draw, *read;
    unsigned api;
    GlPlace place; /* in a context that was adopted */
} GlOuter;

/* Makes the context current in this thread until context_leave(outer). Pairs may lie inside each other,
 * but not of one that was adopted, whose state is brought to that of a new context at either end (state.h).
 * False where the driver refuses, since the context is in use in another thread, or where an adopted one is
 * not current. */
bool context_enter(GlContext *context, GlOuter *outer);
void context_leave(GlContext *context, const GlOuter *outer);

/* Lets go of what EGL keeps for this thread, which then ends. */
void context_thread_ends(void);

/* The language it was made for. */
TextLanguage context_language(const GlContext *context);

/* The driver's own name for itself ("llvmpipe (LLVM 15.0.6, 256 bits)"); lives as long as the context. */
const char *context_driver(const GlContext *context);

#endif
