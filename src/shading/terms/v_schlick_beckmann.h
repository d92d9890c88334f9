/* v_schlick_beckmann - v_smith_beckmann with one division: shadows set in sooner and more softly
 *
 *   V = 1 / (4 mix(cos_o, 1, k) mix(cos_i, 1, k)),   k = alpha sqrt(2 / pi)
 *
 *   Christophe Schlick, "An Inexpensive BRDF Model for Physically-based Rendering", Eurographics 1994: G1 =
 * cos / mix(cos, 1, k). k > 0 keeps the denominator from 0: no floor is needed. */
#pragma once

#include "shading/dialect/lang.h"

FN float schlick_v(float k, float o, float i) { return 0.25f / (mix(o, 1.0f, k) * mix(i, 1.0f, k)); }

FN float schlick_beckmann_v(float alpha, float o, float i) { return schlick_v(0.797884561f * alpha, o, i); }
