/* fibre_medium.h - the medium of fuzz: the phase function of its flakes, and single scattering in a slab of it
 *
 *   S = 1 - (1 - s^2) t t^T,   nu = w . t,   c = h . t,   h along wi + wo
 *   sigma(w)  = sqrt(w . S w) = sqrt(1 - nu^2 + s^2 nu^2)
 *   D(h)      = 1 / (pi s (h . S^-1 h)^2) = s^3 / (pi (s^2 + (1 - s^2) c^2)^2)
 *   p(wi, wo) = D(h) / (4 sigma(wi))                                                            [1/sr]
 *   f1        = D / 4 (1 - exp(-H L / (mu_i mu_o))) / L,   L = sigma_i mu_o + sigma_o mu_i      [1/sr]
 *
 *   Eric Heitz, Jonathan Dupuy, Cyril Crassin, Carsten Dachsbacher, "The SGGX Microflake Distribution", ACM
 * TOG 34(4), 2015: sigma, D, visible normals and p are in sections 1.3 to 1.5 and 2.4 of its supplement.
 *   Tizian Zeltner, Brent Burley, Matt Jen-Yuan Chiang, "Practical Multiple-Scattering Sheen Using Linearly
 * Transformed Cosines", SIGGRAPH Talks 2022: the slab, and alpha with s = alpha^2.
 *
 * t is the axis of the fibres, and s what a fibre shows along t in parts of what it shows across: 1 is dust,
 * 0 would be threads without ends. sigma is the extinction per unit of density; wi points back to where light
 * comes from. H is density times thickness, mu the cosine to the slab's normal, which is nu where fibres
 * stand upright. Flakes are white: their albedo multiplies f1 outside. Finite for s from 1e-4, mu from
 * 1e-30 and H up to 8. */
#pragma once

#include "shading/dialect/angles.h"

/* Returns the axis of fibres that lean by `tilt` towards `azimuth`, from x to y. Radians. */
FN Dir flake_axis(float tilt, float azimuth) {
    return dir(sin(tilt) * cos(azimuth), sin(tilt) * sin(azimuth), cos(tilt));
}

FN float flake_sigma(float s, float nu) { return sqrt(max((1.0f - nu) * (1.0f + nu), 0.0f) + s * s * nu * nu); }

/* Returns D from q = |wi + wo|^2 and m = nu_i + nu_o, since c^2 = m^2 / q: no half vector is normalised. D is between
 * s^3 / pi and 1 / (pi s). For opposite directions, where q is 0, it depends on how the limit is taken. */
FN float flake_d(float s, float q, float m) {
    float r = s / (s * s + (1.0f - s * s) * min(m * m / max(q, 1e-30f), 1.0f));
    return s / PI * r * r;
}

/* Evaluates (1 - exp(-x)) / L for x = H L / (mu_i mu_o), by its series where the difference would cancel. */
FN float flake_visibility(float thickness, float lambda, float mu_mu) {
    float depth = thickness / max(mu_mu, 1e-37f), x = depth * lambda, y = min(x, 0.5f);
    float series = 1.0f - y / 6.0f * (1.0f - y / 7.0f * (1.0f - y / 8.0f));
    series = 1.0f - y / 2.0f * (1.0f - y / 3.0f * (1.0f - y / 4.0f * (1.0f - y / 5.0f * series)));
    return x < 0.5f ? depth * series : (1.0f - exp(-x)) / lambda;
}

/* Returns f1 of white flakes, their single scattering. */
FN float flake_single_of(float s, Dir t, float thickness, float sigma_o, float sigma_i, Dir o, Dir i) {
    float lambda = sigma_i * o.z + sigma_o * i.z;
    Dir sum = dir(o.x + i.x, o.y + i.y, o.z + i.z);
    /* nu_o + nu_i by the sum of the directions, which is exact where they are nearly opposite */
    return 0.25f * flake_d(s, dir_dot(sum, sum), dir_dot(sum, t)) * flake_visibility(thickness, lambda, o.z * i.z);
}

FN float flake_single(float s, Dir t, float thickness, Dir o, Dir i) {
    return flake_single_of(s, t, thickness, flake_sigma(s, dir_dot(o, t)), flake_sigma(s, dir_dot(i, t)), o, i);
}

/* Constants of f1 for upright fibres, with e = log2(exp(1)) thickness: the parts of e sigma, and the weights
 * of q and m^2 in the root of D / (4 e). */
STRUCT(FlakeUpright) { float e2, rest, across, along; };

/* Precomputes the factors of flake_single_upright. s is at least 0.03: thinner flakes need the series above. */
FN FlakeUpright flake_upright(float s, float thickness) {
    FlakeUpright r;
    float e = 1.44269504f * thickness, root = sqrt(4.0f * PI / (s * s * s * e));
    r.e2 = e * e;
    r.rest = (1.0f - s * s) * r.e2;
    r.across = s * s * root;
    r.along = (1.0f - s * s) * root;
    return r;
}

/* Returns f1 of upright flakes over the scale of flake_upright, with few instructions. */
FN float flake_single_upright(FlakeUpright r, Dir o, Dir i) {
    float both = o.z * i.z, m = o.z + i.z, mm = m * m, x = o.x + i.x, y = o.y + i.y;
    float q = max(x * x + (y * y + mm), 1e-30f);
    float ratio = q / (r.across * q + r.along * mm);
    float lambda = sqrt(r.e2 - r.rest * (i.z * i.z)) * o.z + sqrt(r.e2 - r.rest * (o.z * o.z)) * i.z;
    float inverse = 1.0f / lambda;
    float seen = inverse - inverse * exp2(-lambda / max(both, 1e-37f));
    return ratio * ratio * seen;
}

/* Evaluates S^(1/2) w, whose length is sigma. */
FN Dir flake_stretch(float s, Dir t, Dir w) {
    float k = (1.0f - s) * dir_dot(w, t);
    return dir(w.x - k * t.x, w.y - k * t.y, w.z - k * t.z);
}

/* Returns the direction in which a flake scatters the light from wi, distributed as p, for a point of the unit sphere.
 * The visible normals of an ellipsoid are S^(1/2) u, u distributed by the cosine about S^(1/2) wi. A point of the
 * sphere that stands on the tip of that axis is such a u, but for its length. */
FN Dir flake_scatter(float s, Dir t, Dir i, Dir point) {
    Dir v = flake_stretch(s, t, i);
    float r = 1.0f / sqrt(max(dir_dot(v, v), 1e-30f));
    Dir h = flake_stretch(s, t, dir(v.x * r + point.x, v.y * r + point.y, v.z * r + point.z));
    float k = 2.0f * dir_dot(i, h) / max(dir_dot(h, h), 1e-30f);
    return dir(k * h.x - i.x, k * h.y - i.y, k * h.z - i.z);
}
