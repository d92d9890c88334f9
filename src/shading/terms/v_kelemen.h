/* v_kelemen - v_cook_torrance reduced to one division, and brighter towards grazing; the same for every
 * roughness
 *
 *   V = 1 / (4 d^2),  d = wi . h
 *
 *   Csaba Kelemen, Laszlo Szirmay-Kalos, "A Microfacet Based Coupled Specular-Matte BRDF Model with
 * Importance Sampling", Eurographics 2001 short presentations. The floor 1e-12 is reached where both cosines
 * are below 1e-6 and face each other; it keeps V finite. */
#pragma once

#include "shading/dialect/lang.h"

FN float kelemen_v(float d) { return 0.25f / max(d * d, 1e-12f); }
