/* wgsl.h - an item of a plain text in the syntax of WGSL, under the names that it has in the text
 *
 *   float f(float x, T t) { ... }      fn f(x: float, t: T) -> float { ... }
 *   float a = x, b; a = b;             var a = x; var b: float; a = b;      let where nothing writes to it
 *   c ? a : b                          select(b, a, c)
 *   if (c) return a;                   if (c) { return a; }
 *
 * What writes to a parameter of its own writes to a copy. Functions do not write through parameters: see
 * returned.h. World Wide Web Consortium, "WebGPU Shading Language", Candidate Recommendation, 2024. */
#ifndef WEFT_TEXT_WGSL_H
#define WEFT_TEXT_WGSL_H

#include "text/passes/items.h"
#include "text/source/buffer.h"

/* Appends the function. */
void wgsl_put_function(const Item *function, Buffer *out);

/* Appends the members of a record, in braces. */
void wgsl_put_members(const Item *record, Buffer *out);

/* The part of the function that WGSL has no word for here, as a sentence; NULL: none. It writes through a
 * parameter, has a loop with do, or a case that goes on into the next. */
const char *wgsl_lacks(const Item *function);

#endif
