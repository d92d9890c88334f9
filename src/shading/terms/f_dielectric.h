/* f_dielectric - reflectance of glass, water, lacquer: slow to rise, then all at once
 *
 *   F = (rs^2 + rp^2) / 2,   rs = (c - g) / (c + g),   rp = (n^2 c - g) / (n^2 c + g)
 *   c = wi . h,   g = sqrt(n^2 - 1 + c^2), or 0 beyond the critical angle
 *   s = (F - F(0)) / (1 - F(0)),   F(0) = (n - 1)^2 / (n + 1)^2: the share of what is left above normal
 *
 *   Augustin Fresnel, "Memoire sur la loi des modifications que la reflexion imprime a la lumiere polarisee",
 * 1823. n = ior; below 1, light comes from within and is all reflected beyond the critical angle.
 *
 *   Departures: the colour f0 multiplies outside and replaces F(0), so ior only shapes the way from there.
 * Above n = 3.73 F dips below F(0) before it rises; s does not follow. And 1 - s is computed, which has no
 * cancellation; c is at least 1e-6, since at n = 1 it would be 0 / 0 on the horizon. */
#pragma once

#include "shading/dialect/lang.h"

FN float dielectric_s(float ior, float d) {
    float c = clamp(d, 1e-6f, 1.0f), n2 = ior * ior, g = sqrt(max((ior - 1.0f) * (ior + 1.0f) + c * c, 0.0f));
    float p = c + g, q = n2 * c + g, n1 = 1.0f + ior;
    float passed = 0.5f * n1 * n1 * c * g / ior * (1.0f / (p * p) + n2 / (q * q));
    return clamp(1.0f - passed, 0.0f, 1.0f);
}
