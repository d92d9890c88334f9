/* state.h - the OpenGL state that this folder relies on, in a context that others use too
 *
 * All calls are for the context that is current. */
#pragma once

/* The caller's drawing state, which is restored. */
typedef struct GlPlace {
    int draw, read; /* framebuffers */
    int viewport[4], scissor[4];
} GlPlace;

/* Saves the place, clears pending OpenGL errors, and resets all other state that this folder relies on or changes to
 * that of a new context. */
void state_begin(GlPlace *place);

/* Resets the state once more and restores the place. */
void state_end(const GlPlace *place);
