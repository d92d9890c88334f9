/* threads - woven cloth of two yarns, each with a streak and a colour of its own, shifting as in shot silk
 *
 *   f = sum over slopes j of a_j (n_j . wo)+ (n_j . wi)+ S_j C_j / (Q(wo) Q(wi))                [1/sr]
 *   Q(w) = sum a_j (n_j . w)+ >= cos,   a_j = (share of the family) sqrt(1 + crimp^2) / 2
 *   S = (1 - isotropic) g(sin_o + sin_i) cos(phi_d / 2) / (4 max(cos_o, cos_i))
 *     + isotropic / (4 pi (cos_o + cos_i))
 *   C = 1 - u + u / max(cos phi_o, cos phi_i),   u = exp((cos phi_d - 1) / (20 degrees)^2)
 *
 *   Iman Sadeghi, Oleg Bisker, Joachim De Deken, Henrik Wann Jensen, "A Practical Microcylinder Appearance
 *     Model for Cloth Rendering", ACM Transactions on Graphics 32(2), 2013. Warp runs along x, weft along
 *     y; each rises and falls with slopes +crimp and -crimp, on pieces with normal n_j. In S and C the
 *     angles are the paper's: sin and cos of the inclination to the plane across the yarn, phi around the
 *     yarn from n_j, phi_d their difference.
 *   Simplified: two tangents a family; one highlight g in place of the Gaussians of surface and volume,
 *     logistic and in the sum of the sines, so that it integrates to 1 and can be inverted; no Fresnel
 *     term; u in the cosine. C is the paper's shadowing, product and minimum, over cos phi_o cos phi_i.
 *   Departures: the paper divides by Q(wo) alone and by cos^2 theta_d, and is not reciprocal. Divided by
 *     both Q and by the larger cosine it is, and a piece sends up at most what it catches: so E <= 1.
 *   f0 is the colour of the warp, f90 that of the weft.
 *   roughness: a width is the standard deviation of sin_o + sin_i, about twice the paper's gamma in
 *     radians.
 *   reciprocal: yes.
 *   energy: E <= 1; the most found is 0.47, the rest goes down. By default 0.25 at cos_o 0.02, 0.31 at 0.5,
 *     0.34 at the normal.
 *   sampling: a piece by what wo sees of it; along the yarn by g or evenly; around it by the cosine or
 *     evenly. The weight is at most pi.
 *   Not for: knits, and cloth so near that single yarns are visible.
 *   measured by weft check threads, other parameters at default: E at most 0.35 (warp_width 0.1, cos_o 1);
 *     reciprocal to 1e-3; weight variance 0.55 of the cosine's;
 *     half precision: no floor keeps it finite (warp_width 1, cos_o 0.1, cos_i 0.1, phi 0). */
#pragma once

#include "shading/lobe/lobe.h"

#define THREADS_PARAMS(P)                                                                                              \
    P(float, warp_width, 0.3f, 0.1f, 1.0f, 0.05f, 4.0f, "spread of the warp's highlight along x")                      \
    P(float, weft_width, 0.3f, 0.1f, 1.0f, 0.05f, 4.0f, "spread of the weft's highlight along y")                      \
    P(float, weft, 0.5f, 0.0f, 1.0f, 0.0f, 1.0f, "share of the surface that is weft")                                  \
    P(float, warp_crimp, 0.3f, 0.0f, 1.0f, 0.0f, 2.0f, "slope with which the warp rises and falls")                    \
    P(float, weft_crimp, 0.3f, 0.0f, 1.0f, 0.0f, 2.0f, "slope with which the weft rises and falls")                    \
    P(float, isotropic, 0.3f, 0.0f, 1.0f, 0.0f, 1.0f, "part of the light that the yarn scatters evenly")
#define THREADS_TRAITS (TRAIT_RECIPROCAL | TRAIT_CONSERVES | TRAIT_ANISOTROPIC | TRAIT_TWO_COLORS)

STRUCT(Threads){THREADS_PARAMS(FIELD)};
PREPARED_AS_IT_IS(threads, Threads)

/* Returns a direction in the frame of a piece of yarn of that slope: y along the yarn, x across it, z its normal. */
FN Dir threads_to_yarn(Dir w, bool weft, float slope) {
    float along = weft ? w.y : w.x, across = weft ? w.x : w.y, r = 1.0f / sqrt(1.0f + slope * slope);
    return dir(across, (along + slope * w.z) * r, (w.z - slope * along) * r);
}
FN Dir threads_from_yarn(Dir w, bool weft, float slope) {
    float r = 1.0f / sqrt(1.0f + slope * slope), along = (w.y - slope * w.z) * r;
    return dir(weft ? w.x : along, weft ? along : w.x, (w.z + slope * w.y) * r);
}

/* Returns the projected area towards w of one slope of a family, per unit of the family's area. threads_all returns
 * that of all slopes, which is never below w.z. */
FN float threads_projected_area(float along, float z, float slope) { return 0.5f * max(z - slope * along, 0.0f); }
FN float threads_all(Threads m, Dir w) {
    float warp = threads_projected_area(w.x, w.z, m.warp_crimp) + threads_projected_area(w.x, w.z, -m.warp_crimp);
    float weft = threads_projected_area(w.y, w.z, m.weft_crimp) + threads_projected_area(w.y, w.z, -m.weft_crimp);
    return (1.0f - m.weft) * warp + m.weft * weft;
}

STRUCT(ThreadsView) { float all; };
FN void threads_view(const ThreadsPrepared *p, Dir o, ThreadsView *w) { w->all = threads_all(p->m, o); }

/* Returns the area of one slope of a family per unit of cloth. */
FN float threads_area(Threads m, bool weft, float slope) {
    return 0.5f * (weft ? m.weft : 1.0f - m.weft) * sqrt(1.0f + slope * slope);
}

/* Returns the scale of the logistic distribution of standard deviation `width`. The functions below return its density
 * and its cumulative distribution. */
FN float threads_scale(float width) { return 0.551328895f * width; }
FN float threads_density(float scale, float x) {
    float e = exp(-abs(x) / scale);
    return e / (scale * (1.0f + e) * (1.0f + e));
}
FN float threads_below(float scale, float x) {
    float e = exp(-abs(x) / scale);
    return (x < 0.0f ? e : 1.0f) / (1.0f + e);
}

/* Returns f of one piece of yarn, a cylinder, over its own plane. */
FN float threads_yarn(float width, float isotropic, Dir o, Dir i) {
    float co = max(sqrt(o.x * o.x + o.z * o.z), 1e-6f), ci = max(sqrt(i.x * i.x + i.z * i.z), 1e-6f);
    float cos_d = clamp((o.x * i.x + o.z * i.z) / (co * ci), -1.0f, 1.0f);
    float surface = threads_density(threads_scale(width), o.y + i.y) * 0.25f * sqrt(0.5f + 0.5f * cos_d);
    float volume = 0.25f / (PI * (co + ci)), u = exp((cos_d - 1.0f) / 0.12184697f);
    float seen = 1.0f - u + u / max(max(o.z / co, i.z / ci), 1e-6f);
    return ((1.0f - isotropic) * surface / max(co, ci) + isotropic * volume) * seen;
}

/* Returns the contribution to f of one slope of a family, with the part of it that each direction sees. The floor keeps
 * f finite if yarn of hardly any share is all that is visible from the horizon. */
FN float threads_slope(Threads m, Angles a, float all_o, float all_i, bool weft, float slope) {
    Dir o = threads_to_yarn(a.o, weft, slope), i = threads_to_yarn(a.i, weft, slope);
    float seen_o = max(o.z, 0.0f) / max(all_o, 1e-7f);
    float seen_i = max(i.z, 0.0f) / max(all_i, 1e-7f);
    return threads_area(m, weft, slope) * seen_o * seen_i *
           threads_yarn(weft ? m.weft_width : m.warp_width, m.isotropic, o, i);
}

/* Returns the density of samples on one slope. A slope is chosen by its area visible from wo; the inclination along the
 * yarn by the highlight, cut off at the ends, or uniformly; the azimuth around the yarn by the cosine to its plane
 * (3/4) or uniformly. */
FN float threads_pdf_slope(Threads m, Angles a, float all_o, bool weft, float slope) {
    Dir o = threads_to_yarn(a.o, weft, slope), i = threads_to_yarn(a.i, weft, slope);
    float scale = threads_scale(weft ? m.weft_width : m.warp_width);
    float inside = threads_below(scale, o.y + 1.0f) - threads_below(scale, o.y - 1.0f);
    float along = mix(threads_density(scale, o.y + i.y) / inside, 0.5f, m.isotropic);
    float around = 0.375f * i.z / max(sqrt(i.x * i.x + i.z * i.z), 1e-6f) + 0.25f / PI;
    float picked = threads_area(m, weft, slope) * max(o.z, 0.0f) / all_o;
    return i.z > 0.0f ? picked * along * around : 0.0f;
}

FN LobeValue threads_value(const ThreadsPrepared *p, const ThreadsView *w, Angles a) {
    Threads m = p->m;
    float all_i = threads_all(m, a.i), k = m.warp_crimp, l = m.weft_crimp;
    float warp = threads_slope(m, a, w->all, all_i, false, k) + threads_slope(m, a, w->all, all_i, false, -k);
    float weft = threads_slope(m, a, w->all, all_i, true, l) + threads_slope(m, a, w->all, all_i, true, -l);
    float pdf = threads_pdf_slope(m, a, w->all, false, k) + threads_pdf_slope(m, a, w->all, false, -k) +
                threads_pdf_slope(m, a, w->all, true, l) + threads_pdf_slope(m, a, w->all, true, -l);
    return lobe_value_of(warp + weft, weft / max(warp + weft, 1e-30f), pdf);
}

FN Dir threads_sample(const ThreadsPrepared *prepared, const ThreadsView *view, Dir o, float u, float v) {
    Threads m = prepared->m;
    float warp = (1.0f - m.weft) / view->all, weft = m.weft / view->all;
    float a = warp * threads_projected_area(o.x, o.z, m.warp_crimp),
          b = warp * threads_projected_area(o.x, o.z, -m.warp_crimp);
    float c = weft * threads_projected_area(o.y, o.z, m.weft_crimp),
          d = weft * threads_projected_area(o.y, o.z, -m.weft_crimp);
    /* numbers are chosen here, and not conditions, which would keep a loop from being one of vectors */
    float behind = c + d > 0.0f ? u - (a + b) : -1.0f;
    bool second = behind >= 0.0f;
    float w = second ? u - a - b : u, first = second ? c : a, other = second ? d : b;
    float past = other > 0.0f ? w - first : -1.0f;
    bool down = past >= 0.0f;
    float slope = second ? m.weft_crimp : m.warp_crimp;
    slope = down ? -slope : slope;
    w = clamp(down ? past / other : w / max(first, 1e-30f), 0.0f, 1.0f);

    Dir to = threads_to_yarn(o, second, slope);
    float scale = threads_scale(second ? m.weft_width : m.warp_width);
    float low = threads_below(scale, to.y - 1.0f), high = threads_below(scale, to.y + 1.0f);
    float p = clamp(mix(low, high, (w - m.isotropic) / max(1.0f - m.isotropic, 1e-6f)), 1e-7f, 0.9999999f);
    float y = w < m.isotropic ? 2.0f * w / m.isotropic - 1.0f : scale / 1.44269504f * log2(p / (1.0f - p)) - to.y;
    y = clamp(y, -1.0f, 1.0f);
    float phi = PI * (4.0f * v - 3.5f), sin_phi = v < 0.75f ? v * (2.0f / 0.75f) - 1.0f : sin(phi);
    float cos_phi = sqrt(max(1.0f - sin_phi * sin_phi, 0.0f)), r = sqrt(max(1.0f - y * y, 0.0f));
    /* clear of the piece's own horizon, so that rounding does not put it behind */
    return threads_from_yarn(dir(r * sin_phi, y, max(r * cos_phi, 1e-6f)), second, slope);
}
