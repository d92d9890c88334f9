/* flatten.h - a shader as one main on numbers and vectors
 *
 * Calls are followed, records taken apart, constants folded, and what no output depends on is left out: compilers of
 * drivers take most of their time to do the same. */
#pragma once

#include "text/source/buffer.h"

/* The first thing in a text that is not understood: "a name: gl_SampleID". */
typedef struct FlattenGap {
    char what[128];
} FlattenGap;

/* Appends a shader that draws what the text draws. Returns false, and appends nothing, if something is not understood
 * or memory is short; gap may be NULL. */
bool flatten_text(const char *text, Buffer *out, FlattenGap *gap);
