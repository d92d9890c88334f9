/* oren-nayar - clay, plaster, the full moon: flat in front, bright towards the light
 *
 *   f = color (A + B max(0, cos(phi_i - phi_o)) sin(alpha) tan(beta)) / pi           Equation 30 [1/sr]
 *   A = 1 - 0.5 sigma^2 / (sigma^2 + 0.33),  B = 0.45 sigma^2 / (sigma^2 + 0.09)
 *   alpha, beta: the larger and the smaller of theta_i, theta_o
 *
 *   Michael Oren, Shree K. Nayar, "Generalization of Lambert's Reflectance Model", SIGGRAPH 1994, the
 * qualitative model. With s = wi . wo - cos_i cos_o the last product is max(0, s) / max(cos_i, cos_o).
 *   roughness: sigma is the standard deviation of the facets' slope angles, radians.
 *   reciprocal: yes.
 *   energy: no, E passes 1 at the horizon for sigma below 0.326, by 1.5 % at 0.2. Elsewhere light that
 *     meets two facets is lost, 22 % at the normal at sigma 0.5.
 *   sampling: cosine and uniform mixed in the ratio A : B; the weight is at most 2 (A + B).
 *   measured by weft check oren-nayar: E at most 1.01 (sigma 0.2, cos_o 0.005);
 *     reciprocal to 1e-3; weight variance 1.11 of the cosine's;
 *     half precision: finite for cosines >= 2^-17. */
#pragma once

#include "shading/dialect/warp.h"
#include "shading/lobe/lobe.h"

#define OREN_NAYAR_PARAMS(P)                                                                                           \
    P(float, sigma, 0.3f, 0.0f, 1.0f, 0.0f, 1.57079633f, "spread of the facets' slopes, radians")
#define OREN_NAYAR_TRAITS (TRAIT_RECIPROCAL | TRAIT_DIFFUSE)

STRUCT(OrenNayar){OREN_NAYAR_PARAMS(FIELD)};

/* The part of B is drawn uniformly, since at grazing it outgrows the cosine. */
STRUCT(OrenNayarPrepared) { float a, b, uniform_part; };
FN void oren_nayar_prepare(OrenNayar m, OrenNayarPrepared *p) {
    float sigma2 = m.sigma * m.sigma;
    p->a = 1.0f - 0.5f * sigma2 / (sigma2 + 0.33f);
    p->b = 0.45f * sigma2 / (sigma2 + 0.09f);
    p->uniform_part = p->b / (p->a + p->b);
}
SEEN_AS_IT_IS(oren_nayar, OrenNayar)

FN LobeValue oren_nayar_value(const OrenNayarPrepared *p, const OrenNayarView *w, Angles a) {
    float s = a.o.x * a.i.x + a.o.y * a.i.y;
    float f = (p->a + p->b * max(s, 0.0f) / max(a.o.z, a.i.z)) / PI;
    return lobe_value_of(f, 0.0f, warp_uniform_cosine_pdf(p->uniform_part, a.i));
}
FN Dir oren_nayar_sample(const OrenNayarPrepared *p, const OrenNayarView *w, Dir o, float u, float v) {
    return warp_uniform_cosine(p->uniform_part, u, v);
}
