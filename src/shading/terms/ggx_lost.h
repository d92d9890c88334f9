/* ggx_lost - the light that single scattering between the facets of d_ggx loses, and the lobe that brings it back
 *
 *   L(cos_o) = 1 - E(cos_o),  E: of D V with F = 1, V that of v_smith_ggx_correlated
 *   lost(wo, wi) = L(cos_o) L(cos_i) / (pi Lm),  Lm = 2 int L(c) c dc                              [1/sr]
 *
 *   The integral of lost cos_i is L(cos_o), and lost is reciprocal: Csaba Kelemen, Laszlo Szirmay-Kalos, "A Microfacet
 * Based Coupled Specular-Matte BRDF Model with Importance Sampling", Eurographics 2001 (short papers); Christopher Kulla,
 * Alejandro Conty, "Revisiting Physically Based Shading at Imageworks", SIGGRAPH 2017 course. L and Lm are own fits for
 * alpha .001 to 1: L within .0007 of the integral from cosine .04 on and within .0015 below, Lm within 1e-3 of its own
 * size from alpha .05 on (tests/shading/test_glass). Stretched facets lose more than those of their smaller alpha. */
#pragma once

#include "shading/dialect/angles.h"

FN float ggx_lost(float alpha, float cosine) {
    float a = clamp(alpha, 0.001f, 1.0f), t = a / (max(cosine, 1e-4f) + 1.5f * a);
    float p0 = -0.0100467f + a * (0.360406f + a * (5.2801f - a * 2.10828f));
    float p1 = 0.66361f + a * (-4.58024f + a * (12.1313f * a - 33.7403f));
    float p2 = -0.508745f + a * (16.4847f + a * (95.5879f - a * 32.2618f));
    float p3 = -2.7967f + a * (-23.4115f + a * (42.2923f * a - 126.767f));
    float p4 = 3.15684f + a * (11.6318f + a * (62.2679f - a * 21.1392f));
    float q0 = 1.0f + a * (-0.561426f + a * (0.274621f - a * 0.0271184f));
    float q1 = -5.14981f + a * (1.08392f - a * 0.376707f), q2 = 12.5682f - 0.321494f * a;
    float p = t * (p0 + t * (p1 + t * (p2 + t * (p3 + t * p4)))), q = q0 + t * (q1 + t * (q2 - t * 10.4336f));
    return clamp(p / q, 0.0f, 1.0f);
}

/* Returns Lm. */
FN float ggx_lost_average(float alpha) {
    float a = clamp(alpha, 0.001f, 1.0f);
    float p = a * (-0.0093779f + a * (5.32336f + a * (31.5273f - a * 3.37093f)));
    return max(p / (1.0f + a * (17.8008f + a * (17.8828f + a * 19.963f))), 1e-6f);
}
