/* fibre - velvet, felt and fuzz as a layer of fibres: a soft rim, brighter and flatter the rougher they are
 *
 *   f = f1 + M,  f1 = D(h) / 4 (1 - exp(-density L / (mu_i mu_o))) / L,  M: fibre_model.h        [1/sr]
 *   L = sigma_i mu_o + sigma_o mu_i,  sigma = sqrt(1 - nu^2 + s^2 nu^2),  nu = w . t,  s = alpha^2
 *   D = s^3 / (pi (s^2 + (1 - s^2) (h . t)^2)^2),  t: the axis of the fibres
 *
 *   The slab of Tizian Zeltner, Brent Burley, Matt Jen-Yuan Chiang, "Practical Multiple-Scattering Sheen
 * Using Linearly Transformed Cosines", SIGGRAPH Talks 2022, of flakes of Eric Heitz, Jonathan Dupuy, Cyril
 * Crassin, Carsten Dachsbacher, "The SGGX Microflake Distribution", ACM TOG 34(4), 2015. f1 is exact: light
 * that met one flake (fibre_medium.h). Departures: M, multiple scattering, is a fitted polynomial instead of a table.
 *   color: the albedo of the fibres; light that met n of them has its n-th power (tint.h). Fitted for alpha
 *     0.045 to 1.
 *   roughness: alpha = roughness^2. Where fibres lean by two degrees or more, alpha below 0.38 counts as 0.38, with
 *     a warning: nothing was fitted there. fibre-walk has no such bound.
 *   reciprocal: yes.
 *   energy: E <= 1; what is missing goes through.
 *   sampling: by a linearly transformed cosine with A and b formulas of alpha and mu_o; where it falls short, at
 *     grazing and where fibres lean, by nu = -nu_o, give or take s, above the horizon; 4 % uniform.
 *   Not for: fibres spun into yarn, which are threads.
 *   measured by weft check fibre, other parameters at default: E at most 0.79 (alpha 0.09, cos_o 0.001);
 *     reciprocal to 1e-3; weight variance under 0.01 of the cosine's;
 *     half precision: finite for cosines >= 2^-11. */
#pragma once

#include "shading/lobe/lobe.h"
#include "shading/ltc/ltc.h"
#include "shading/media/fibre_medium.h"
#include "shading/media/fibre_model.h"

#define FIBRE_PARAMS(P)                                                                                                \
    P(float, alpha, 0.5f, 0.05f, 1.0f, 0.05f, 1.0f, "square root of what a fibre shows along its axis")                \
    P(float, density, 1.0f, 0.25f, 4.0f, 0.25f, 4.0f, "of fibres, times the thickness of the fuzz")                    \
    P(float, tilt, 0.0f, 0.0f, 0.785398163f, 0.0f, 0.785398163f, "how far fibres lean over, radians")                  \
    P(float, azimuth, 0.0f, 0.0f, 6.28318531f, 0.0f, 6.28318531f, "where to, from the tangent, radians")
#define FIBRE_TRAITS (TRAIT_RECIPROCAL | TRAIT_CONSERVES | TRAIT_ANISOTROPIC | TRAIT_TINTED)

STRUCT(Fibre){FIBRE_PARAMS(FIELD)};

/* The lie of fibres: sharpness and lean. The model of leaning fibres was fitted from alpha 0.38 up;
 * sharper ones with a small lean would reflect more than they receive. lobe_fitted warns where this replaces
 * alpha. */
STRUCT(FibreNap) {
    float alpha, s;     /* s = alpha^2 */
    float sin_t, cos_t; /* of the tilt */
    float cos_a, sin_a; /* of the azimuth */
    Dir axis;
};

FN FibreNap fibre_nap_of(float alpha, float tilt, float azimuth) {
    FibreNap n;
    n.alpha = max(alpha, min(2.2f * sqrt(tilt), 0.38f));
    n.s = n.alpha * n.alpha;
    n.sin_t = sin(tilt);
    n.cos_t = cos(tilt);
    n.cos_a = cos(azimuth);
    n.sin_a = sin(azimuth);
    n.axis = dir(n.sin_t * n.cos_a, n.sin_t * n.sin_a, n.cos_t);
    return n;
}

/* Evaluates M^-1 w = (A w_xy + b wo_xy w_z, w_z), divided by A. ln A and b are fitted to upright fibres. */
FN Ltc fibre_ltc(float a, float cos_o) {
    float x = sqrt(cos_o);
    float log_a = (-4.2660f + a * (6.3668f - 2.6138f * a)) + x * (4.4336f + a * (-5.7563f + 2.1627f * a)) +
                  cos_o * (-2.2343f + a * (3.3418f - 1.6143f * a));
    float b = (-0.1178f + a * (-0.7682f + 0.9250f * a)) + x * (1.1469f + a * (-1.2170f - 0.0989f * a)) +
              cos_o * (-1.1981f + a * (2.1293f - 0.8385f * a));
    float z = exp(-log_a);
    return ltc_of(z, 1.0f, b * z, 0.0f, cos_o);
}

/* Light that meets one flake goes to where nu = -nu_o, give or take s: with x = nu + nu_o, x / (b + |x|) is
 * uniform, from where something is above the horizon, nu = -sin tilt, to nu = 1. Around t, from the side that
 * is up, the angle is uniform as far as the horizon. */
STRUCT(FibreDraw) {
    float nu, b, low, high; /* low .. high: of x / (b + |x|) */
    /* fraction of the samples from the cone: above 0 near grazing, if enough of it is above the horizon */
    float cone;
};

FN float fibre_place(float x, float b) { return x / (b + abs(x)); }

FN FibreDraw fibre_draw(FibreNap n, Dir o) {
    FibreDraw c;
    c.nu = dir_dot(o, n.axis);
    c.b = max(n.s, o.z * n.s / (n.sin_t + n.s));
    c.low = fibre_place(c.nu - n.sin_t, c.b);
    c.high = fibre_place(c.nu + 1.0f, c.b);
    float above = max((n.sin_t - c.nu) / n.s + 1.5f, 0.0f);
    float lean = 0.9f * (1.0f - n.s) * n.sin_t / (n.sin_t + 0.25f * n.s) * above / (1.0f + above);
    c.cone = mix(lean, 1.0f, 0.01f / (0.02f + o.z));
    return c;
}

/* Returns the acos of the cosine at which the horizon cuts the circle of that nu, plus at most 2e-4, so that samples
 * cover all of the circle. Milton Abramowitz, Irene A. Stegun, "Handbook of Mathematical Functions", 1964, 4.4.45. */
FN float fibre_reach(FibreNap n, float nu) {
    float r = sqrt(max((1.0f - nu) * (1.0f + nu), 0.0f));
    float x = clamp(nu * n.cos_t / max(r * n.sin_t, 1e-30f), -1.0f, 1.0f), y = abs(x);
    float angle = sqrt(1.0f - y) * (1.5707288f + y * (-0.2121144f + y * (0.0742610f - 0.0187293f * y)));
    return min((x > 0.0f ? PI - angle : angle) + 1e-4f, PI);
}

#define FIBRE_UNIFORM 0.04f

FN float fibre_sample_pdf(FibreNap n, FibreDraw c, Ltc ltc, Angles a) {
    float nu = clamp(dir_dot(a.i, n.axis), -1.0f, 1.0f), d = c.b + abs(nu + c.nu);
    float cone = c.b / (d * d * (c.high - c.low) * 2.0f * fibre_reach(n, nu));
    return mix(mix(ltc_pdf(ltc, a.o, a.i), cone, c.cone), warp_uniform_pdf(a.i), FIBRE_UNIFORM);
}

FN Dir fibre_cone(FibreNap n, FibreDraw c, float u, float v) {
    float place = mix(c.low, c.high, u);
    float nu = clamp(c.b * place / (1.0f - abs(place)) - c.nu, -n.sin_t, 1.0f);
    float r = sqrt(max((1.0f - nu) * (1.0f + nu), 0.0f)), phi = (2.0f * v - 1.0f) * fibre_reach(n, nu);
    float up = r * cos(phi), along = nu * n.sin_t - up * n.cos_t, side = r * sin(phi);
    return dir(along * n.cos_a - side * n.sin_a, along * n.sin_a + side * n.cos_a, nu * n.cos_t + up * n.sin_t);
}

FN Dir fibre_direction(FibreNap n, FibreDraw c, Ltc ltc, Dir o, float u, float v) {
    float rest = (u - FIBRE_UNIFORM) / (1.0f - FIBRE_UNIFORM);
    if (u < FIBRE_UNIFORM) return warp_uniform(u / FIBRE_UNIFORM, v);
    if (rest < c.cone) return fibre_cone(n, c, rest / c.cone, v);
    return ltc_sample(ltc, o, (rest - c.cone) / (1.0f - c.cone), v);
}

STRUCT(FibrePrepared) {
    FibreNap nap;
    float density;
    FibreModel model;
    FibreNumbers numbers;
};
FN void fibre_prepare(Fibre m, FibrePrepared *p) {
    p->nap = fibre_nap_of(m.alpha, m.tilt, m.azimuth);
    p->density = m.density;
    p->model = fibre_model(p->nap.alpha, m.tilt);
    p->numbers = fibre_material_numbers(p->nap.alpha, m.density, p->model.s);
}

STRUCT(FibreView) {
    Ltc ltc;
    FibreDraw draw;
    FibreSide side;
    float sigma;
};
FN void fibre_view(const FibrePrepared *p, Dir o, FibreView *w) {
    w->ltc = fibre_ltc(p->nap.alpha, o.z);
    w->draw = fibre_draw(p->nap, o);
    w->side = fibre_side(p->model, p->numbers, o.z, w->draw.nu);
    w->sigma = flake_sigma(p->nap.s, w->draw.nu);
}

FN LobeValue fibre_value(const FibrePrepared *p, const FibreView *w, Angles a) {
    float nu_i = dir_dot(a.i, p->nap.axis), sigma_i = flake_sigma(p->nap.s, nu_i);
    float single = flake_single_of(p->nap.s, p->nap.axis, p->density, w->sigma, sigma_i, a.o, a.i);
    FibreSide i = fibre_side(p->model, p->numbers, a.i.z, nu_i);
    float dot_across = fibre_dot_across(w->side, i, a.o, a.i),
          multiple = fibre_multiple(p->model, p->numbers, w->side, i, dot_across);
    LobeValue v = lobe_value_of(single + multiple, 0.0f, fibre_sample_pdf(p->nap, w->draw, w->ltc, a));
    v.tint.s = multiple / max(single + multiple, 1e-30f);
    v.tint.q_o = w->side.q;
    v.tint.q_i = i.q;
    v.tint.e = fibre_tint_order(w->side, i, dot_across);
    return v;
}
FN Dir fibre_sample(const FibrePrepared *p, const FibreView *w, Dir o, float u, float v) {
    return fibre_direction(p->nap, w->draw, w->ltc, o, u, v);
}
FN float fibre_fitted(Fibre m) { return fibre_nap_of(m.alpha, m.tilt, m.azimuth).alpha; }

/* Returns the proxy. Leaning fibres are broad, since fibre_nap_of limits their alpha. */
FN Proxy fibre_proxy(Fibre m) {
    if (m.tilt < 0.03f) return proxy_fibres(m.alpha);
    return proxy_cosine();
}
