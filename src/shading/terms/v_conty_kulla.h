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
#pragma once

#include "shading/dialect/lang.h"

/* a/2 .. e for one alpha, and 2 L(1/2). */
STRUCT(ContyKulla) { float a, b, c, d, e, twice_half; };

/* Returns L of x. power: x^c. */
FN float conty_kulla_l(ContyKulla k, float x, float power) {
    float p = k.b * power, q = (1.0f - p) / (1.0f + p);
    return (11.5f * q + 7.0f) + (k.a * q + (k.d * x + k.e));
}

/* Returns the coefficients: t = (1 - alpha)^2 mixes those of alpha = 1 (first number) with those of alpha = 0
 * (second). */
FN ContyKulla conty_kulla_of(float alpha) {
    float t = (1.0f - alpha) * (1.0f - alpha);
    ContyKulla k;
    k.a = mix(-0.72635f, 1.16225f, t);
    k.b = mix(3.82987f, 3.32435f, t);
    k.c = mix(0.19823f, 0.16801f, t);
    k.d = mix(-1.97760f, -1.27393f, t);
    k.e = mix(-0.54689f, 0.80258f, t);
    k.twice_half = 2.0f * conty_kulla_l(k, 0.5f, exp2(-k.c));
    return k;
}

/* Returns log Lambda of x. c is so small that x^c loses nothing by log2. */
FN float conty_kulla_log_lambda(ContyKulla k, float x) {
    float least = min(x, 1.0f - x), l = conty_kulla_l(k, least, exp2(k.c * log2(max(least, 1e-30f))));
    return x < 0.5f ? l : k.twice_half - l;
}
FN float conty_kulla_lambda(ContyKulla k, float x) { return exp(conty_kulla_log_lambda(k, x)); }

/* Returns V, given Lambda(cos_o). */
FN float conty_kulla_v_of(ContyKulla k, float lambda_o, float o, float i) {
    return 0.25f / ((1.0f + (lambda_o + conty_kulla_lambda(k, i))) * max(o * i, 1e-7f));
}

FN float conty_kulla_v(float alpha, float o, float i) {
    ContyKulla k = conty_kulla_of(alpha);
    return conty_kulla_v_of(k, conty_kulla_lambda(k, o), o, i);
}
