/* type.h - one line of text on a Cairo surface, of any bytes */
#pragma once

#include <cairo.h>
#include <stdbool.h>

#include "weft/result.h"

enum { TEXT_MAX = 256, ELLIPSIS = 3, TEXT_SIZE = TEXT_MAX + ELLIPSIS + 1 };

/* Chooses DejaVu Sans. A font that cannot be loaded is an error of the drawing: drawn tells it. */
void set_font(cairo_t *cairo, double size, bool bold);

/* Returns WEFT_OK, or fails with WEFT_MESSAGE_MEMORY if a drawing has gone wrong; what: its name in the message. */
WeftResult drawn(cairo_t *cairo, const char *what, WeftError *error);

/* Copies text so that Cairo can draw it: at most TEXT_MAX bytes, without control characters and malformed UTF-8. */
void drawable(const char *text, char line[TEXT_SIZE]);

double text_width(cairo_t *cairo, const char *text);

/* Writes text from x on; a text wider than `width` is shortened with an ellipsis. */
void write_text(cairo_t *cairo, const double color[3], double x, double y, double width, const char *text);

/* Works as write_text, with x at `share` of the text's width: 0 is its left end, 0.5 its middle, 1 its right
 * end. */
void place_text(cairo_t *cairo, const double color[3], double x, double y, double share, const char *text);
