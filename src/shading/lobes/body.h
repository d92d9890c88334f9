/* body - the ground of woven cloth and felt: a soft glow back towards the light, darker along the edge
 *
 *   f = color (cos_o cos_i)^edge (1 + retro exp(-tan d / 0.35) + lift sin_d^2) / (pi N)           [1/sr]
 *   cos d = wi . h,  N = 2 / (2 + edge) (1 + retro q + lift m)
 *   q = 0.34585 + 0.0733 edge - 0.0113 edge^2
 *   m = x^edge / (2 (1 + edge)),  x = edge (3 + edge) / ((1 + edge) (2 + edge))
 *
 *   Own fit to measured fabrics, docs/fabrics.md, 2026. Cosines to a power: M. Minnaert, "The Reciprocity
 * Principle in Lunar Photometry", Astrophysical Journal 93, 1941. That rough ground has a peak against
 * the light: Bruce Hapke, "Bidirectional Reflectance Spectroscopy 4", Icarus 67, 1986.
 *   Departures: the peak's shape is fitted.
 *   roughness: none; a material's goes into edge: 0 as bright along the edge, 1 darkest.
 *   reciprocal: yes.
 *   energy: E <= color: N holds the largest E of each of the three parts, the first two at the normal, the
 *     last at cos_o = x.
 *   sampling: cosine; the weight is at most 9 / N.
 *   Not for: highlights and fuzz, which are lobe fabric over this.
 *   measured by weft check body, other parameters at default: E at most 0.99 (edge 1, cos_o 1);
 *     reciprocal to 1e-3; weight variance 1.00 of the cosine's;
 *     half precision: finite for any cosines. */
#pragma once

#include "shading/dialect/warp.h"
#include "shading/lobe/lobe.h"

#define BODY_PARAMS(P)                                                                                                 \
    P(float, edge, 0.1f, 0.0f, 1.0f, 0.0f, 1.0f, "how much it darkens towards the edge; 0: not at all")                \
    P(float, retro, 0.3f, 0.0f, 6.0f, 0.0f, 6.0f, "height of the peak towards the light")                              \
    P(float, lift, 0.3f, 0.0f, 8.0f, 0.0f, 8.0f, "how much brighter it is where light and viewer part")
#define BODY_TRAITS (TRAIT_RECIPROCAL | TRAIT_CONSERVES | TRAIT_DIFFUSE)

STRUCT(Body){BODY_PARAMS(FIELD)};

STRUCT(BodyPrepared) {
    float edge, retro, lift;
    float scale; /* 1 / (pi N) */
};
FN void body_prepare(Body m, BodyPrepared *p) {
    float k = m.edge, x = k * (3.0f + k) / ((1.0f + k) * (2.0f + k));
    float lifted = pow(max(x, 1e-6f), k) / (2.0f * (1.0f + k));
    float peak = 0.34585f + k * (0.0733f - 0.0113f * k); /* at most 0.0002 above the integral */
    p->edge = k;
    p->retro = m.retro;
    p->lift = m.lift;
    p->scale = (2.0f + k) / (2.0f * PI * (1.0f + m.retro * peak + m.lift * lifted));
}
SEEN_AS_IT_IS(body, Body)

FN LobeValue body_value(const BodyPrepared *p, const BodyView *w, Angles a) {
    /* 1 - d^2 has no digits left near the peak */
    float x = a.o.x - a.i.x, y = a.o.y - a.i.y, z = a.o.z - a.i.z, sin2_d = 0.25f * (x * x + y * y + z * z);
    float peak = exp(-sqrt(sin2_d) / (0.35f * max(a.d, 1e-3f)));
    float limb = pow(max(a.o.z * a.i.z, 1e-12f), p->edge);
    return lobe_value_of(p->scale * limb * (1.0f + p->retro * peak + p->lift * sin2_d), 0.0f, warp_cosine_pdf(a.i));
}
FN Dir body_sample(const BodyPrepared *p, const BodyView *w, Dir o, float u, float v) { return warp_cosine(u, v); }
