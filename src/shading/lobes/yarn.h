/* yarn - a point on a thread of cloth, near enough to tell threads apart
 *
 *   f = A single + rho(A) many:  yarn_medium.h, at slopes s_x, s_y                                      [1/sr]
 *   t = (cos azimuth, sin azimuth, -s_x cos azimuth - s_y sin azimuth), normalised
 *
 *   The surface of a yarn and what hides it are those of shading/media/yarn_medium.h; its fibres are flakes of Eric
 * Heitz, Jonathan Dupuy, Cyril Crassin, Carsten Dachsbacher, "The SGGX Microflake Distribution", ACM TOG
 * 34(4), 2015. This is the lobe that changes from
 * point to point of a thread; its mean over threads of two families is that of two lobes woven.
 *   color: the albedo A of the fibres. The first colour dims light that met one of them, the second, rho(A),
 *     all other light.
 *   roughness: alpha = roughness^2, the width of the highlight across the fibres' direction: silk 0.1, linen
 *     0.3, cotton 0.4, wool 0.5.
 *   reciprocal: yes.
 *   energy: no: a facet that faces the light gets more than its share of the flat cloth. On the mean over a
 *     thread E <= 1.
 *   sampling: by flakes and by cosines about the yarn and the cloth (shading/media/yarn_draw.h). Own.
 *   Not for: cloth from afar, which is woven.
 *   measured by weft check yarn: E at most 0.98 (alpha 0.36, cos_o 1);
 *     reciprocal to 1e-3; weight variance 0.78 of the cosine's;
 *     half precision: finite for any cosines. */
#ifndef WEFT_LOBES_YARN_H
#define WEFT_LOBES_YARN_H

#include "shading/lobe/lobe.h"
#include "shading/media/yarn_draw.h"

#define YARN_PARAMS(P)                                                                                       \
    P(float, alpha, 0.4f, 0.05f, 1.0f, 0.05f, 1.0f, "what a fibre shows along its axis")                     \
    P(float, slope_x, 0.0f, -1.0f, 1.0f, -8.0f, 8.0f, "how fast the yarn falls along x")                     \
    P(float, slope_y, 0.0f, -1.0f, 1.0f, -8.0f, 8.0f, "how fast it falls along y")                           \
    P(float, azimuth, 1.5707963f, 0.0f, 6.28318531f, -7.0f, 7.0f, "where fibres run, from x, radians")       \
    P(float, roundness, 0.9f, 0.0f, 1.2f, 0.0f, 2.0f, "steepest slope across the yarns around")              \
    P(float, crimp, 0.47f, 0.0f, 1.0f, 0.0f, 4.0f, "steepest slope along yarns around that run along y")     \
    P(float, cross_crimp, 0.47f, 0.0f, 1.0f, 0.0f, 4.0f, "steepest slope along those that run along x")      \
    P(float, share, 0.5f, 0.0f, 1.0f, 0.0f, 1.0f, "of the cloth: yarns that run along y")
#define YARN_TRAITS (TRAIT_RECIPROCAL | TRAIT_ANISOTROPIC | TRAIT_TWO_COLORS)

STRUCT(Yarn){YARN_PARAMS(FIELD)};

STRUCT(YarnPrepared) {
    Yarn m;
    Dir axis;          /* of the fibres, unit */
    float e;           /* (1 - a^2) / a^2 */
    float over_n;      /* 1 / |(s_x, s_y, 1)| */
    float once, again; /* what single and many are of the numbers that directions add */
};
FN void yarn_prepare(Yarn m, YarnPrepared *p) {
    float c = cos(m.azimuth), s = sin(m.azimuth), z = -(m.slope_x * c + m.slope_y * s);
    float r = 1.0f / sqrt(1.0f + z * z);
    p->m = m;
    p->axis = dir(c * r, s * r, z * r);
    float a2 = max(m.alpha * m.alpha, 1e-6f); /* lanes of other lobes have 0 */
    p->e = (1.0f - a2) / a2;
    p->over_n = 1.0f / sqrt(1.0f + m.slope_x * m.slope_x + m.slope_y * m.slope_y);
    p->once = 1.0f / (4.0f * PI * a2);
    p->again = 0.5f / (PI * yarn_left_mean(m.alpha));
}
FN float yarn_second(Yarn m, float f0, float f90) { return yarn_reflectance(f0); }

/* A direction at the point: P, 1 / V, t . w and the light that one fibre leaves. */
STRUCT(YarnView) { float p, over_seen, along, left; };
FN YarnView yarn_look(const YarnPrepared *p, Dir w) {
    YarnView v;
    v.p = yarn_facet(w, p->m.slope_x, p->m.slope_y);
    v.over_seen = 1.0f / max(yarn_area(w, p->m.share, p->m.roundness, p->m.crimp, p->m.cross_crimp), 1e-4f);
    v.along = dir_dot(w, p->axis);
    v.left = yarn_left(p->m.alpha, w.z);
    return v;
}
FN void yarn_view(const YarnPrepared *p, Dir o, YarnView *w) { *w = yarn_look(p, o); }

FN YarnSurface yarn_surface(const YarnPrepared *p) {
    YarnSurface s;
    s.axis = p->axis;
    s.alpha = p->m.alpha;
    s.slope_x = p->m.slope_x;
    s.slope_y = p->m.slope_y;
    s.over_n = p->over_n;
    return s;
}
FN YarnProposal yarn_proposal(const YarnPrepared *p, const YarnView *w) {
    YarnProposal d;
    d.along = w->along;
    d.flakes = yarn_by_flakes(p->m.alpha, w->p, w->left);
    d.slope = 1.0f / (1.0f + 2.0f * w->p * w->over_seen);
    return d;
}

FN LobeValue yarn_value(const YarnPrepared *p, const YarnView *w, Angles a) {
    YarnView v = yarn_look(p, a.i);
    float met = yarn_met_once(p->e, yarn_half(a), w->along + v.along, w->p, v.p, w->along, v.along);
    float once = met * (p->once * w->over_seen) * v.over_seen;
    float many = p->again * w->left * v.left * (w->p * w->over_seen + v.p * v.over_seen);
    return lobe_value_of(once + many, many / max(once + many, 1e-6f),
                         yarn_draw_pdf(yarn_surface(p), yarn_proposal(p, w), a));
}

FN Dir yarn_sample(const YarnPrepared *p, const YarnView *w, Dir o, float u, float v) {
    return yarn_draw(yarn_surface(p), yarn_proposal(p, w), o, u, v);
}

#endif
