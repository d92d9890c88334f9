/* reference.h - the references of the dialect (shading/dialect/lang.h) as GLSL has them
 *
 *   const T *m    T m           a parameter that is read
 *   T *m          inout T m     a parameter that is written
 *   m->x, &x, *m  m.x, x, m */
#pragma once

#include "text/source/buffer.h"

/* Appends the declarations and functions of source, in which macros are expanded; each byte keeps its origin. */
void reference_put(const Buffer *source, Buffer *out);
