/* eon - clay as oren-nayar has it, but with the light that scatters between facets: brighter and deeper in colour
 *
 *   f = (rho A (1 + roughness s / t) + rho_ms M) / pi                                            [1/sr]
 *   A = 1 / (1 + C1 roughness),  C1 = 1/2 - 2 / (3 pi),  C2 = 2/3 - 28 / (15 pi)
 *   s = wi . wo - cos_i cos_o,  t = max(cos_i, cos_o) where s > 0, else 1
 *   M = (1 - E(cos_i)) (1 - E(cos_o)) / (1 - Eavg),  Eavg = A (1 + C2 roughness)
 *   E(mu) = A (1 + roughness G(mu) / pi),  rho_ms = rho^2 Eavg / (1 - rho (1 - Eavg))
 *   G(cos x) = sin x (x - sin x cos x) + 2/3 (tan x (1 - sin^3 x) - sin x)
 *
 *   Jamie Portsmouth, Peter Kutz, Stephen Hill, "EON: A Practical Energy-Preserving Rough Diffuse BRDF", JCGT
 * 14(1), 2025. color = rho is the first colour, rho_ms the second, whatever f90 is.
 *   Departures: 1 - E = A roughness (C1 - G / pi) and 1 - Eavg = A roughness (C1 - C2), which divides nothing
 * by nothing at roughness 0; x by the arc cosine 4.4.45 of Milton Abramowitz, Irene A. Stegun, "Handbook of
 * Mathematical Functions", 1964; rho in the denominator is at most 1.
 *   roughness: 0 is Lambert, 1 the roughest; not squared.
 *   reciprocal: yes.  energy: E = 1 within 2e-5 for rho 1, and rho E(cos_o) + rho_ms (1 - E(cos_o)) for any.
 *   sampling: cosine and uniform mixed in the ratio 1 : roughness; the weight is at most 3.2.
 *   measured by weft check eon: E at most 1.00 (roughness 0, cos_o 1);
 *     reciprocal to 1e-3; weight variance 0.96 of the cosine's;
 *     half precision: finite for cosines >= 2^-11. */
#pragma once

#include "shading/dialect/warp.h"
#include "shading/lobe/lobe.h"

#define EON_PARAMS(P)                                                                                                  \
    P(float, roughness, 0.5f, 0.0f, 1.0f, 0.0f, 1.0f, "0 is Lambert, 1 the brightest towards the light")
#define EON_TRAITS (TRAIT_RECIPROCAL | TRAIT_CONSERVES | TRAIT_LOSSLESS | TRAIT_DIFFUSE | TRAIT_TWO_COLORS)
#define EON_C1     (0.5f - 2.0f / (3.0f * PI))
#define EON_C2     (2.0f / 3.0f - 28.0f / (15.0f * PI))

STRUCT(Eon){EON_PARAMS(FIELD)};

FN float eon_a(Eon m) { return 1.0f / (1.0f + EON_C1 * m.roughness); }

FN float eon_second(Eon m, float f0, float f90) {
    float avg = eon_a(m) * (1.0f + EON_C2 * m.roughness);
    return f0 * f0 * avg / (1.0f - min(f0, 1.0f) * (1.0f - avg));
}

/* The part of s / t is drawn uniformly, since at grazing it outgrows the cosine. */
STRUCT(EonPrepared) { float roughness, a, uniform_part; };
FN void eon_prepare(Eon m, EonPrepared *p) {
    p->roughness = m.roughness;
    p->a = eon_a(m);
    p->uniform_part = m.roughness / (1.0f + m.roughness);
}

/* Returns C1 - G / pi: the loss of single scattering towards that cosine, over A roughness. */
FN float eon_lost(float z) {
    float s = sqrt(max(1.0f - z * z, 0.0f));
    float p = 1.5707288f - z * (0.2121144f - z * (0.0742610f - z * 0.0187293f));
    float x = sqrt(max(1.0f - z, 0.0f)) * p;
    float g = s * (x - s * z) + 2.0f / 3.0f * s * (z * (1.0f + s + s * s) / (1.0f + s) - 1.0f);
    return max(EON_C1 - g / PI, 0.0f);
}

STRUCT(EonView) { float lost_o; };
FN void eon_view(const EonPrepared *p, Dir o, EonView *w) { w->lost_o = p->roughness * eon_lost(o.z); }

/* Returns both parts of a white lobe; f is over A / pi. */
FN LobeValue eon_value(const EonPrepared *p, const EonView *w, Angles a) {
    float s = a.o.x * a.i.x + a.o.y * a.i.y, t = s > 0.0f ? max(a.o.z, a.i.z) : 1.0f;
    float first = max(1.0f + p->roughness * s / t, 0.0f), rest = w->lost_o * eon_lost(a.i.z) / (EON_C1 - EON_C2);
    return lobe_value_of(p->a * (first + rest) / PI, rest / max(first + rest, 1e-12f),
                         warp_uniform_cosine_pdf(p->uniform_part, a.i));
}
FN Dir eon_sample(const EonPrepared *p, const EonView *w, Dir o, float u, float v) {
    return warp_uniform_cosine(p->uniform_part, u, v);
}
