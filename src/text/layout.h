/* layout.h - how the flattened text looks: no comments, one blank line where there were some, records a
 * member a line, enumerations as constants */
#ifndef WEFT_TEXT_LAYOUT_H
#define WEFT_TEXT_LAYOUT_H

#include "text/buffer.h"

/* Appends source without comments, and without the lines that held nothing else. */
void layout_strip(const char *source, const char *end, Buffer *out);

/* Appends the declarations and functions of source, in which nothing is left to expand. *gap: a blank line is
 * due before the next. Returns NULL, or what is in the way of GLSL. */
const char *layout_put(const char *source, const char *end, bool *gap, Buffer *out);

#endif
