/* brush.h - brushing the nap of a cloth by hand, in a picture of directions in texture space */
#pragma once

#include "weft/image.h"

/* Rotates the nap within `radius` of `at` towards `along`, most in the middle. at and radius are in UV, v down; along,
 * of any length but 0, is a direction of the fibres in tangent space. strength is the fraction of the way, 0 to 1. The
 * picture repeats: U8 RGB, (2 r - 1, 2 g - 1) is the direction, b the lean as a fraction of the nap's angle. */
void brush_stroke(WeftImage *nap, const float at[2], float radius, const float along[2], float strength);
