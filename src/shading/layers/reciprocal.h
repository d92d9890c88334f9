/* reciprocal - light passes the sheen on its way in and on its way out, and a white base loses nothing
 *
 *   f = sheen + (1 - c E(wo)) (1 - c E(wi)) / (1 - c Eavg) base,  Eavg = 2 integral of E(mu) mu dmu
 *
 *   Csaba Kelemen, Laszlo Szirmay-Kalos, "A Microfacet Based Coupled Specular-Matte BRDF Model with
 * Importance Sampling", Eurographics 2001 short presentations, Section 2.2.
 *   energy: exactly 1 over a white Lambert base, for a sheen that keeps E <= 1 and c Eavg <= 0.99. Over a
 * dark one it leaves on average what albedo-view does; with true bounces (stochastic) it would be less.
 *   reciprocal: yes. */
#pragma once

#include "shading/dialect/lang.h"

/* Returns the factor on the base. Each factor is clamped, because the product of two negative ones is positive. The
 * denominator is at least 1/100, which only a sheen with c Eavg > 0.99 reaches. */
FN float reciprocal_base(float c, float e_o, float e_i, float e_avg) {
    return max(1.0f - c * e_o, 0.0f) * max(1.0f - c * e_i, 0.0f) / max(1.0f - c * e_avg, 0.01f);
}
