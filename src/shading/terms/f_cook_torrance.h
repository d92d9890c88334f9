/* f_cook_torrance - the exact reflectance of an interface whose index is that of its colour
 *
 *   F = 1/2 ((g - c) / (g + c))^2 (1 + ((c (g + c) - 1) / (c (g - c) + 1))^2)
 *   c = wi . h,   g = sqrt(n^2 - 1 + c^2),   n = (1 + sqrt(F0)) / (1 - sqrt(F0)), of each channel by itself
 *
 *   Robert L. Cook, Kenneth E. Torrance, "A Reflectance Model for Computer Graphics", ACM Transactions on
 * Graphics 1(1), 1982; Brian Karis, "Specular BRDF Reference", 2013, which has these three lines.
 *   F0 of a dielectric whose ior is given is made of that ior, which therefore is n. Metals
 * dip below F0 before they rise: .478 at F0 .638 and c .15. F is no mixture of F0 and white, so no share expresses
 * it (fresnel_weight.h). Safer beside it is f_dielectric: one n for all channels, and F never below F0.
 *   Departures: F0 is at most .9998, where n is 20000, and c at least 1e-6, since at n = 1
 * it would be 0 / 0 on the horizon. Light that is summed before the colour is applied - ambient light, the tables of
 * layer rules - takes f_schlick from F0 to white. */
#pragma once

#include "shading/dialect/lang.h"

FN float cook_torrance_f(float f_0, float d) {
    float root = sqrt(clamp(f_0, 0.0f, 0.9998f)), n = (1.0f + root) / (1.0f - root);
    float c = clamp(d, 1e-6f, 1.0f), g = sqrt(max((n - 1.0f) * (n + 1.0f) + c * c, 0.0f));
    float a = (g - c) / (g + c), b = (c * (g + c) - 1.0f) / (c * (g - c) + 1.0f);
    return 0.5f * a * a * (1.0f + b * b);
}
