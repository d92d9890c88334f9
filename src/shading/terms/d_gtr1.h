/* d_gtr1 - a sharp core in a wide, faint haze, as lacquer over a surface shows it
 *
 *   D(h) = (alpha^2 - 1) / (pi ln(alpha^2) (1 + (alpha^2 - 1) cos_h^2)),   integral of D cos_h = 1
 *
 *   Brent Burley, "Physically Based Shading at Disney", SIGGRAPH 2012 course "Practical Physically Based
 * Shading in Film and Game Production", appendix B: GTR with gamma = 1, meant for the clear coat.
 *   alpha: (0, 1]. alpha = roughness^2; the Disney coat has alpha from 0.1 to 0.001 instead. */
#pragma once

#include "shading/dialect/proxy.h"
#include "shading/terms/facet.h"

/* Returns alpha^2, clamped. At alpha = 1 the formula is 0 / 0, whose limit is 1 / pi. Just below, numerator and
 * logarithm share one rounded alpha^2 and their quotient is right: so alpha^2 is clamped there, 5e-7 from the limit. */
FN float gtr1_square(float alpha) { return min(alpha * alpha, 0.999999f); }

FN float gtr1_d(float alpha, Dir h) {
    float a2 = gtr1_square(alpha), q = h.x * h.x + h.y * h.y + a2 * h.z * h.z;
    return (1.0f - a2) / (facet_fall(1.0f - a2, a2) * PI * q);
}

/* Returns h from D cos_h: sin_h^2 = (alpha^(2u) - alpha^2) / (1 - alpha^2), here without its cancellations (the same
 * appendix, solved for the sine). */
FN Dir gtr1_facet(float alpha, float u, float v) {
    float a2 = gtr1_square(alpha), m = facet_fall(1.0f - a2, a2);
    float sin2 = exp(-u * m) * facet_rise((1.0f - u) * m) / facet_rise(m);
    return facet(sqrt(min(sin2, 1.0f)), sqrt(max(1.0f - sin2, 0.0f)), v);
}

/* Returns the proxy, as wide as sqrt(alpha), within which half of the haze lies. */
FN Proxy gtr1_proxy(float alpha) { return proxy_facets(sqrt(alpha), sqrt(alpha)); }
