/* layout.h - layout of the flattened text: single blank lines, one member of a record a line, enumerations as
 * constants, comments on request */
#ifndef WEFT_TEXT_LAYOUT_H
#define WEFT_TEXT_LAYOUT_H

#include "text/source/buffer.h"

/* Appends source without comments, and without the lines that held nothing else. out->origin is where source
 * comes from, and moves on with its lines. keep: comments stay, but for those in directives. */
void layout_strip(const char *source, const char *end, bool keep, Buffer *out);

/* Appends the declarations and functions of source, in which nothing is left to expand, each line with the
 * origin of its first word. *gap: a blank line is due before the next. Returns NULL, or what is in the way of
 * GLSL, of which out->origin is then the place. */
const char *layout_put(const Buffer *source, bool *gap, Buffer *out);

#endif
