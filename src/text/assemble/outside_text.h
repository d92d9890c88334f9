/* outside_text.h - lobes from outside the catalogue (shading/catalogue/outside.h), as text */
#ifndef WEFT_TEXT_OUTSIDE_TEXT_H
#define WEFT_TEXT_OUTSIDE_TEXT_H

#include "shading/catalogue/outside.h"
#include "text/assemble/text.h"

/* Those of `there`: their ids, their files, and what the lines of dispatch.gen.h ask of each. */
void text_outside(Text *text, const bool there[LOBE_MOST]);

/* From here on the lines of dispatch.gen.h and lobes.gen.h are of these lobes. */
void text_outside_lines(Text *text, const bool there[LOBE_MOST]);

#endif
