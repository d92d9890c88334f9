/* v_smith_beckmann - shadowing of d_beckmann: nothing until light grazes about as steeply as the slopes
 *
 *   V = G1(wo) G1(wi) / (4 cos_o cos_i)
 *   G1(w) = (3.535 c + 2.181 c^2) / (1 + 2.276 c + 2.577 c^2) for c < 1.6, else 1,   c = 1 / (alpha tan_w)
 *
 *   Bruce G. Smith, "Geometrical Shadowing of a Random Rough Surface", 1967; the rational fit: Bruce Walter
 * et al., "Microfacet Models for Refraction through Rough Surfaces", EGSR 2007, Equation 27. Just below c =
 * 1.6 the fit is 1 + 6e-5.
 *   G1 / cos is computed as one, so that nothing vanishes at the horizon; the floors guard the branch that is
 * not taken. */
#pragma once

#include "shading/dialect/angles.h"

/* Returns G1(w) / cos_w. */
FN float smith_beckmann_part(float alpha, Dir w) {
    float slope = alpha * sqrt(max(w.x * w.x + w.y * w.y, 1e-12f)), c = w.z / slope;
    float fit = (3.535f + 2.181f * c) / ((1.0f + 2.276f * c + 2.577f * c * c) * slope);
    return c < 1.6f ? fit : 1.0f / max(w.z, 1e-12f);
}

FN float smith_beckmann_v(float alpha, Dir o, Dir i) {
    return 0.25f * smith_beckmann_part(alpha, o) * smith_beckmann_part(alpha, i);
}
