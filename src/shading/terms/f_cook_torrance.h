/* f_cook_torrance - the exact reflectance of a dielectric, in the form that computer graphics met first
 *
 *   F = 1/2 ((g - c) / (g + c))^2 (1 + ((c (g + c) - 1) / (c (g - c) + 1))^2)
 *   c = wi . h,   g = sqrt(n^2 - 1 + c^2)
 *   s = (F - F(0)) / (1 - F(0)),   F(0) = (n - 1)^2 / (n + 1)^2
 *
 *   Robert L. Cook, Kenneth E. Torrance, "A Reflectance Model for Computer Graphics", ACM Transactions on
 * Graphics 1(1), 1982; Brian Karis, "Specular BRDF Reference", 2013. It is f_dielectric after some
 * algebra, and equals it to 1e-6.
 *
 *   Departures: both take n = (1 + sqrt(F0)) / (1 - sqrt(F0)) from the colour; here it is the parameter ior,
 * one for all channels, and s leaves the colour outside. Where g is not real it is 0: total reflection. Where
 * F dips below F(0), s is 0. c is at least 1e-6, since at n = 1 it would be 0 / 0 on the horizon. */
#ifndef WEFT_F_COOK_TORRANCE_H
#define WEFT_F_COOK_TORRANCE_H

#include "shading/lang.h"

FN float cook_torrance_s(float ior, float d) {
    float c = clamp(d, 1e-6f, 1.0f), g = sqrt(max((ior - 1.0f) * (ior + 1.0f) + c * c, 0.0f));
    float a = (g - c) / (g + c), b = (c * (g + c) - 1.0f) / (c * (g - c) + 1.0f);
    float f = 0.5f * a * a * (1.0f + b * b), r = (ior - 1.0f) / (ior + 1.0f), f_0 = r * r;
    return clamp((f - f_0) / (1.0f - f_0), 0.0f, 1.0f);
}

#endif
