/* compute.h - a function over arrays, run by the GPU: one pixel a sample
 *
 *   in, out   arrays of vec4, one array for each in0, in1 ... and out0, out1 ... of the body
 *
 * Numbers are 32-bit floats both ways and are not filtered, blended or clamped. Made with a context, used in
 * the thread that the context belongs to. */
#pragma once

#include "raster/gl/context.h"

typedef struct Compute Compute;

enum { COMPUTE_INPUTS_MAX = 32, COMPUTE_OUTPUTS_MAX = 16 };

typedef struct ComputeDesc {
    const char *name; /* what it is for, in errors */
    /* A fragment shader in the context's language up to main, from its #version on; closed with text_end. */
    const Text *text;
    /* Statements that read vec4 in0, in1 ... and set vec4 out0, out1 ..., which start as 0. */
    const char *body;
    int inputs, outputs; /* 1 .. COMPUTE_INPUTS_MAX, 1 .. COMPUTE_OUTPUTS_MAX */
} ComputeDesc;

/* Compiles the shader; more than four outputs take a program for every four. Fails with
 * WEFT_MESSAGE_GL_COMPILE, _GL_CONTEXT, _MEMORY, or _DESC where a number is out of range. */
WeftResult compute_create(GlContext *context, const ComputeDesc *desc, Compute **out, WeftError *error);

/* Releases it; compute may be NULL. */
void compute_destroy(Compute *compute);

/* Sets the contents of weft_tables (TextDesc.tables): the tables of the text, and any others; none if count
 * is 0. Replaces earlier ones. Fails with WEFT_MESSAGE_GL_MEMORY. */
WeftResult compute_tables(Compute *compute, const TextTable *tables, int count, WeftError *error);

/* Runs the body for n samples: in[k] and out[k] have n vec4 each, 4 n floats. Fails with WEFT_MESSAGE_GL_MEMORY or
 * _GL_CONTEXT; the contents of out are then undefined. */
WeftResult compute_run(Compute *compute, size_t n, const float *const in[], float *const out[], WeftError *error);
