/* yarn - a point on a thread of cloth, near enough to tell threads apart
 *
 *   f = A single + rho(A) multiple,  at the slopes s_x, s_y of the yarn                                [1/sr]
 *   t = (cos azimuth, sin azimuth, -s_x cos azimuth - s_y sin azimuth), normalised
 *
 *   shading/media/yarn_medium.h has single, multiple and rho: light on a yarn that is filled with fibres along t and partly
 * hidden by the yarns around. The fibres are flakes of Eric Heitz, Jonathan Dupuy, Cyril Crassin, Carsten Dachsbacher,
 * "The SGGX Microflake Distribution", ACM TOG 34(4), 2015. Slopes and azimuth change from point to point of a thread;
 * the mean of this lobe over threads of two directions is that of two lobes woven.
 *   color: the albedo A of the fibres. The first colour dims light that met one of them, the second, rho(A),
 *     all other light.
 *   roughness: alpha = roughness^2, the width of the highlight across the fibres' direction: silk 0.1, linen
 *     0.3, cotton 0.4, wool 0.5.
 *   reciprocal: yes.
 *   energy: no: a facet that faces the light gets more than its share of the flat cloth. On the mean over a
 *     thread E <= 1.
 *   sampling: by flakes and by cosines about the yarn and the cloth (shading/media/yarn_draw.h). Own.
 *   Not for: cloth from afar, which is woven.
 *   measured by weft check yarn, other parameters at default: E at most 0.98 (alpha 0.36, cos_o 1);
 *     reciprocal to 1e-3; weight variance 0.78 of the cosine's;
 *     half precision: finite for any cosines. */
#pragma once

#include "shading/lobe/lobe.h"
#include "shading/media/yarn_draw.h"

#define YARN_PARAMS(P)                                                                                                 \
    P(float, alpha, 0.4f, 0.05f, 1.0f, 0.05f, 1.0f, "what a fibre shows along its axis")                               \
    P(float, slope_x, 0.0f, -1.0f, 1.0f, -8.0f, 8.0f, "how fast the yarn falls along x")                               \
    P(float, slope_y, 0.0f, -1.0f, 1.0f, -8.0f, 8.0f, "how fast it falls along y")                                     \
    P(float, azimuth, 1.5707963f, 0.0f, 6.28318531f, -7.0f, 7.0f, "where fibres run, from x, radians")                 \
    P(float, roundness, 0.9f, 0.0f, 1.2f, 0.0f, 2.0f, "steepest slope across the yarns around")                        \
    P(float, crimp, 0.47f, 0.0f, 1.0f, 0.0f, 4.0f, "steepest slope along yarns around that run along y")               \
    P(float, cross_crimp, 0.47f, 0.0f, 1.0f, 0.0f, 4.0f, "steepest slope along those that run along x")                \
    P(float, share, 0.5f, 0.0f, 1.0f, 0.0f, 1.0f, "of the cloth: yarns that run along y")
#define YARN_TRAITS (TRAIT_RECIPROCAL | TRAIT_ANISOTROPIC | TRAIT_TWO_COLORS)

STRUCT(Yarn){YARN_PARAMS(FIELD)};

STRUCT(YarnPrepared) {
    Yarn m;
    Dir axis;       /* t */
    float e;        /* (1 - alpha^2) / alpha^2 */
    float per_n;    /* 1 / |(s_x, s_y, 1)| */
    float single;   /* factor of single that depends on alpha alone */
    float multiple; /* factor of multiple that depends on alpha alone */
};
FN void yarn_prepare(Yarn m, YarnPrepared *p) {
    float c = cos(m.azimuth), s = sin(m.azimuth), z = -(m.slope_x * c + m.slope_y * s);
    float r = 1.0f / sqrt(1.0f + z * z);
    p->m = m;
    p->axis = dir(c * r, s * r, z * r);
    float a2 = max(m.alpha * m.alpha, 1e-6f); /* vector lanes of other lobes have alpha 0 */
    p->e = (1.0f - a2) / a2;
    p->per_n = 1.0f / sqrt(1.0f + m.slope_x * m.slope_x + m.slope_y * m.slope_y);
    p->single = 1.0f / (4.0f * PI * a2);
    p->multiple = yarn_multiple(m.alpha, m.roundness);
}
FN float yarn_second(Yarn m, float f0, float f90) { return yarn_reflectance(f0); }

/* A direction w at the point. */
STRUCT(YarnView) {
    float p;         /* P, the area of the yarn that w sees */
    float per_v;     /* 1 / V, V the mean of P over all yarns */
    float along;     /* t . w */
    float remainder; /* R, what single scattering leaves of light from w */
};
FN YarnView yarn_view_of(const YarnPrepared *p, Dir w) {
    YarnView v;
    v.p = yarn_seen_area(w, p->m.slope_x, p->m.slope_y);
    v.per_v = 1.0f / max(yarn_mean_area(w, p->m.share, p->m.roundness, p->m.crimp, p->m.cross_crimp), 1e-4f);
    v.along = dir_dot(w, p->axis);
    v.remainder = yarn_remainder(p->m.alpha, w.z);
    return v;
}
FN void yarn_view(const YarnPrepared *p, Dir o, YarnView *w) { *w = yarn_view_of(p, o); }

FN YarnSurface yarn_surface(const YarnPrepared *p) {
    YarnSurface s;
    s.axis = p->axis;
    s.alpha = p->m.alpha;
    s.slope_x = p->m.slope_x;
    s.slope_y = p->m.slope_y;
    s.per_n = p->per_n;
    return s;
}
FN YarnProposal yarn_proposal(const YarnPrepared *p, const YarnView *w) {
    YarnProposal d;
    d.along = w->along;
    d.c = yarn_flake_chance(p->m.alpha, w->p, w->remainder);
    d.q = 1.0f / (1.0f + 2.0f * w->p * w->per_v);
    return d;
}

FN LobeValue yarn_value(const YarnPrepared *p, const YarnView *w, Angles a) {
    YarnView v = yarn_view_of(p, a.i);
    float by_flake = yarn_single(p->e, yarn_per_sum2(a), w->along + v.along, w->p, v.p, w->along, v.along);
    float single = by_flake * (p->single * w->per_v) * v.per_v;
    float multiple = p->multiple * w->remainder * v.remainder * (w->p * w->per_v + v.p * v.per_v);
    return lobe_value_of(single + multiple, multiple / max(single + multiple, 1e-6f),
                         yarn_draw_pdf(yarn_surface(p), yarn_proposal(p, w), a));
}

FN Dir yarn_sample(const YarnPrepared *p, const YarnView *w, Dir o, float u, float v) {
    return yarn_draw(yarn_surface(p), yarn_proposal(p, w), o, u, v);
}
