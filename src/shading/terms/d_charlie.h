/* d_charlie - density of fibre normals: they lie flat, so the density peaks at the horizon
 *
 *   D(h) = (2 + 1/alpha) sin(theta_h)^(1/alpha) / (2 pi),   integral of D cos_h = 1             Equation 2
 *
 *   Alejandro Conty Estevez, Christopher Kulla, "Production Friendly Microfacet Sheen BRDF", SIGGRAPH 2017
 * course "Physically Based Shading in Theory and Practice". */
#pragma once

#include "shading/terms/facet.h"

/* D = scale (sin^2)^power, and sin_h = u^draw. */
STRUCT(Charlie) { float scale, power, draw; };

FN Charlie charlie_of(float alpha) {
    Charlie c;
    c.scale = (2.0f + 1.0f / alpha) / (2.0f * PI);
    c.power = 0.5f / alpha;
    c.draw = alpha / (2.0f * alpha + 1.0f);
    return c;
}

/* Returns D for sin2 = sin_h^2, which is computed from the tangential part of h: 1 - cos^2 has no digits left where the
 * lobe is small. The floor keeps the argument of pow a normal number. */
FN float charlie_d_sin2(Charlie c, float sin2) { return c.scale * pow(max(sin2, 1e-30f), c.power); }

FN float charlie_d(float alpha, Dir h) { return charlie_d_sin2(charlie_of(alpha), h.x * h.x + h.y * h.y); }

/* Returns h from D cos_h, at any azimuth: sin_h = u^(alpha / (2 alpha + 1)) inverts the integral. */
FN Dir charlie_facet(float alpha, float u, float v) {
    float sin_h = pow(max(u, 1e-7f), alpha / (2.0f * alpha + 1.0f));
    return facet(sin_h, sqrt(max(1.0f - sin_h * sin_h, 0.0f)), v);
}

/* The direction of wo in the tangent plane. */
STRUCT(CharlieSide) { float x, y; };

FN CharlieSide charlie_side(Dir o) {
    float s = sqrt(o.x * o.x + o.y * o.y);
    CharlieSide side;
    side.x = s > 1e-6f ? o.x / s : 1.0f;
    side.y = s > 1e-6f ? o.y / s : 0.0f;
    return side;
}

/* Returns h from D cos_h for the lobes built on it, only from the half plane of azimuths of wo, where wo . h > 0 always
 * holds; so the density doubles there. */
FN Dir charlie_sample_h(Charlie c, CharlieSide side, float u, float v) {
    float sin_h = pow(max(u, 1e-7f), c.draw), cos_h = sqrt(max(1.0f - sin_h * sin_h, 0.0f));
    float phi = PI * (v - 0.5f), x = sin_h * cos(phi), y = sin_h * sin(phi);
    return dir(x * side.x - y * side.y, x * side.y + y * side.x, cos_h);
}

/* Returns a sample of the lobes built on D: half of the samples by D, half uniform, which bounds the weight where D is
 * small (wo near the normal, light from behind). */
FN Dir charlie_sample(Charlie c, CharlieSide side, Dir o, float u, float v) {
    Dir i = warp_uniform(2.0f * u - 1.0f, v);
    if (u < 0.5f) i = dir_mirror(o, charlie_sample_h(c, side, 2.0f * u, v));
    return i;
}

/* Returns the density of charlie_sample. d: D of the half vector. */
FN float charlie_pdf(float d, CharlieSide side, Angles a) {
    bool seen = a.h.x * side.x + a.h.y * side.y > 0.0f;
    float by_d = seen ? 2.0f * d * a.h.z / (4.0f * max(a.d, 1e-6f)) : 0.0f;
    return 0.5f * by_d + 0.5f * warp_uniform_pdf(a.i);
}
