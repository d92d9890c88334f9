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
 *   measured by weft check patry: E at most 0.50 (roughness 1, cos_o 0.001);
 *     f(wo, wi) and f(wi, wo) up to 0.91 of the larger apart; weight variance 0.15 of the cosine's;
 *     half precision: finite for cosines >= 2^-13. */
#ifndef WEFT_PATRY_H
#define WEFT_PATRY_H

#include "shading/warp.h"

#define PATRY_PARAMS(P)                                                                                      \
    P(float, roughness, 0.5f, 0.1f, 1.0f, 0.1f, 1.0f, "spread of the fibres' directions about the normal")   \
    P(float, density, 1.0f, 0.1f, 4.0f, 0.01f, 100.0f, "fibres met on the way down, in mean free paths")
#define PATRY_TRAITS TRAIT_CONSERVES

STRUCT(Patry){PATRY_PARAMS(FIELD)};

FN float patry_phase(Patry m, Dir o, Dir h) {
    float sigma = m.roughness * m.roughness, s2 = sigma * sigma;
    float q = s2 * (h.x * h.x + h.y * h.y) + h.z * h.z;
    return s2 * sigma / (4.0f * PI * q * q * sqrt(o.x * o.x + o.y * o.y + s2 * o.z * o.z));
}

FN float patry_eval(Patry m, Angles a) {
    float y = m.density * (1.0f / a.o.z + 1.0f / a.i.z);
    return patry_phase(m, a.o, a.h) * (1.0f - exp(-y)) / (a.o.z + a.i.z);
}

FN float patry_pdf(Patry m, Angles a) {
    return 0.5f * patry_phase(m, a.o, a.h) + 0.5f * warp_uniform_pdf(a.i);
}

FN Dir patry_sample(Patry m, Dir o, float u, float v) {
    Dir i = warp_uniform(2.0f * u - 1.0f, v);
    if (u < 0.5f) {
        float sigma = m.roughness * m.roughness;
        float l = 1.0f / sqrt(o.x * o.x + o.y * o.y + sigma * sigma * o.z * o.z);
        float z = 1.0f - 4.0f * u, r = sqrt(max(1.0f - z * z, 0.0f)), phi = 2.0f * PI * v;
        float x = o.x * l + r * cos(phi), y = o.y * l + r * sin(phi), t = sigma * (sigma * o.z * l + z);
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

#endif
