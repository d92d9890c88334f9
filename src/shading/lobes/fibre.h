/* fibre - velvet, felt and fuzz as a layer of fibres: a soft rim, brighter and flatter the rougher they are
 *
 *   f = f1 + M,  f1 = D(h) / 4 (1 - exp(-density L / (mu_i mu_o))) / L,  M: fibre_model.h        [1/sr]
 *   L = sigma_i mu_o + sigma_o mu_i,  sigma = sqrt(1 - nu^2 + s^2 nu^2),  nu = w . t,  s = alpha^2
 *   D = s^3 / (pi (s^2 + (1 - s^2) (h . t)^2)^2),  t: the axis of the fibres
 *
 *   The slab of Tizian Zeltner, Brent Burley, Matt Jen-Yuan Chiang, "Practical Multiple-Scattering Sheen
 * Using Linearly Transformed Cosines", SIGGRAPH Talks 2022, of flakes of Eric Heitz, Jonathan Dupuy, Cyril
 * Crassin, Carsten Dachsbacher, "The SGGX Microflake Distribution", ACM TOG 34(4), 2015. f1 is exact: light
 * that met one flake (fibre_medium.h). Departures: M, what met more, is a closed form instead of a table.
 *   color: the albedo of the fibres; light that met n of them has its n-th power (tint.h).
 *   roughness: alpha = roughness^2; where fibres lean by two degrees or more, alpha below 0.38 counts as
 *     0.38.
 *   reciprocal: yes.
 *   energy: E <= 1; what is missing goes through.
 *   sampling: by a linearly transformed cosine with A and b closed forms in alpha and mu_o; where it falls
 *     short, at grazing and where fibres lean, by nu = -nu_o, give or take s, above the horizon; 4 % uniform.
 *   Not for: fibres spun into yarn, which are threads.
 *   measured by weft check fibre: E at most 0.79 (alpha 0.09, cos_o 0.001);
 *     reciprocal to 1e-3; weight variance under 0.01 of the cosine's;
 *     half precision: finite for cosines >= 2^-13 and alpha >= 0.088. */
#ifndef WEFT_LOBES_FIBRE_H
#define WEFT_LOBES_FIBRE_H

#include "shading/fibre_medium.h"
#include "shading/fibre_model.h"
#include "shading/ltc.h"
#include "shading/tint.h"
#include "shading/warp.h"

#define FIBRE_PARAMS(P)                                                                                      \
    P(float, alpha, 0.5f, 0.05f, 1.0f, 0.05f, 1.0f, "square root of what a fibre shows along its axis")      \
    P(float, density, 1.0f, 0.25f, 4.0f, 0.25f, 4.0f, "of fibres, times the thickness of the fuzz")          \
    P(float, tilt, 0.0f, 0.0f, 0.785398163f, 0.0f, 0.785398163f, "how far fibres lean over, radians")        \
    P(float, azimuth, 0.0f, 0.0f, 6.28318531f, 0.0f, 6.28318531f, "where to, from the tangent, radians")
#define FIBRE_TRAITS (TRAIT_RECIPROCAL | TRAIT_CONSERVES | TRAIT_ANISOTROPIC)

STRUCT(Fibre){FIBRE_PARAMS(FIELD)};

/* The model of leaning fibres was fitted from alpha 0.38 up; sharper ones that lean ever so little would
 * reflect more than they receive. */
FN Fibre fibre_sure(Fibre m) {
    m.alpha = max(m.alpha, min(2.2f * sqrt(m.tilt), 0.38f));
    return m;
}

/* All that a material knows before directions come. */
STRUCT(FibreReady) {
    Fibre m;
    FibreModel model;
    Dir axis;
};

FN FibreReady fibre_ready(Fibre fibre) {
    FibreReady r;
    r.m = fibre_sure(fibre);
    r.model = fibre_model(r.m.alpha, r.m.density, r.m.tilt);
    r.axis = flake_axis(r.m.tilt, r.m.azimuth);
    return r;
}

FN float fibre_single(FibreReady r, Angles a) {
    return flake_single(r.m.alpha * r.m.alpha, r.axis, r.m.density, a.o, a.i);
}

FN float fibre_eval(FibreReady r, Angles a) {
    FibreSide o = fibre_side(r.model, a.o.z, dir_dot(a.o, r.axis));
    FibreSide i = fibre_side(r.model, a.i.z, dir_dot(a.i, r.axis));
    return fibre_single(r, a) + fibre_multiple(r.model, o, i, fibre_turn(o, i, a.o, a.i));
}

FN Tint fibre_tint(FibreReady r, Angles a) {
    FibreSide o = fibre_side(r.model, a.o.z, dir_dot(a.o, r.axis));
    FibreSide i = fibre_side(r.model, a.i.z, dir_dot(a.i, r.axis));
    float turn = fibre_turn(o, i, a.o, a.i), multiple = fibre_multiple(r.model, o, i, turn);
    Tint t;
    t.s = multiple / max(fibre_single(r, a) + multiple, 1e-30f);
    t.q_o = o.q;
    t.q_i = i.q;
    t.e = fibre_deepen(o, i, turn);
    return t;
}

/* M^-1 w = (A w_xy + b wo_xy w_z, w_z), here over A; ln A and b are fitted where fibres stand upright. */
FN Ltc fibre_ltc(Fibre m, Dir o) {
    float a = m.alpha, x = sqrt(o.z);
    float log_a = (-4.2660f + a * (6.3668f - 2.6138f * a)) + x * (4.4336f + a * (-5.7563f + 2.1627f * a)) +
                  o.z * (-2.2343f + a * (3.3418f - 1.6143f * a));
    float b = (-0.1178f + a * (-0.7682f + 0.9250f * a)) + x * (1.1469f + a * (-1.2170f - 0.0989f * a)) +
              o.z * (-1.1981f + a * (2.1293f - 0.8385f * a));
    float z = exp(-log_a);
    return ltc_of(z, 1.0f, b * z, 0.0f, o.z);
}

/* Light that meets one flake goes to where nu = -nu_o, give or take s: with x = nu + nu_o, x / (b + |x|) is
 * uniform, from where something is above the horizon, nu = -sin tilt, to nu = 1. Around t, from the side that
 * is up, the angle is uniform as far as the horizon. */
STRUCT(FibreCone) {
    float nu_o, b, low, high; /* low .. high: of x / (b + |x|) */
    float sin_t, cos_t;       /* of the tilt */
};

FN float fibre_place(float x, float b) { return x / (b + abs(x)); }

FN FibreCone fibre_cone(Fibre m, Dir o) {
    FibreCone c;
    float s = m.alpha * m.alpha;
    c.sin_t = sin(m.tilt);
    c.cos_t = cos(m.tilt);
    c.nu_o = dir_dot(o, flake_axis(m.tilt, m.azimuth));
    c.b = max(s, o.z * s / (c.sin_t + s));
    c.low = fibre_place(c.nu_o - c.sin_t, c.b);
    c.high = fibre_place(c.nu_o + 1.0f, c.b);
    return c;
}

/* acos of the cosine at which the horizon cuts the circle of that nu, and up to 2e-4 more, so that samples
 * cover all of it. Milton Abramowitz, Irene A. Stegun, "Handbook of Mathematical Functions", 1964, 4.4.45. */
FN float fibre_reach(FibreCone c, float nu) {
    float r = sqrt(max((1.0f - nu) * (1.0f + nu), 0.0f));
    float x = clamp(nu * c.cos_t / max(r * c.sin_t, 1e-30f), -1.0f, 1.0f), y = abs(x);
    float angle = sqrt(1.0f - y) * (1.5707288f + y * (-0.2121144f + y * (0.0742610f - 0.0187293f * y)));
    return min((x > 0.0f ? PI - angle : angle) + 1e-4f, PI);
}

/* The share of that: near grazing, and where enough of the circle is above the horizon. */
FN float fibre_cone_share(Fibre m, Dir o, FibreCone c) {
    float s = m.alpha * m.alpha, above = max((c.sin_t - c.nu_o) / s + 1.5f, 0.0f);
    float lean = 0.9f * (1.0f - s) * c.sin_t / (c.sin_t + 0.25f * s) * above / (1.0f + above);
    return mix(lean, 1.0f, 0.01f / (0.02f + o.z));
}

#define FIBRE_UNIFORM 0.04f

FN float fibre_pdf(Fibre fibre, Angles a) {
    Fibre m = fibre_sure(fibre);
    FibreCone c = fibre_cone(m, a.o);
    float nu = clamp(dir_dot(a.i, flake_axis(m.tilt, m.azimuth)), -1.0f, 1.0f), d = c.b + abs(nu + c.nu_o);
    float cone = c.b / (d * d * (c.high - c.low) * 2.0f * fibre_reach(c, nu));
    float lobe = mix(ltc_pdf(fibre_ltc(m, a.o), a.o, a.i), cone, fibre_cone_share(m, a.o, c));
    return mix(lobe, warp_uniform_pdf(a.i), FIBRE_UNIFORM);
}

FN Dir fibre_cone_sample(Fibre m, FibreCone c, float u, float v) {
    float place = mix(c.low, c.high, u);
    float nu = clamp(c.b * place / (1.0f - abs(place)) - c.nu_o, -c.sin_t, 1.0f);
    float r = sqrt(max((1.0f - nu) * (1.0f + nu), 0.0f)), phi = (2.0f * v - 1.0f) * fibre_reach(c, nu);
    float up = r * cos(phi), along = nu * c.sin_t - up * c.cos_t, side = r * sin(phi);
    float x = cos(m.azimuth), y = sin(m.azimuth);
    return dir(along * x - side * y, along * y + side * x, nu * c.cos_t + up * c.sin_t);
}

FN Dir fibre_sample(Fibre fibre, Dir o, float u, float v) {
    Fibre m = fibre_sure(fibre);
    if (u < FIBRE_UNIFORM) return warp_uniform(u / FIBRE_UNIFORM, v);
    FibreCone c = fibre_cone(m, o);
    float rest = (u - FIBRE_UNIFORM) / (1.0f - FIBRE_UNIFORM), share = fibre_cone_share(m, o, c);
    if (rest < share) return fibre_cone_sample(m, c, rest / share, v);
    return ltc_sample(fibre_ltc(m, o), o, (rest - share) / (1.0f - share), v);
}

#endif
