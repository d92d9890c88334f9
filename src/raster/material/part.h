/* part.h - showing a part of the light, or a property, in place of all */
#pragma once

#include "text/assemble/text.h"
#include "weft/part.h"

/* Returns true if the part is a property and not light. */
bool part_is_property(int part);

/* Defines in a fragment shader's text the part that glsl/forward.glsl shows. */
void part_text(int part, Text *text);
