/* facet - half vectors: made from their tilt, mirrored into samples, and what density the samples have
 *
 *   pdf(wi) = D(h) cos_h / (4 wi . h)
 *
 *   Bruce Walter, Stephen R. Marschner, Hongsong Li, Kenneth E. Torrance, "Microfacet Models for Refraction
 * through Rough Surfaces", EGSR 2007, Equations 14 and 24. A facet that faces away from wo gives no sample; since
 * every D here is the same for (x, y, z) and (-x, -y, z), such a facet is rotated by half a circle about the normal,
 * where it is visible. */
#pragma once

#include "shading/dialect/warp.h"

/* Returns the half vector of that tilt; v in [0, 1) rotates it about the normal. */
FN Dir facet(float sin_h, float cos_h, float v) {
    float phi = 2.0f * PI * v;
    return dir(sin_h * cos(phi), sin_h * sin(phi), cos_h);
}

FN Dir facet_towards(Dir o, Dir h) {
    float sign = dir_dot(o, h) < 0.0f ? -1.0f : 1.0f;
    return dir(sign * h.x, sign * h.y, h.z);
}

/* Returns the density of the wi that mirrors wo about a normal of facet_towards, whose density is d_cos = D cos_h. a.d
 * is taken as at least 1e-6: below it both directions graze, and the density has no use but must be finite. */
FN float facet_pdf(float d_cos, Angles a) {
    bool twice = a.o.z * a.h.z < a.o.x * a.h.x + a.o.y * a.h.y; /* the direction on the other side is not visible */
    return d_cos * (twice ? 0.5f : 0.25f) / max(a.d, 1e-6f);
}

/* The next two functions keep their digits where 1 - s and exp(-y) are near 1: there the logarithm and the power of
 * a GPU have a small absolute error only. */

/* Evaluates -ln(1 - s) for s in [0, 1); c is 1 - s. Below 1/4 it uses 2 artanh(s / (2 - s)), whose series is within
 * 2e-8. */
FN float facet_fall(float s, float c) {
    float t = s / (2.0f - s), q = t * t;
    float series = 2.0f * t * (1.0f + q * (1.0f / 3.0f + q * (1.0f / 5.0f + q * (1.0f / 7.0f))));
    return s < 0.25f ? series : -0.693147181f * log2(c);
}

/* 1 - exp(-y) for y >= 0. Below 1/2 by the series of exp, which is within 3e-8. */
FN float facet_rise(float y) {
    float e = 1.0f - y / 4.0f * (1.0f - y / 5.0f * (1.0f - y / 6.0f * (1.0f - y / 7.0f * (1.0f - y / 8.0f))));
    float series = y * (1.0f - y / 2.0f * (1.0f - y / 3.0f * e));
    return y < 0.5f ? series : 1.0f - exp(-y);
}
