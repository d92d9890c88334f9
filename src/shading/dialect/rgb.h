/* rgb.h - colours: linear Rec. 709 */
#pragma once

#include "shading/dialect/angles.h"

FN Rgb rgb(float r, float g, float b) {
    Rgb c;
    c.r = r;
    c.g = g;
    c.b = b;
    return c;
}
FN Rgb rgb_grey(float x) { return rgb(x, x, x); }
FN Rgb rgb_scale(Rgb a, float k) { return rgb(a.r * k, a.g * k, a.b * k); }
FN Rgb rgb_add(Rgb a, Rgb b) { return rgb(a.r + b.r, a.g + b.g, a.b + b.b); }
FN Rgb rgb_mul(Rgb a, Rgb b) { return rgb(a.r * b.r, a.g * b.g, a.b * b.b); }
FN Rgb rgb_mix(Rgb a, Rgb b, float t) { return rgb(mix(a.r, b.r, t), mix(a.g, b.g, t), mix(a.b, b.b, t)); }
FN Rgb rgb_min(Rgb a, float top) { return rgb(min(a.r, top), min(a.g, top), min(a.b, top)); }
FN float rgb_max3(Rgb c) { return max(c.r, max(c.g, c.b)); }
FN float rgb_mean(Rgb c) { return (c.r + c.g + c.b) * (1.0f / 3.0f); }

/* Returns Y = 0.2126 R + 0.7152 G + 0.0722 B. International Telecommunication Union, Recommendation BT.709, item
 * 3.2. */
FN float rgb_luminance(Rgb c) { return 0.2126f * c.r + 0.7152f * c.g + 0.0722f * c.b; }
