/* d_ashikhmin - velvet with fibres in disorder: an even floor of light below the bright rim
 *
 *   D(h) = (1 + 4 exp(-cot_h^2 / alpha^2) / sin_h^4) / (pi (1 + 4 alpha^2)),   integral of D cos_h = 1
 *
 *   Michael Ashikhmin, Simon Premoze, "Distribution-based BRDFs", 2007: the rim four times as high as the
 * floor. The norm: David Neubelt, Matt Pettineo, "Crafting a Next-Gen Material Pipeline for The Order: 1886",
 * SIGGRAPH 2013 course "Physically Based Shading in Theory and Practice".
 *   alpha: alpha = roughness^2 (Neubelt, Pettineo; Filament). */
#pragma once

#include "shading/terms/d_velvet.h"

/* Returns the probability of d_velvet; otherwise D = 1 / pi. */
FN float ashikhmin_rim(float alpha) { return 4.0f * alpha * alpha / (1.0f + 4.0f * alpha * alpha); }

FN float ashikhmin_d(float alpha, Dir h) { return mix(1.0f / PI, velvet_d(alpha, h), ashikhmin_rim(alpha)); }

FN Dir ashikhmin_facet(float alpha, float u, float v) {
    float rim = ashikhmin_rim(alpha);
    if (u < rim) return velvet_facet(alpha, u / rim, v);
    return warp_cosine((u - rim) / (1.0f - rim), v);
}
