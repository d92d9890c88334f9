/* yarn - a point on a thread of cloth, near enough to tell threads apart
 *
 *   f = A single + rho(A) many:  yarn_medium.h, at slopes s_x, s_y                                      [1/sr]
 *   t = (cos azimuth, sin azimuth, -s_x cos azimuth - s_y sin azimuth), normalised
 *
 *   The surface of a yarn and what hides it are those of shading/yarn_medium.h; its fibres are flakes of Eric
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
 *   sampling: of the light that met one fibre by the flakes that are seen, as their paper's section 4 has it: a sphere
 *     stretched along t. What would go down is mirrored at the yarn: pdf = (D(h) + D(h')) / (4 sigma_o), h' of the
 *     mirrored direction. Other light by the cosine. Own.
 *   Not for: cloth from afar, which is woven.
 *   measured by weft check yarn: E at most 0.98 (alpha 0.36, cos_o 1);
 *     reciprocal to 1e-3; weight variance 1.74 of the cosine's;
 *     half precision: finite for any cosines. */
#ifndef WEFT_LOBES_YARN_H
#define WEFT_LOBES_YARN_H

#include "shading/lobe.h"
#include "shading/warp.h"
#include "shading/yarn_medium.h"

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
    Dir axis;    /* of the fibres, unit */
    float a2, e; /* a^2, and (1 - a^2) / a^2 */
};
FN void yarn_prepare(Yarn m, YarnPrepared *p) {
    float c = cos(m.azimuth), s = sin(m.azimuth), z = -(m.slope_x * c + m.slope_y * s);
    float r = 1.0f / sqrt(1.0f + z * z);
    p->m = m;
    p->axis = dir(c * r, s * r, z * r);
    p->a2 = max(m.alpha * m.alpha, 1e-6f); /* lanes of other lobes have 0 */
    p->e = (1.0f - p->a2) / p->a2;
}
FN float yarn_second(Yarn m, float f0, float f90) { return yarn_reflectance(f0); }

/* A direction at the point: P, V, t . w and the light that one fibre leaves. */
STRUCT(YarnView) { float p, seen, along, left; };
FN YarnView yarn_look(const YarnPrepared *p, Dir w) {
    YarnView v;
    v.p = yarn_facet(w, p->m.slope_x, p->m.slope_y);
    v.seen = max(yarn_area(w, p->m.share, p->m.roundness, p->m.crimp, p->m.cross_crimp), 1e-4f);
    v.along = dir_dot(w, p->axis);
    v.left = yarn_left(p->m.alpha, w.z);
    return v;
}
FN void yarn_view(const YarnPrepared *p, Dir o, YarnView *w) { *w = yarn_look(p, o); }

/* The share of samples by flakes: a little more than that of the light that met one of them, since cloth is not white. */
FN float yarn_flakes_p(const YarnView *w) { return w->p > 0.0f ? 1.1f - w->left : 0.0f; }

/* |wi' + wo|^2 = (t . (wi + wo))^2 + (b . (wi + wo))^2 + (n . (wi - wo))^2:  wi' is mirrored at the plane of the yarn,
 * whose normal is n, and b = n x t */
FN float yarn_density(const YarnPrepared *p, const YarnView *w, YarnView v, Angles a) {
    float x = p->m.slope_x, y = p->m.slope_y, m = w->along + v.along, rise = w->p - v.p;
    Dir t = p->axis, both = dir(a.o.x + a.i.x, a.o.y + a.i.y, a.o.z + a.i.z);
    float b = dir_dot(dir(y * t.z - t.y, t.x - x * t.z, x * t.y - y * t.x), both);
    float mirrored = 1.0f / max(m * m + (b * b + rise * rise) / (1.0f + x * x + y * y), 1e-6f);
    float d = yarn_flakes(p->a2, m, yarn_half(a)) + yarn_flakes(p->a2, m, mirrored);
    float flakes = v.p > 0.0f ? 0.25f * d / yarn_flake_area(p->a2, w->along) : 0.0f;
    return mix(warp_cosine_pdf(a.i), flakes, yarn_flakes_p(w));
}

FN LobeValue yarn_value(const YarnPrepared *p, const YarnView *w, Angles a) {
    YarnView v = yarn_look(p, a.i);
    float met = yarn_met_once(p->e, yarn_half(a), w->p, v.p, w->along, v.along);
    float once = met / (4.0f * PI * p->a2) / w->seen / v.seen;
    float many =
        w->left * v.left / (PI * yarn_left_mean(p->m.alpha)) * 0.5f * (w->p / w->seen + v.p / v.seen);
    return lobe_value_of(once + many, many / max(once + many, 1e-6f), yarn_density(p, w, v, a));
}

/* A flake that o sees, not unit. Where the stretch of t is taken back, flakes are a sphere, and what o sees of it has a
 * density of the cosine about s, as the sum of s and a point of the unit sphere has. */
FN Dir yarn_flake(const YarnPrepared *p, float along, Dir o, float u, float v) {
    float r = 2.0f * sqrt(max(u * (1.0f - u), 0.0f)), phi = 2.0f * PI * v, k = (p->m.alpha - 1.0f) * along;
    Dir s = dir(o.x + k * p->axis.x, o.y + k * p->axis.y, o.z + k * p->axis.z);
    float over = 1.0f / sqrt(max(dir_dot(s, s), 1e-12f));
    Dir h = dir(s.x * over + r * cos(phi), s.y * over + r * sin(phi), s.z * over + 1.0f - 2.0f * u);
    k = (p->m.alpha - 1.0f) * dir_dot(p->axis, h);
    return dir(h.x + k * p->axis.x, h.y + k * p->axis.y, h.z + k * p->axis.z);
}

FN Dir yarn_sample(const YarnPrepared *p, const YarnView *w, Dir o, float u, float v) {
    float flakes = yarn_flakes_p(w), x = p->m.slope_x, y = p->m.slope_y;
    bool once = u < flakes;
    float again = min((u - flakes) / (1.0f - flakes), 1.0f);
    Dir h = yarn_flake(p, w->along, o, min(u / max(flakes, 1e-6f), 1.0f), v),
        i = warp_cosine(max(again, 0.0f), v);
    float d = 2.0f * dir_dot(o, h) / max(dir_dot(h, h), 1e-12f);
    Dir m = dir(d * h.x - o.x, d * h.y - o.y, d * h.z - o.z);
    float down = 2.0f * min(m.x * x + m.y * y + m.z, 0.0f) / (1.0f + x * x + y * y);
    if (once) i = dir(m.x - down * x, m.y - down * y, m.z - down);
    return i;
}

#endif
