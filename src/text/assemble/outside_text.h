/* outside_text.h - lobes from outside the catalogue (shading/catalogue/outside.h), as text */
#ifndef WEFT_TEXT_OUTSIDE_TEXT_H
#define WEFT_TEXT_OUTSIDE_TEXT_H

#include "shading/catalogue/outside.h"
#include "text/assemble/text.h"

/* Writes the outside lobes of `there`: their ids, their files, and the functions that lines of dispatch.gen.h call. */
void text_outside(Text *text, const bool there[LOBE_MOST]);

/* Defines the macro by which lines of dispatch.gen.h and lobes.gen.h contain these lobes. */
void text_outside_lines(Text *text, const bool there[LOBE_MOST]);

#endif
