/* d_beckmann - the highlight of a surface whose slopes are spread like a bell curve: a clean edge, no glow
 *
 *   D(h) = exp(-tan_h^2 / alpha^2) / (pi alpha^2 cos_h^4),   integral of D cos_h = 1
 *
 *   Petr Beckmann, Andre Spizzichino, "The Scattering of Electromagnetic Waves from Rough Surfaces", 1963;
 * with this norm: Bruce Walter et al., "Microfacet Models for Refraction through Rough Surfaces", EGSR 2007,
 * Equation 25.
 *   alpha: the root mean square slope times sqrt(2). alpha = roughness^2 (Karis 2013). */
#pragma once

#include "shading/terms/facet.h"

/* Returns D. The floor on cos_h^2 keeps its square a normal number: there D is at most 2e-14 instead of 0. */
FN float beckmann_d(float alpha, Dir h) {
    float a2 = alpha * alpha, cos2 = max(h.z * h.z, 1e-10f);
    return exp(-(h.x * h.x + h.y * h.y) / (a2 * cos2)) / (PI * a2 * cos2 * cos2);
}

/* Returns h from D cos_h: tan_h^2 = -alpha^2 ln u (the same work, Equation 28). */
FN Dir beckmann_facet(float alpha, float u, float v) {
    float tan_h = alpha * sqrt(max(-0.693147181f * log2(max(u, 1e-7f)), 0.0f));
    float cos_h = 1.0f / sqrt(1.0f + tan_h * tan_h);
    return facet(tan_h * cos_h, cos_h, v);
}
