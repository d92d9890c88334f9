/* state.h - the OpenGL state that this folder relies on, in a context that others use too
 *
 * All calls are for the context that is current. */
#ifndef WEFT_RASTER_STATE_H
#define WEFT_RASTER_STATE_H

/* The caller's drawing state, which is restored. */
typedef struct GlPlace {
    int draw, read; /* framebuffers */
    int viewport[4], scissor[4];
} GlPlace;

/* Notes the place, forgets errors that nobody asked for, and brings all else that this folder relies on or
 * changes to what a new context has. */
void state_begin(GlPlace *place);

/* Brings it there again and returns to the place. */
void state_end(const GlPlace *place);

#endif
