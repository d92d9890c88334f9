/* fabric - the surface of woven cloth and felt: a soft highlight with a long tail, brighter at grazing
 *
 *   f = n D(h) V(wo, wi) F,   F = f0 (1 - s) + f90 s,   s = (1 - cos d)^rise,   cos d = wi . h       [1/sr]
 *   D = (tail - 1) (1 - alpha^2) / (pi (alpha^(2 (1 - tail)) - 1)) t^-tail
 *   t = sin_h^2 + alpha^2 (3/2 - cos d / 2) cos_h^2
 *   V = 1 / (2 (cos_i L(cos_o) + cos_o L(cos_i))),   L(c) = sqrt(m^2 + (1 - m^2) c^2)
 *   m = 1/4 + alpha / 2,   1 / n = max(1, 1 + (1 / m - 1) (1 - tail (0.85 - 0.5 alpha - 0.2 alpha^2)))
 *
 *   Own fit to measured fabrics, docs/fabrics.md, 2026, of known parts. D: GTR of Brent Burley, "Physically
 * Based Shading at Disney", SIGGRAPH 2012 course, appendix B. Tail 1/2 is that of fibres that lie at random
 * in the plane: their normals fill great circles through the pole.
 *   Departures: alpha^2 grows by half towards grazing; V and F, terms v_smith_ggx_correlated and f_schlick,
 * have a width and a power of their own.
 *   roughness: alpha = roughness^2.
 *   reciprocal: yes.
 *   energy: E <= 1: of the white lobe it is largest at the normal, below 1, or at the horizon, where n
 *     bounds it; the shape of that bound is fitted.
 *   sampling: two of three by D at cos d = 1, which is nowhere below D, the rest uniform.
 *   Not for: satin, whose highlight is stretched; that is silk or threads.
 *   measured by weft check fabric, other parameters at default: E at most 0.98 (alpha 0.99, cos_o 0.001);
 *     reciprocal to 1e-3; weight variance 1.14 of the cosine's;
 *     half precision: finite for cosines >= 2^-13. */
#pragma once

#include "shading/lobe/lobe.h"
#include "shading/terms/facet.h"

#define FABRIC_PARAMS(P)                                                                                               \
    P(float, alpha, 0.35f, 0.05f, 0.99f, 0.05f, 0.99f, "width of the highlight")                                       \
    P(float, tail, 0.6f, 0.25f, 4.0f, 0.25f, 4.0f, "how fast it falls: 0.5 loose fibres, 2 as ggx")                    \
    P(float, rise, 3.0f, 1.0f, 6.0f, 1.0f, 6.0f, "power by which the second colour comes in; ggx has 5")
#define FABRIC_TRAITS (TRAIT_RECIPROCAL | TRAIT_CONSERVES | TRAIT_TWO_COLORS)

STRUCT(Fabric){FABRIC_PARAMS(FIELD)};

STRUCT(FabricPrepared) {
    float a2;           /* alpha^2 */
    float log_a2;       /* and its logarithm */
    float tail, off;    /* off = |1 - tail|, kept from the 0 where D is 0 / 0 */
    float rise, mask2;  /* mask2 = m^2 */
    float scale, bound; /* D = scale t^-tail; bound = n */
};
FN void fabric_prepare(Fabric m, FabricPrepared *p) {
    float mask = 0.25f + 0.5f * m.alpha;
    float graze = 1.0f - m.tail * (0.85f - m.alpha * (0.5f + 0.2f * m.alpha));
    p->a2 = m.alpha * m.alpha;
    p->log_a2 = -facet_fall(1.0f - p->a2, p->a2);
    p->tail = m.tail;
    p->off = max(abs(1.0f - m.tail), 1e-4f);
    p->rise = m.rise;
    p->mask2 = mask * mask;
    float y = -p->off * p->log_a2, full = m.tail > 1.0f ? exp(-y) : 1.0f;
    p->scale = p->off * (1.0f - p->a2) * full / (PI * facet_rise(y));
    p->bound = 1.0f / (1.0f + (1.0f / mask - 1.0f) * max(graze, 0.0f));
}

FN float fabric_length(const FabricPrepared *p, float c) { return sqrt(mix(c * c, 1.0f, p->mask2)); }

STRUCT(FabricView) { float length_o; };
FN void fabric_view(const FabricPrepared *p, Dir o, FabricView *w) { w->length_o = fabric_length(p, o.z); }

/* Returns D for alpha^2 multiplied by `wider`. */
FN float fabric_spread(const FabricPrepared *p, Angles a, float wider) {
    return p->scale * pow(a.sin2_h + p->a2 * wider * a.h.z * a.h.z, -p->tail);
}

#define FABRIC_UNIFORM (1.0f / 3.0f)

FN LobeValue fabric_value(const FabricPrepared *p, const FabricView *w, Angles a) {
    float d = min(a.d, 1.0f), s = pow(max(1.0f - d, 1e-9f), p->rise);
    float shadow = 0.5f / max(a.i.z * w->length_o + a.o.z * fabric_length(p, a.i.z), 1e-12f);
    float drawn = facet_pdf(fabric_spread(p, a, 1.0f) * a.h.z, a);
    return lobe_value_of(p->bound * fabric_spread(p, a, 1.5f - 0.5f * d) * shadow, s,
                         mix(drawn, warp_uniform_pdf(a.i), FABRIC_UNIFORM));
}

/* Returns h from D cos_h. t^(1 - tail) is uniform between its values at the normal and at the horizon. y and up are
 * those of fabric_prepare; they stay away from 1 whether the tail is above or below 1. */
FN Dir fabric_facet(const FabricPrepared *p, float u, float v) {
    float y = -p->off * p->log_a2, up = facet_rise(y), part = p->tail > 1.0f ? u * up : (1.0f - u) * up;
    float along = facet_fall(part, 1.0f - part) / y;
    float log_t = p->log_a2 * (p->tail > 1.0f ? 1.0f - along : along);
    float cos2 = clamp(facet_rise(-log_t) / (1.0f - p->a2), 0.0f, 1.0f);
    return facet(sqrt(1.0f - cos2), sqrt(cos2), v);
}
FN Dir fabric_sample(const FabricPrepared *p, const FabricView *w, Dir o, float u, float v) {
    float rest = (u - FABRIC_UNIFORM) / (1.0f - FABRIC_UNIFORM);
    if (u < FABRIC_UNIFORM) return warp_uniform(u / FABRIC_UNIFORM, v);
    return dir_mirror(o, facet_towards(o, fabric_facet(p, rest, v)));
}

/* Returns the proxy. Tail 2 is that of ggx, 1 that of gtr1; a smaller one is hazier. */
FN Proxy fabric_proxy(Fabric m) {
    float width = pow(m.alpha, min(0.5f * m.tail, 1.0f));
    return proxy_facets(width, width);
}
