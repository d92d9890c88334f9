/* native.h - the dialect's calls on vectors in a shading language's own operators
 *
 *   rgb_add(a, rgb_scale(b, k))     a + b * k
 *   dir_dot(o, h)                   dot(o, h) */
#pragma once

#include "text/source/buffer.h"

/* Appends the text. */
void native_put(const char *text, Buffer *out);
