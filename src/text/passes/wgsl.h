/* wgsl.h - an item of a text of TEXT_PLAIN in the syntax of WGSL, under the names that it has in the text
 *
 *   float f(float x, T t) { ... }      fn f(x: float, t: T) -> float { ... }
 *   float a = x, b; a = b;             var a = x; var b: float; a = b;      let if nothing writes to it
 *   c ? a : b                          select(b, a, c)
 *   if (c) return a;                   if (c) { return a; }
 *
 * A function that writes to a parameter passed by value writes to a copy. Functions do not write through parameters:
 * see returned.h. World Wide Web Consortium, "WebGPU Shading Language", Candidate Recommendation, 2024. */
#pragma once

#include "text/passes/items.h"
#include "text/source/buffer.h"

/* Appends the function. */
void wgsl_put_function(const Item *function, Buffer *out);

/* Appends the members of a record, in braces. */
void wgsl_put_members(const Item *record, Buffer *out);

/* Returns a sentence on the part of a function that cannot be written as WGSL, or NULL: it writes through a parameter,
 * has a loop with do, or a case that falls through to the next. */
const char *wgsl_lacks(const Item *function);
