/* d_charlie - density of fibre normals: they lie flat, so the density peaks at the horizon
 *
 *   D(h) = (2 + 1/alpha) sin(theta_h)^(1/alpha) / (2 pi),   integral of D cos_h = 1             Equation 2
 *
 *   Alejandro Conty Estevez, Christopher Kulla, "Production Friendly Microfacet Sheen BRDF", SIGGRAPH 2017
 * course "Physically Based Shading in Theory and Practice". */
#ifndef WEFT_D_CHARLIE_H
#define WEFT_D_CHARLIE_H

#include "shading/terms/facet.h"

/* sin^2 comes from the tangential part of h: 1 - cos^2 has no digits left where the lobe is small. The floor
 * keeps the argument of pow a normal number. */
FN float charlie_d_sin2(float alpha, float sin2) {
    return (2.0f + 1.0f / alpha) / (2.0f * PI) * pow(max(sin2, 1e-30f), 0.5f / alpha);
}

FN float charlie_d(float alpha, Dir h) { return charlie_d_sin2(alpha, h.x * h.x + h.y * h.y); }

/* h from D cos_h, at any azimuth: sin_h = u^(alpha / (2 alpha + 1)) inverts the integral. */
FN Dir charlie_facet(float alpha, float u, float v) {
    float sin_h = pow(max(u, 1e-7f), alpha / (2.0f * alpha + 1.0f));
    return facet(sin_h, sqrt(max(1.0f - sin_h * sin_h, 0.0f)), v);
}

/* For the lobes built on it: h from D cos_h, taken only from the half plane of azimuths that wo is in, where
 * wo . h > 0 without exception; so the density doubles there. */
FN Dir charlie_sample_h(float alpha, Dir o, float u, float v) {
    float sin_h = pow(max(u, 1e-7f), alpha / (2.0f * alpha + 1.0f));
    float cos_h = sqrt(max(1.0f - sin_h * sin_h, 0.0f));
    float s = sqrt(o.x * o.x + o.y * o.y);
    float tx = s > 1e-6f ? o.x / s : 1.0f, ty = s > 1e-6f ? o.y / s : 0.0f;
    float phi = PI * (v - 0.5f), c = sin_h * cos(phi), t = sin_h * sin(phi);
    return dir(c * tx - t * ty, c * ty + t * tx, cos_h);
}

/* Density of the wi that mirrors wo about such an h. */
FN float charlie_pdf_h(float alpha, Angles a) {
    float s = sqrt(a.o.x * a.o.x + a.o.y * a.o.y);
    float side = s > 1e-6f ? a.h.x * a.o.x + a.h.y * a.o.y : a.h.x;
    return side > 0.0f ? 2.0f * charlie_d_sin2(alpha, a.sin2_h) * a.h.z / (4.0f * max(a.d, 1e-6f)) : 0.0f;
}

/* The sampler of the lobes built on D: half of the samples by D, half uniform, which bounds the weight where
 * D finds nothing (wo near the normal, and light from behind). */
FN Dir charlie_sample(float alpha, Dir o, float u, float v) {
    Dir i = warp_uniform(2.0f * u - 1.0f, v);
    if (u < 0.5f) i = dir_mirror(o, charlie_sample_h(alpha, o, 2.0f * u, v));
    return i;
}

FN float charlie_pdf(float alpha, Angles a) {
    return 0.5f * charlie_pdf_h(alpha, a) + 0.5f * warp_uniform_pdf(a.i);
}

#endif
