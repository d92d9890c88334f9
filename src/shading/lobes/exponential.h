/* exponential - a rim that the viewer alone decides: black from above, full at the edge, in any light
 *
 *   f = color x(1 - cos_o) / pi,   x(t) = (1 - exp(-beta t)) / (1 - exp(-beta))                 [1/sr]
 *
 *   x is what a layer of optical thickness beta takes from light on a way of length t, by the law of Johann
 *     Heinrich Lambert, "Photometria", 1760, scaled to 1 at t = 1. Shaders mix a sheen colour in by x; no
 *     paper with that form was found. As a lobe: Lambert of albedo x. Under the layer rules `additive` and
 *     `multiplicative` it gives the two forms of its source: color x is added to the base, or the base is
 *     scaled by 1 + color x.
 *   roughness: beta = mix(0.5, 20, roughness), more is a wider rim; beta to 0 is the ramp x = t. Input
 *     sheen_beta is beta itself.
 *   reciprocal: no, wi is not in it.
 *   energy: E(cos_o) = x(1 - cos_o) exactly, so at most 1.
 *   sampling: cosine, weight constant.
 *   Not for: light from one side; the rim glows wherever a Lambert base would be lit.
 *   measured by weft check exponential: E at most 1.00 (beta 6.35, cos_o 0.001);
 *     f(wo, wi) and f(wi, wo) up to 1.00 of the larger apart; weight variance 1.00 of the cosine's;
 *     half precision: finite for any cosines. */
#pragma once

#include "shading/dialect/warp.h"
#include "shading/lobe/lobe.h"

#define EXPONENTIAL_PARAMS(P)                                                                                          \
    P(float, beta, 3.0f, 0.5f, 20.0f, 0.01f, 100.0f, "how soon the rim is full; low is a straight ramp")
#define EXPONENTIAL_TRAITS TRAIT_CONSERVES

STRUCT(Exponential){EXPONENTIAL_PARAMS(FIELD)};

/* 1 - exp(-y): by its series where the difference would have no digits left. */
FN float exponential_gain(float y) {
    float s = y * (1.0f - y / 2.0f * (1.0f - y / 3.0f * (1.0f - y / 4.0f * (1.0f - y / 5.0f * (1.0f - y / 6.0f)))));
    return y < 0.25f ? s : 1.0f - exp(-y);
}

/* Returns x at t = 1 - cos, which is computed from the tangential part for the same reason. full:
 * exponential_gain(beta). */
FN float exponential_x(float beta, float full, Dir w) {
    float t = (w.x * w.x + w.y * w.y) / (1.0f + w.z);
    return exponential_gain(beta * t) / full;
}

STRUCT(ExponentialPrepared) { float beta, full; };
FN void exponential_prepare(Exponential m, ExponentialPrepared *p) {
    p->beta = m.beta;
    p->full = exponential_gain(m.beta);
}

STRUCT(ExponentialView) { float x; };
FN void exponential_view(const ExponentialPrepared *p, Dir o, ExponentialView *w) {
    w->x = exponential_x(p->beta, p->full, o);
}

FN LobeValue exponential_value(const ExponentialPrepared *p, const ExponentialView *w, Angles a) {
    return lobe_value_of(w->x / PI, 0.0f, warp_cosine_pdf(a.i));
}
FN Dir exponential_sample(const ExponentialPrepared *p, const ExponentialView *w, Dir o, float u, float v) {
    return warp_cosine(u, v);
}
