/* v_neubelt - a smooth stand-in for the shadowing of cloth
 *
 *   V = 1 / (4 (cos_o + cos_i - cos_o cos_i))
 *
 *   David Neubelt, Matt Pettineo, "Crafting a Next-Gen Material Pipeline for The Order: 1886", SIGGRAPH 2013
 * course "Physically Based Shading in Theory and Practice"; the denominator is that of Michael Ashikhmin,
 * Simon Premoze, "Distribution-based BRDFs", 2007. */
#pragma once

#include "shading/dialect/lang.h"

FN float neubelt_v(float o, float i) { return 0.25f / max(o + i - o * i, 1e-20f); }
