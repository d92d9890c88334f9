/* display.h - the pass that shows a picture: from linear colours to those of a display
 *
 * All calls are for the context that is current. */
#pragma once

#include "raster/gl/target.h"
#include "text/assemble/text.h"
#include "weft/raster.h"

/* Zero-initialise. */
typedef struct Display {
    unsigned program;              /* 0 until it is needed */
    int place, back, curve, white; /* locations of its uniforms */
    bool stale;                    /* true if the text may have changed */
    WeftError error;               /* of the last attempt; the program before stays in use */
} Display;

/* Draws a target's picture. The vertex shader makes the vertices, so any vertex array may be bound. Leaves the
 * framebuffer bound and the program in use. Fails with WEFT_MESSAGE_GL_COMPILE or _TEXT_DIALECT if no version has ever
 * compiled. */
WeftResult display_draw(Display *display, const TextDesc *desc, const Target *target, const WeftRasterShow *show,
                        WeftError *error);

void display_destroy(Display *display);
