/* outside_text.h - lobes from outside the catalogue (shading/catalogue/outside.h), as text */
#pragma once

#include "shading/catalogue/outside.h"
#include "text/assemble/text.h"

/* Writes the outside lobes of `there`: their ids, their files, and the functions that lines of dispatch.gen.h call. */
void text_outside(Text *text, const bool there[LOBE_MOST]);

/* Defines the macro by which lines of dispatch.gen.h and lobes.gen.h contain these lobes. */
void text_outside_lines(Text *text, const bool there[LOBE_MOST]);
