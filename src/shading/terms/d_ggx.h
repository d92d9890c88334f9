/* d_ggx - the microfacet distribution of rough dielectrics and metals, stretched along the tangent
 *
 *   D(h) = 1 / (pi ax ay (hx^2/ax^2 + hy^2/ay^2 + hz^2)^2),   integral of D cos_h = 1
 *
 *   Bruce Walter, Stephen R. Marschner, Hongsong Li, Kenneth E. Torrance, "Microfacet Models for Refraction
 * through Rough Surfaces", EGSR 2007, Equation 33; anisotropic: Brent Burley, "Physically Based Shading at
 * Disney", SIGGRAPH 2012 course, Equation 13. */
#pragma once

#include "shading/dialect/angles.h"

/* Returns D. Lobes built on it have alpha = roughness^2 (Burley 2012, Karis 2013). */
FN float ggx_d(float ax, float ay, Dir h) {
    float x = h.x / ax, y = h.y / ay, q = x * x + y * y + h.z * h.z;
    return 1.0f / (PI * ax * ay * q * q);
}

/* Returns |(ax wx, ay wy, wz)|, of which all of Smith's terms are made. */
FN float ggx_length(float ax, float ay, Dir w) { return sqrt(ax * ax * w.x * w.x + ay * ay * w.y * w.y + w.z * w.z); }

/* Returns h from D cos_h, visible from wo or not: the slopes of a disc, stretched (Walter et al., Equation 35). */
FN Dir ggx_facet(float ax, float ay, float u, float v) {
    float r = sqrt(u), phi = 2.0f * PI * v;
    float x = ax * r * cos(phi), y = ay * r * sin(phi), z2 = max(1.0f - u, 0.0f);
    float n = 1.0f / sqrt(max(x * x + y * y + z2, 1e-24f));
    return dir(x * n, y * n, sqrt(z2) * n);
}

/* Returns a normal visible from wo: a point of the spherical cap that sees it, stretched back. Jonathan Dupuy, Anis
 * Benyoub, "Sampling Visible GGX Normals with Spherical Caps", HPG 2023, Listing 3. */
FN Dir ggx_sample_h(float ax, float ay, Dir o, float u, float v) {
    float l = 1.0f / ggx_length(ax, ay, o);
    Dir s = dir(ax * o.x * l, ay * o.y * l, o.z * l);
    float phi = 2.0f * PI * u, z = (1.0f - v) * (1.0f + s.z) - s.z;
    float r = sqrt(clamp(1.0f - z * z, 0.0f, 1.0f));
    float x = ax * (r * cos(phi) + s.x), y = ay * (r * sin(phi) + s.y), h = max(z + s.z, 0.0f);
    float n = 1.0f / sqrt(max(x * x + y * y + h * h, 1e-24f));
    return dir(x * n, y * n, h * n);
}

/* A strip of such normals, and how dense they are against that. */
STRUCT(Strip) {
    Dir h;
    float density;
};

/* Works as ggx_sample_h, with u along the longer axis: the cap is cut across that axis, u selects the cut and
 * v the place on its arc, which is as long on a sphere wherever it is cut and on the cap between half as long
 * and all of it. So points that are even in u are even along a highlight that is drawn out. */
FN Strip ggx_strip_h(float ax, float ay, Dir o, float u, float v) {
    bool swapped = ay > ax;
    float a = swapped ? ay : ax, b = swapped ? ax : ay, l = 1.0f / ggx_length(ax, ay, o);
    Dir s = dir(a * (swapped ? o.y : o.x) * l, b * (swapped ? o.x : o.y) * l, o.z * l);
    float x = 2.0f * u - 1.0f, r = sqrt(max(1.0f - x * x, 1e-12f));
    float c = clamp(-s.z / r, -1.0f, 1.0f), y = abs(c);
    /* Milton Abramowitz, Irene A. Stegun, "Handbook of Mathematical Functions", 1964, 4.4.45 */
    float angle = sqrt(1.0f - y) * (1.5707288f + y * (-0.2121144f + y * (0.0742610f - 0.0187293f * y)));
    float half_arc = c < 0.0f ? PI - angle : angle, at = (2.0f * v - 1.0f) * half_arc;
    float hx = a * (x + s.x), hy = b * (r * sin(at) + s.y), hz = max(r * cos(at) + s.z, 0.0f);
    float n = 1.0f / sqrt(max(hx * hx + hy * hy + hz * hz, 1e-24f));
    Strip p;
    p.h = dir((swapped ? hy : hx) * n, (swapped ? hx : hy) * n, hz * n);
    p.density = PI * (1.0f + s.z) / (2.0f * half_arc);
    return p;
}

/* Returns the density of the wi that mirrors wo about such a normal: G1(wo) D(h) / (4 cos_o). */
FN float ggx_pdf_h(float ax, float ay, Angles a) {
    return ggx_d(ax, ay, a.h) / (2.0f * (a.o.z + ggx_length(ax, ay, a.o)));
}
