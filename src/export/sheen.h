/* sheen.h - the table of E that an exported material reads */
#pragma once

#include "shading/material/material_stack.h"

/* Fills the table of E of the surface's sheen, over the range of its parameter when the inputs that determine it run
 * from 0 to 1. */
void sheen_table_fill(const Surface *surface, const Choices *choices, AlbedoTable *out);
