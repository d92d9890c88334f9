/* patry - fuzz that stands up: bright where a thin layer of fibres is seen, or lit, along the surface
 *
 *   f = color p(wo, wi) (1 - exp(-density (1/cos_o + 1/cos_i))) / (cos_o + cos_i)                [1/sr]
 *   p = D(h) / (4 s(wo)),   D(h) = sigma^3 / (pi (sigma^2 sin_h^2 + cos_h^2)^2)
 *   s(w) = sqrt(sin^2 + sigma^2 cos^2),   sigma = alpha^2
 *
 *   reciprocal: no, since p divides by s(wo) alone.
 */
#ifndef WEFT_PATRY_H
#define WEFT_PATRY_H

#include "shading/warp.h"

#define PATRY_PARAMS(P)                                                                                      \
    P(float, alpha, 0.5f, 0.1f, 1.0f, 0.1f, 1.0f, "spread of the fibres' directions about the normal")       \
    P(float, density, 1.0f, 0.1f, 4.0f, 0.01f, 100.0f, "fibres met on the way down, in mean free paths")
#define PATRY_TRAITS TRAIT_CONSERVES

STRUCT(Patry){PATRY_PARAMS(FIELD)};

FN float patry_phase(Patry m, Dir o, Dir h) {
    float sigma = m.alpha * m.alpha, s2 = sigma * sigma;
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
        float sigma = m.alpha * m.alpha, l = 1.0f / sqrt(o.x * o.x + o.y * o.y + sigma * sigma * o.z * o.z);
        float z = 1.0f - 4.0f * u, r = sqrt(max(1.0f - z * z, 0.0f)), phi = 2.0f * PI * v;
        float x = o.x * l + r * cos(phi), y = o.y * l + r * sin(phi), t = sigma * (sigma * o.z * l + z);
        float n = x * x + y * y + t * t;
        n = n > 1e-20f ? 1.0f / sqrt(n) : 0.0f;
        i = dir_mirror(o, n > 0.0f ? dir(x * n, y * n, t * n) : o);
    }
    return i;
}

#endif
