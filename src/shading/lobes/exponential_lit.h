/* exponential-lit - the rim of exponential, but a light has to graze the cloth to light it
 *
 *   f = color x(1 - cos_o) x(1 - cos_i) / (pi A)                                                [1/sr]
 *   A = integral 2 c x(1 - c) dc = (1 - 2 (beta - 1 + exp(-beta)) / beta^2) / (1 - exp(-beta))
 *
 *   x: lobe exponential. The bare product x(1 - cos_o) x(1 - cos_i) / pi is reciprocal too, but its E is A
 *     x, which loses two thirds of the rim at small beta. Divided by A, the mean of x under a uniform
 *     light, E is x, so that both lobes weigh the same in a layer. The construction: Csaba Kelemen,
 *     Laszlo Szirmay-Kalos, "A Microfacet Based Coupled Specular-Matte BRDF Model with Importance
 *     Sampling", Eurographics 2001 short papers.
 *   roughness: beta as of exponential.
 *   reciprocal: yes.
 *   energy: E(cos_o) = x(1 - cos_o) exactly, so at most 1.
 *   sampling: cosine and uniform, mixed by A; the weight is at most 1.5.
 *   measured by weft check exponential-lit: E at most 1.00 (beta 6.35, cos_o 0.001);
 *     reciprocal to 1e-3; weight variance 0.69 of the cosine's;
 *     half precision: finite for any cosines. */
#pragma once

#include "shading/lobes/exponential.h"

#define EXPONENTIAL_LIT_PARAMS(P)                                                                                      \
    P(float, beta, 3.0f, 0.5f, 20.0f, 0.01f, 100.0f, "how soon the rim is full; low is a straight ramp")
#define EXPONENTIAL_LIT_TRAITS (TRAIT_RECIPROCAL | TRAIT_CONSERVES)

STRUCT(ExponentialLit){EXPONENTIAL_LIT_PARAMS(FIELD)};

/* Returns the mean of x weighted by the cosine, by its series where the closed form would cancel. */
FN float exponential_lit_mean(float beta) {
    float e = 1.0f - beta / 6.0f * (1.0f - beta / 7.0f * (1.0f - beta / 8.0f));
    e = 1.0f - beta / 4.0f * (1.0f - beta / 5.0f * e);
    float numerator = beta < 0.5f ? beta / 3.0f * e : 1.0f - 2.0f * (beta - exponential_gain(beta)) / (beta * beta);
    return numerator / exponential_gain(beta);
}

/* A steep x leaves a cosine, a flat one about cos (1 - cos): cosine and uniform mixed by where A is between.
 */
STRUCT(ExponentialLitPrepared) { float beta, full, mean, cosine_part; };
FN void exponential_lit_prepare(ExponentialLit m, ExponentialLitPrepared *p) {
    p->beta = m.beta;
    p->full = exponential_gain(m.beta);
    p->mean = exponential_lit_mean(m.beta);
    p->cosine_part = clamp(1.5f * p->mean - 0.5f, 0.0f, 1.0f);
}

STRUCT(ExponentialLitView) { float x; };
FN void exponential_lit_view(const ExponentialLitPrepared *p, Dir o, ExponentialLitView *w) {
    w->x = exponential_x(p->beta, p->full, o);
}

FN LobeValue exponential_lit_value(const ExponentialLitPrepared *p, const ExponentialLitView *w, Angles a) {
    float f = w->x * exponential_x(p->beta, p->full, a.i) / (PI * p->mean);
    return lobe_value_of(f, 0.0f, mix(warp_uniform_pdf(a.i), warp_cosine_pdf(a.i), p->cosine_part));
}
FN Dir exponential_lit_sample(const ExponentialLitPrepared *p, const ExponentialLitView *w, Dir o, float u, float v) {
    float q = p->cosine_part;
    Dir i = warp_uniform((u - q) / max(1.0f - q, 1e-6f), v);
    if (u < q) i = warp_cosine(u / q, v);
    return i;
}
