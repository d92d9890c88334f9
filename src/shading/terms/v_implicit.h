/* v_implicit - no shadowing but what keeps the formula simple: darker towards grazing than any other here
 *
 *   V = 1 / 4,   that is G = cos_o cos_i
 *
 *   The choice by which 4 cos_o cos_i cancels; named in Naty Hoffman, "Background: Physics and Math of
 * Shading", SIGGRAPH 2013 course, and in Brian Karis, "Specular BRDF Reference", 2013. */
#pragma once

#include "shading/dialect/lang.h"

FN float implicit_v(float o, float i) { return 0.25f; }
