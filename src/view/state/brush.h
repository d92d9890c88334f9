/* brush.h - laying the nap of a cloth by hand: a picture of directions in texture space */
#ifndef WEFT_VIEW_BRUSH_H
#define WEFT_VIEW_BRUSH_H

#include "weft/image.h"

/* Turns what lies within `radius` of `at` towards `along`, most in the middle. All in UV, v down; along, of
 * any length but 0, is that of the fibres in the surface's frame: along its tangent and its bitangent.
 * strength: 0 .. 1 of the way. The picture repeats: U8 RGB, (2 r - 1, 2 g - 1) a direction, b how far it
 * leans, of its angle. */
void brush_stroke(WeftImage *nap, const float at[2], float radius, const float along[2], float strength);

#endif
