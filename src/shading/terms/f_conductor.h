/* f_conductor - reflectance of a metal: almost the same from everywhere, white only at the very edge
 *
 *   F = (Rs + Rp) / 2 of the index n + i k
 *   s = (F - F(0)) / (1 - F(0)),   F(0) = ((n - 1)^2 + k^2) / ((n + 1)^2 + k^2)
 *
 *   Max Born, Emil Wolf, "Principles of Optics", 1959, section 13.2 (14.2 in the seventh edition, 1999), with
 *   a + i b = sqrt((n + i k)^2 - sin^2),  m = a^2 + b^2,  c = wi . h:
 *   Rs = (m - 2 a c + c^2) / (m + 2 a c + c^2)
 *   Rp = Rs (c^2 m - 2 a c sin^2 + sin^4) / (c^2 m + 2 a c sin^2 + sin^4)
 *
 *   Departures: the colour f0 multiplies outside and replaces F(0), so n and k only shape the way from there.
 * Every metal dips below F(0) before it rises; s is 0 there. And 1 - F is computed, which is the small
 * quantity; c is at least 1e-6, as in f_dielectric. */
#pragma once

#include "shading/dialect/lang.h"

FN float conductor_s(float ior, float k, float d) {
    float c = clamp(d, 1e-6f, 1.0f), c2 = c * c, s2 = 1.0f - c2;
    float re = (ior - 1.0f) * (ior + 1.0f) + c2 - k * k, im = 2.0f * ior * k; /* of (a + i b)^2 */
    float m = sqrt(re * re + im * im), large = sqrt(0.5f * (m + abs(re)));
    float a = re < 0.0f ? 0.5f * im / max(large, 1e-12f) : large; /* the small root by the large one */
    float twice = 2.0f * a * c, s_pass = 2.0f * twice / (m + c2 + twice);
    float p_pass = 2.0f * twice * s2 / (c2 * m + s2 * s2 + twice * s2); /* 1 - Rp / Rs */
    float n1 = 1.0f + ior, passed = s_pass + 0.5f * (1.0f - s_pass) * p_pass;
    return clamp(1.0f - passed * (n1 * n1 + k * k) / (4.0f * ior), 0.0f, 1.0f);
}
