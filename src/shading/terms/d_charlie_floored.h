/* d_charlie_floored - d_charlie that never goes quite dark: half floats need a number to raise to a power
 *
 *   D(h) = (2 + 1/alpha) max(sin_h^2, q)^(1 / (2 alpha)) / (2 pi gain),  q = 1/128,  integral of D cos_h = 1
 *   gain = 1 + q^(1 + 1/(2 alpha)) / (2 alpha)
 *
 *   D_Charlie of google/filament, shaders/src/surface_brdf.fs, from which mrdoob/three.js has it.
 *   Departure: the engines leave the gain out, which is at most 1.00035, at alpha 1; their profiles
 * multiply by it.
 *   Without the limit: Alejandro Conty Estevez, Christopher Kulla, "Production Friendly Microfacet Sheen
 * BRDF", SIGGRAPH 2017 course. */
#pragma once

#include "shading/terms/d_charlie.h"

#define CHARLIE_FLOORED_SIN2 0.0078125f

FN float charlie_floored_gain(float alpha) {
    return 1.0f + 0.5f / alpha * pow(CHARLIE_FLOORED_SIN2, 1.0f + 0.5f / alpha);
}

FN float charlie_floored_d(float alpha, Dir h) {
    float sin2 = max(h.x * h.x + h.y * h.y, CHARLIE_FLOORED_SIN2);
    return (2.0f + 1.0f / alpha) * pow(sin2, 0.5f / alpha) / (2.0f * PI * charlie_floored_gain(alpha));
}

/* Returns h from D cos_h: sin_h^2 is uniform in the cap below the floor, and as in charlie_facet beyond it. */
FN Dir charlie_floored_facet(float alpha, float u, float v) {
    float power = 1.0f + 0.5f / alpha, bare = pow(CHARLIE_FLOORED_SIN2, power);
    float cap = power * bare / charlie_floored_gain(alpha);
    float w = max(bare + (1.0f - bare) * (u - cap) / (1.0f - cap), 1e-30f);
    float sin2 = u < cap ? CHARLIE_FLOORED_SIN2 * u / max(cap, 1e-30f) : min(pow(w, 1.0f / power), 1.0f);
    return facet(sqrt(sin2), sqrt(1.0f - sin2), v);
}
