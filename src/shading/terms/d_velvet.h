/* d_velvet - fibres that all stand up: black from above, a thin bright rim at the silhouette
 *
 *   D(h) = exp(-cot_h^2 / alpha^2) / (pi alpha^2 sin_h^4),   integral of D cos_h = 1
 *
 *   Michael Ashikhmin, Simon Premoze, Peter Shirley, "A Microfacet-based BRDF Generator", SIGGRAPH 2000: a
 * bell curve about the horizon. As an upside-down d_beckmann, with its
 * norm, it is the distribution of the velvet that Blender Cycles has: alpha is what it calls sigma, not
 * squared. */
#pragma once

#include "shading/terms/facet.h"

/* Returns D. sin_h^2 has a floor, at which D is 0 to within 2e-14. */
FN float velvet_d(float alpha, Dir h) {
    float a2 = alpha * alpha, sin2 = max(h.x * h.x + h.y * h.y, 1e-10f);
    return exp(-h.z * h.z / (a2 * sin2)) / (PI * a2 * sin2 * sin2);
}

/* Returns h from D cos_h: cot_h^2 = -alpha^2 ln u. */
FN Dir velvet_facet(float alpha, float u, float v) {
    float cot_h = alpha * sqrt(max(-0.693147181f * log2(max(u, 1e-7f)), 0.0f));
    float sin_h = 1.0f / sqrt(1.0f + cot_h * cot_h);
    return facet(sin_h, cot_h * sin_h, v);
}
