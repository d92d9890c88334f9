/* layout.h - layout of the flattened text: single blank lines, one member of a record a line, enumerations as
 * constants, comments on request */
#pragma once

#include "text/source/buffer.h"

/* Appends source without comments, and without the lines that contained nothing else. out->origin is the origin of
 * source, and advances with its lines. keep: comments stay, except those in directives. */
void layout_strip(const char *source, const char *end, bool keep, Buffer *out);

/* Appends the declarations and functions of source, in which macros are expanded, each line with the origin of its
 * first word. *gap: a blank line is due before the next. Returns NULL, or the construct that GLSL lacks, with
 * out->origin as its place. */
const char *layout_put(const Buffer *source, bool *gap, Buffer *out);
