/* v_schlick_ggx - v_smith_ggx with one division, as Unreal Engine 4 began
 *
 *   V = 1 / (4 mix(cos_o, 1, k) mix(cos_i, 1, k)),   k = alpha / 2
 *
 *   Brian Karis, "Real Shading in Unreal Engine 4", SIGGRAPH 2013 course "Physically Based Shading in Theory
 * and Practice": the form of v_schlick_beckmann, k chosen so that it meets v_smith_ggx at alpha 1.
 *   Departure: for lights that engine had k = (roughness + 1)^2 / 8, an artist's wish; that is alpha =
 * (roughness + 1)^2 / 4 here. k > 0 keeps the denominator from 0: no floor is needed. */
#pragma once

#include "shading/terms/v_schlick_beckmann.h"

FN float schlick_ggx_v(float alpha, float o, float i) { return schlick_v(0.5f * alpha, o, i); }
