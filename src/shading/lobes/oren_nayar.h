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
#ifndef WEFT_OREN_NAYAR_H
#define WEFT_OREN_NAYAR_H

#include "shading/warp.h"

#define OREN_NAYAR_PARAMS(P)                                                                                 \
    P(float, sigma, 0.3f, 0.0f, 1.0f, 0.0f, 1.57079633f, "spread of the facets' slopes, radians")
#define OREN_NAYAR_TRAITS (TRAIT_RECIPROCAL | TRAIT_DIFFUSE)

STRUCT(OrenNayar){OREN_NAYAR_PARAMS(FIELD)};

FN float oren_nayar_a(float sigma2) { return 1.0f - 0.5f * sigma2 / (sigma2 + 0.33f); }
FN float oren_nayar_b(float sigma2) { return 0.45f * sigma2 / (sigma2 + 0.09f); }

FN float oren_nayar_eval(OrenNayar m, Angles a) {
    float sigma2 = m.sigma * m.sigma, s = a.o.x * a.i.x + a.o.y * a.i.y;
    return (oren_nayar_a(sigma2) + oren_nayar_b(sigma2) * max(s, 0.0f) / max(a.o.z, a.i.z)) / PI;
}

/* The part of B is uniform, since at grazing it outgrows the cosine. */
FN float oren_nayar_uniform(float sigma2) {
    return oren_nayar_b(sigma2) / (oren_nayar_a(sigma2) + oren_nayar_b(sigma2));
}
FN float oren_nayar_pdf(OrenNayar m, Angles a) {
    return warp_mixed_pdf(oren_nayar_uniform(m.sigma * m.sigma), a.i);
}
FN Dir oren_nayar_sample(OrenNayar m, Dir o, float u, float v) {
    return warp_mixed(oren_nayar_uniform(m.sigma * m.sigma), u, v);
}

#endif
