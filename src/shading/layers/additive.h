/* additive - a sheen laid over the base as if it were made of light
 *
 *   f = sheen + base
 *
 *   As in engines without energy bookkeeping (Brent Burley, "Physically Based Shading at Disney", SIGGRAPH
 * 2012 course, adds its sheen so).
 *   energy: gains E(wo) of the sheen.
 *   reciprocal: yes. */
#ifndef WEFT_LAYER_ADDITIVE_H
#define WEFT_LAYER_ADDITIVE_H

#include "shading/angles.h"

FN float additive_base(Rgb color, float e_o) { return 1.0f; }

#endif
