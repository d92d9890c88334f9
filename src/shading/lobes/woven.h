/* woven - the yarns of one direction in a woven cloth, from afar: streaks across the yarn on a soft ground
 *
 *   f = share (A <single> + rho(A) many)                                                          [1/sr]
 *   <single>: the mean over slopes s_x = roundness r, s_y = tan(crimp) s |s|^(floats - 1), r and s in [-1, 1]
 *
 *   The yarn, its fibres and what hides it are those of shading/yarn_medium.h: flakes of Eric Heitz, Jonathan
 * Dupuy, Cyril Crassin, Carsten Dachsbacher, "The SGGX Microflake Distribution", ACM TOG 34(4), 2015, along
 * yarns as Piti Irawan, Steve Marschner, "Specular Reflection from Woven Cloth", ACM TOG 31(1), 2012, have
 * them. A yarn that goes over one is an arc; one that floats is level for a while: floats is the power of its
 * slope. Fibres run along the yarn, or turn about it by the twist.
 *   The mean is a sum over 4 r and 8 s; one s stands for those up to the next by its mean slope and by a D as
 * much wider as slopes vary. Errors: docs/weave.md.
 *   color: the albedo A of the fibres. The first colour dims light that met one of them, the second, rho(A),
 *     all other light. A cloth of two yarns is two of these lobes, at right angles.
 *   roughness: alpha = roughness^2, the width of the highlight across the fibres' direction: silk 0.1, linen
 *     0.3, cotton 0.4, wool 0.5.
 *   reciprocal: yes.
 *   energy: E <= 1; what is missing is light that the yarns hide from each other.
 *   sampling: cosine.
 *   Not for: cloth so near that threads are told apart, which is yarn.
 *   measured by weft check woven: E at most 0.98 (alpha 1, cos_o 1);
 *     reciprocal to 1e-3; weight variance 1.00 of the cosine's;
 *     half precision: finite for any cosines. */
#ifndef WEFT_WOVEN_H
#define WEFT_WOVEN_H

#include "shading/lobe.h"
#include "shading/warp.h"
#include "shading/yarn_medium.h"

#define WOVEN_PARAMS(P)                                                                                      \
    P(float, alpha, 0.4f, 0.05f, 1.0f, 0.05f, 1.0f, "what a fibre shows along its axis")                     \
    P(float, share, 1.0f, 0.0f, 1.0f, 0.0f, 1.0f, "of the cloth that these yarns cover")                     \
    P(float, crimp, 0.44f, 0.0f, 0.8f, 0.0f, 1.2f, "steepest angle of the yarn along it, radians")           \
    P(float, azimuth, 0.0f, 0.0f, 6.28318531f, -7.0f, 7.0f, "where it runs, from the tangent, radians")      \
    P(float, twist, 0.0f, -0.8f, 0.8f, -1.5f, 1.5f, "of the fibres about the yarn, radians; 0 is filament")  \
    P(float, roundness, 0.9f, 0.0f, 1.2f, 0.0f, 1.5f, "steepest slope across the yarn")                      \
    P(float, floats, 1.0f, 1.0f, 6.0f, 1.0f, 16.0f, "1 plain weave; more where yarns lie level longer")      \
    P(float, cross_crimp, 0.44f, 0.0f, 0.8f, 0.0f, 1.2f, "of the yarns at right angles, radians")
#define WOVEN_TRAITS (TRAIT_RECIPROCAL | TRAIT_CONSERVES | TRAIT_ANISOTROPIC | TRAIT_TWO_COLORS)

STRUCT(Woven){WOVEN_PARAMS(FIELD)};

/* A part of the yarn: s between two bounds, or between their opposites. */
STRUCT(WovenBin) {
    float slope, c;  /* s_y in the middle, and the cosine of its angle */
    float weight;    /* of it in the mean over s, less that of the four r */
    float a2;        /* of the wider D */
    float near, far; /* 1 / |N| at r = 1/4 and 3/4 */
};

STRUCT(WovenPrepared) {
    float alpha, share, roundness, crimp, cross_crimp; /* crimps: slopes, as yarn_area takes them */
    float cos_a, sin_a, cos_t, sin_t;
    WovenBin b0, b1, b2, b3;
};

/* The bin between x and x + 1/4, s = x^(2 / (k + 1)): the mean of the slope over it, and how far it varies. */
FN WovenBin woven_bin(Woven m, float tan_crimp, float x) {
    float k = m.floats, e = 2.0f / (k + 1.0f), x0 = max(x, 1e-3f), x1 = x + 0.25f, a2 = m.alpha * m.alpha;
    float s0 = x > 0.0f ? pow(x0, e) : 0.0f, width = pow(x1, e) - s0, e2 = (2.0f * k + 1.0f) * e;
    float mean = (x1 * x1 - x * x) / ((k + 1.0f) * width);
    float square = (pow(x1, e2) - (x > 0.0f ? pow(x0, e2) : 0.0f)) / ((2.0f * k + 1.0f) * width);
    float near = 0.25f * m.roundness, far = 0.75f * m.roundness;
    WovenBin b;
    b.slope = tan_crimp * mean;
    b.c = 1.0f / sqrt(1.0f + b.slope * b.slope);
    b.weight = width / 8.0f;
    float spread = tan_crimp * b.c * b.c; /* of angles, by that of slopes */
    b.a2 = a2 + (1.0f - a2) * spread * spread * max(square - mean * mean, 0.0f);
    b.near = 1.0f / sqrt(1.0f + b.slope * b.slope + near * near);
    b.far = 1.0f / sqrt(1.0f + b.slope * b.slope + far * far);
    return b;
}

FN void woven_prepare(Woven m, WovenPrepared *p) {
    float tan_crimp = sin(m.crimp) / cos(m.crimp);
    p->alpha = m.alpha;
    p->share = m.share;
    p->roundness = m.roundness;
    p->crimp = tan_crimp / sqrt(m.floats);
    p->cross_crimp = sin(m.cross_crimp) / cos(m.cross_crimp);
    p->cos_a = cos(m.azimuth);
    p->sin_a = sin(m.azimuth);
    p->cos_t = cos(m.twist);
    p->sin_t = sin(m.twist);
    p->b0 = woven_bin(m, tan_crimp, 0.0f);
    p->b1 = woven_bin(m, tan_crimp, 0.25f);
    p->b2 = woven_bin(m, tan_crimp, 0.5f);
    p->b3 = woven_bin(m, tan_crimp, 0.75f);
}
FN float woven_second(Woven m, float f0, float f90) { return yarn_reflectance(f0); }

/* A direction in the frame of the yarn, which runs along y. */
FN Dir woven_turn(const WovenPrepared *p, Dir w) {
    return dir(p->sin_a * w.x - p->cos_a * w.y, p->cos_a * w.x + p->sin_a * w.y, w.z);
}

/* A direction over the cloth. */
STRUCT(WovenView) {
    Dir w; /* in the yarn's frame */
    float seen, left;
};
FN WovenView woven_look(const WovenPrepared *p, Dir w) {
    WovenView v;
    v.w = woven_turn(p, w);
    v.seen = max(yarn_area(v.w, p->share, p->roundness, p->crimp, p->cross_crimp), 1e-4f);
    v.left = yarn_left(p->alpha, w.z);
    return v;
}
FN void woven_view(const WovenPrepared *p, Dir o, WovenView *w) { *w = woven_look(p, o); }

/* t . w = cos twist T . w + sin twist (N x T) . w,  T = c (0, 1, -s_y), N = (s_x, s_y, 1) n. */
FN float woven_along(const WovenPrepared *p, float slope, float c, float x, float n, Dir w) {
    float across = c * x * (slope * w.y + w.z) - w.x / c;
    return p->cos_t * c * (w.y - slope * w.z) + p->sin_t * n * across;
}

/* single V_i V_o of one facet. */
FN float woven_facet(const WovenPrepared *p, float slope, float c, float a2, float x, float n, Dir o, Dir i,
                     float q) {
    return yarn_met_once(a2, q, yarn_facet(o, x, slope), yarn_facet(i, x, slope),
                         woven_along(p, slope, c, x, n, o), woven_along(p, slope, c, x, n, i));
}

/* Summed over the r of one s, and of its opposite. */
FN float woven_row(const WovenPrepared *p, float slope, float c, float a2, float near, float far, Dir o,
                   Dir i, float q) {
    float r = 0.25f * p->roundness;
    return woven_facet(p, slope, c, a2, r, near, o, i, q) + woven_facet(p, slope, c, a2, -r, near, o, i, q) +
           woven_facet(p, slope, c, a2, 3.0f * r, far, o, i, q) +
           woven_facet(p, slope, c, a2, -3.0f * r, far, o, i, q);
}
FN float woven_rows(const WovenPrepared *p, WovenBin b, Dir o, Dir i, float q) {
    return b.weight * (woven_row(p, b.slope, b.c, b.a2, b.near, b.far, o, i, q) +
                       woven_row(p, -b.slope, b.c, b.a2, b.near, b.far, o, i, q));
}

FN LobeValue woven_value(const WovenPrepared *p, const WovenView *w, Angles a) {
    WovenView v = woven_look(p, a.i);
    float q = yarn_half(a);
    float once = woven_rows(p, p->b0, w->w, v.w, q) + woven_rows(p, p->b1, w->w, v.w, q) +
                 woven_rows(p, p->b2, w->w, v.w, q) + woven_rows(p, p->b3, w->w, v.w, q);
    once = once / w->seen / v.seen;
    float many = w->left * v.left / (PI * yarn_left_mean(p->alpha));
    float f = p->share * (once + many);
    return lobe_value_of(f, many / (once + many), warp_cosine_pdf(a.i));
}
FN Dir woven_sample(const WovenPrepared *p, const WovenView *w, Dir o, float u, float v) {
    return warp_cosine(u, v);
}

#endif
