/* cloth_base.h - the base of a material that is woven, at a point */
#ifndef WEFT_SCENE_CLOTH_BASE_H
#define WEFT_SCENE_CLOTH_BASE_H

#include <stdbool.h>

#include "shading/material_stack.h"
#include "weave/weft_cloth.h"

/* Puts the yarn at texture coordinates uv in the place of the stack's base. side: 1 seen from the front, -1
 * from the back, whose shading frame is mirrored and which shows the same draft. */
void cloth_base(const WeftCloth *cloth, const float uv[2], float side, Stack *stack);

/* Returns true if there is no thread. */
bool cloth_is_gap(const WeftCloth *cloth, const float uv[2]);

#endif
