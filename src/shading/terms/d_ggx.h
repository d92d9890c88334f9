/* d_ggx - the microfacet distribution of rough dielectrics and metals, stretched along the tangent
 *
 *   D(h) = 1 / (pi ax ay (hx^2/ax^2 + hy^2/ay^2 + hz^2)^2),   integral of D cos_h = 1
 *
 *   Bruce Walter, Stephen R. Marschner, Hongsong Li, Kenneth E. Torrance, "Microfacet Models for Refraction
 * through Rough Surfaces", EGSR 2007, Equation 33; anisotropic: Brent Burley, "Physically Based Shading at
 * Disney", SIGGRAPH 2012 course, Equation 13. */
#ifndef WEFT_D_GGX_H
#define WEFT_D_GGX_H

#include "shading/angles.h"

/* alpha = roughness^2 in what is built on it (Burley 2012, Karis 2013). */
FN float ggx_d(float ax, float ay, Dir h) {
    float x = h.x / ax, y = h.y / ay, q = x * x + y * y + h.z * h.z;
    return 1.0f / (PI * ax * ay * q * q);
}

/* |(ax wx, ay wy, wz)|, from which all of Smith's terms are made. */
FN float ggx_length(float ax, float ay, Dir w) {
    return sqrt(ax * ax * w.x * w.x + ay * ay * w.y * w.y + w.z * w.z);
}

/* h from D cos_h, whether wo sees it or not: the slopes of a disc, stretched (Walter et al., Equation 35). */
FN Dir ggx_facet(float ax, float ay, float u, float v) {
    float r = sqrt(u), phi = 2.0f * PI * v;
    float x = ax * r * cos(phi), y = ay * r * sin(phi), z2 = max(1.0f - u, 0.0f);
    float n = 1.0f / sqrt(max(x * x + y * y + z2, 1e-24f));
    return dir(x * n, y * n, sqrt(z2) * n);
}

/* A normal visible from wo: a point of the spherical cap that sees it, stretched back.
 * Jonathan Dupuy, Anis Benyoub, "Sampling Visible GGX Normals with Spherical Caps", HPG 2023, Listing 3. */
FN Dir ggx_sample_h(float ax, float ay, Dir o, float u, float v) {
    float l = 1.0f / ggx_length(ax, ay, o);
    Dir s = dir(ax * o.x * l, ay * o.y * l, o.z * l);
    float phi = 2.0f * PI * u, z = (1.0f - v) * (1.0f + s.z) - s.z;
    float r = sqrt(clamp(1.0f - z * z, 0.0f, 1.0f));
    float x = ax * (r * cos(phi) + s.x), y = ay * (r * sin(phi) + s.y), h = max(z + s.z, 0.0f);
    float n = 1.0f / sqrt(max(x * x + y * y + h * h, 1e-24f));
    return dir(x * n, y * n, h * n);
}

/* Density of the wi that mirrors wo about such a normal: G1(wo) D(h) / (4 cos_o). */
FN float ggx_pdf_h(float ax, float ay, Angles a) {
    return ggx_d(ax, ay, a.h) / (2.0f * (a.o.z + ggx_length(ax, ay, a.o)));
}

#endif
