/* v_conty_kulla_soft - v_conty_kulla whose light side fades out before the horizon: no hard terminator
 *
 *   V = 1 / ((1 + Lambda(cos_o) + Lambda(cos_i)^p) 4 cos_o cos_i),   p = 1 + 2 (1 - cos_i)^8
 *
 *   Alejandro Conty Estevez, Christopher Kulla, "Production Friendly Microfacet Sheen BRDF", SIGGRAPH 2017
 * course, section 4, on softening the terminator: the power is on the side of the light alone, and they call
 * it non-physical.
 *   energy: with D charlie E is at most 1.42, where v_conty_kulla has 2.10 (weft check cook-torrance -p
 * d=charlie -p v=conty-kulla-soft -p f=none; both at alpha 0.01, cos_o 0.001). reciprocal: no. Where light
 * grazes, Lambda is above 1 and the power makes it more, so V is less; where the viewer grazes nothing
 * changes. Departures: those of v_conty_kulla. */
#pragma once

#include "shading/terms/v_conty_kulla.h"

FN float conty_kulla_soft_v(float alpha, float o, float i) {
    ContyKulla k = conty_kulla_of(alpha);
    float m = 1.0f - i, m2 = m * m, m4 = m2 * m2, p = 1.0f + 2.0f * m4 * m4;
    float lambda = conty_kulla_lambda(k, o) + exp(p * conty_kulla_log_lambda(k, i));
    return 0.25f / ((1.0f + lambda) * max(o * i, 1e-7f));
}
