/* additive - a sheen laid over the base as if it were made of light
 *
 *   f = sheen + base
 *
 *   As in engines without energy bookkeeping (Brent Burley, "Physically Based Shading at Disney", SIGGRAPH
 * 2012 course, adds its sheen so).
 *   energy: gains c E(wo), all that the sheen reflects.
 *   reciprocal: yes. */
#pragma once

#include "shading/dialect/lang.h"

FN float additive_base(float c, float e_o, float e_i, float e_avg) { return 1.0f; }
