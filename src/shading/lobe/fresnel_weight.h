/* fresnel_weight.h - the Fresnel weight: the part of a lobe's f that its second colour scales */
#pragma once

#include "shading/terms/f_cook_torrance.h"
#include "shading/terms/f_schlick.h"

/* A reflectance whose curve from f0 to white depends on the colour (f_cook_torrance) has no share: s is -(wi . h) in
 * its place. A shader without such a lobe defines this as false. */
#ifndef FRESNEL_WEIGHT_IS_COSINE
#define FRESNEL_WEIGHT_IS_COSINE(s) ((s) < 0.0f)
#endif
FN float fresnel_weight_of_cosine(float cosine) { return -max(cosine, 1e-6f); }

/* Mixes two colours by the share of the second. If s contains a cosine, `second` is the weight of the first colour, so
 * that first / second is F0. */
FN float fresnel_weight_mix(float s, float first, float second) {
    if (FRESNEL_WEIGHT_IS_COSINE(s)) return second * cook_torrance_f(first / max(second, 1e-30f), -s);
    return mix(first, second, s);
}

/* Returns the share of the second colour for sums of light to which no colours are applied yet. */
FN float fresnel_weight_uncolored(float s) {
    if (FRESNEL_WEIGHT_IS_COSINE(s)) return schlick_s(-s);
    return s;
}
