/* d_blinn_phong - the highlight of early computer pictures: round, and gone soon after its edge
 *
 *   D(h) = cos_h^(2/alpha^2 - 2) / (pi alpha^2),   integral of D cos_h = 1
 *
 *   James F. Blinn, "Models of Light Reflection for Computer Synthesized Pictures", SIGGRAPH 1977: the power
 * of cos_h. Brian Karis, "Specular BRDF Reference", 2013: the exponent and the norm, by which a small alpha
 * is as wide as the same alpha of d_beckmann.
 *   alpha: (0, 1]; at 1 D is constant. alpha = roughness^2 (Karis). */
#pragma once

#include "shading/terms/facet.h"

/* Returns D. The exponent reaches 80000, for which the square of a cosine near 1 has too few digits: it is computed
 * from the tangential part of h. */
FN float blinn_phong_d(float alpha, Dir h) {
    float a2 = alpha * alpha, sin2 = h.x * h.x + h.y * h.y;
    return exp((1.0f - 1.0f / a2) * facet_fall(sin2, max(h.z * h.z, 1e-30f))) / (PI * a2);
}

/* Returns h from D cos_h: cos_h^2 = u^(alpha^2). */
FN Dir blinn_phong_facet(float alpha, float u, float v) {
    float sin2 = facet_rise(-0.693147181f * alpha * alpha * log2(max(u, 1e-7f)));
    return facet(sqrt(sin2), sqrt(max(1.0f - sin2, 0.0f)), v);
}
