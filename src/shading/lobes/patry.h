/* patry - fuzz of upright fibres: nothing from above, a glow where it is seen or lit along the surface
 *
 *   f = color p(wo, wi) (1 - exp(-density (cos_o + cos_i) / (cos_o cos_i))) / (cos_o + cos_i)   [1/sr]
 *   p = D(h) / (4 s(wo)),   D(h) = sigma^3 / (pi (sigma^2 sin_h^2 + cos_h^2)^2)
 *   s(w) = sqrt(sin^2 + sigma^2 cos^2)
 *
 *   Jasmin Patry, "Samurai Shading in Ghost of Tsushima", SIGGRAPH 2020 course; the layer: Jan J.
 *     Koenderink, Sylvia C. Pont, "The Secret of Velvety Skin", Machine Vision and Applications 14, 2003; p
 *     and D: Eric Heitz, Jonathan Dupuy, Cyril Crassin, Carsten Dachsbacher, "The SGGX Microflake
 *     Distribution", SIGGRAPH 2015, for fibres along the normal. This is the one-bounce baseline of
 *     tizian/ltc-sheen: albedo 1, extinction the same in all directions.
 *   The denominator in the exponent is cos_o cos_i. A slide of the course has (wo . wi) cos there: a slip,
 *     since the exponent then is not symmetric, and f is negative where wo . wi is. Issue 1 of
 *     tizian/ltc-sheen comes to the same from Koenderink and Pont.
 *   roughness: sigma = roughness^2; tizian/ltc-sheen calls it alpha and leaves it to the artist.
 *   reciprocal: no, p divides by s(wo) alone; the rest is symmetric.
 *   energy: E <= 1/2, since half of p points down; at cos_o 0.02 it is 0.38 at roughness 0.5, and 0.46
 *     at 1.
 *   sampling: half by p, half uniform.
 *   measured by weft check patry, other parameters at default: E at most 0.50 (roughness 1, cos_o 0.001);
 *     f(wo, wi) and f(wi, wo) up to 0.91 of the larger apart; weight variance 0.15 of the cosine's;
 *     half precision: finite for cosines >= 2^-13. */
#pragma once

#include "shading/dialect/warp.h"
#include "shading/lobe/lobe.h"

#define PATRY_PARAMS(P)                                                                                                \
    P(float, roughness, 0.5f, 0.1f, 1.0f, 0.1f, 1.0f, "spread of the fibres' directions about the normal")             \
    P(float, density, 1.0f, 0.1f, 4.0f, 0.01f, 100.0f, "fibres met on the way down, in mean free paths")
#define PATRY_TRAITS TRAIT_CONSERVES

STRUCT(Patry){PATRY_PARAMS(FIELD)};

STRUCT(PatryPrepared) { float sigma, s2, density; };
FN void patry_prepare(Patry m, PatryPrepared *p) {
    p->sigma = m.roughness * m.roughness;
    p->s2 = p->sigma * p->sigma;
    p->density = m.density;
}

/* The length of wo as the fibres see it. */
STRUCT(PatryView) { float length_o; };
FN void patry_view(const PatryPrepared *p, Dir o, PatryView *w) {
    w->length_o = sqrt(o.x * o.x + o.y * o.y + p->s2 * o.z * o.z);
}

FN LobeValue patry_value(const PatryPrepared *p, const PatryView *w, Angles a) {
    float q = p->s2 * (a.h.x * a.h.x + a.h.y * a.h.y) + a.h.z * a.h.z;
    float phase = p->s2 * p->sigma / (4.0f * PI * q * q * w->length_o);
    float y = p->density * (1.0f / a.o.z + 1.0f / a.i.z);
    return lobe_value_of(phase * (1.0f - exp(-y)) / (a.o.z + a.i.z), 0.0f, 0.5f * phase + 0.5f * warp_uniform_pdf(a.i));
}

FN Dir patry_sample(const PatryPrepared *p, const PatryView *w, Dir o, float u, float v) {
    Dir i = warp_uniform(2.0f * u - 1.0f, v);
    if (u < 0.5f) {
        float l = 1.0f / w->length_o;
        float z = 1.0f - 4.0f * u, r = sqrt(max(1.0f - z * z, 0.0f)), phi = 2.0f * PI * v;
        float x = o.x * l + r * cos(phi), y = o.y * l + r * sin(phi), t = p->sigma * (p->sigma * o.z * l + z);
        float n = x * x + y * y + t * t;
        Dir h = o;
        if (n > 1e-20f) {
            n = 1.0f / sqrt(n);
            h = dir(x * n, y * n, t * n);
        }
        i = dir_mirror(o, h);
    }
    return i;
}
