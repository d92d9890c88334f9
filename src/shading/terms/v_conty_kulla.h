/* v_conty_kulla - Smith shadowing fitted to the Charlie distribution
 *
 *   V         = 1 / ((1 + Lambda(cos_o) + Lambda(cos_i)) 4 cos_o cos_i)
 *   Lambda(x) = exp(L(x))               for x < 1/2
 *             = exp(2 L(1/2) - L(1 - x)) else                                                    Equation 3
 *   L(x)      = a / (1 + b x^c) + d x + e,   a..e mixed between two columns by (1 - alpha)^2
 *
 *   Alejandro Conty Estevez, Christopher Kulla, "Production Friendly Microfacet Sheen BRDF", SIGGRAPH 2017
 * course, Table 1 and its interpolation. Khronos Group, KHR_materials_sheen, 2020, uses the same with its
 * alpha.
 *
 *   Departures: cos_o cos_i is at least 1e-7, since a Lambda that stays finite at the horizon lets E grow as
 * 1 / cos_o without bound. And, with the same result: both branches are one evaluation of L at min(x, 1 - x),
 * since L(1/2) needs no second power; and L is summed as a/2 q + d x + (a/2 + e), q = (1 - b x^c) / (1 + b
 * x^c), with 11.5 q + 7 set apart: smaller numbers, whose rounding exp enlarges less. */
#ifndef WEFT_V_CONTY_KULLA_H
#define WEFT_V_CONTY_KULLA_H

#include "shading/lang.h"

/* L of the fit; t = (1 - alpha)^2 mixes alpha = 1 (first number) with alpha = 0 (second). */
FN float conty_kulla_l(float t, float x) {
    float a = mix(-0.72635f, 1.16225f, t), b = mix(3.82987f, 3.32435f, t), c = mix(0.19823f, 0.16801f, t);
    float d = mix(-1.97760f, -1.27393f, t), e = mix(-0.54689f, 0.80258f, t);
    float p = b * pow(max(x, 1e-30f), c), q = (1.0f - p) / (1.0f + p);
    return (11.5f * q + 7.0f) + (a * q + (d * x + e));
}

FN float conty_kulla_lambda(float t, float l_half, float x) {
    float l = conty_kulla_l(t, min(x, 1.0f - x));
    return exp(x < 0.5f ? l : 2.0f * l_half - l);
}

FN float conty_kulla_v(float alpha, float o, float i) {
    float t = (1.0f - alpha) * (1.0f - alpha), l_half = conty_kulla_l(t, 0.5f);
    float lambda = conty_kulla_lambda(t, l_half, o) + conty_kulla_lambda(t, l_half, i);
    return 0.25f / ((1.0f + lambda) * max(o * i, 1e-7f));
}

#endif
