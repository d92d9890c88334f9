/* sheet_scale.h - the scale of the differences on a sheet */
#pragma once

#include <math.h>

/* Returns the next of 1, 2, 5, 10, ... from value up, and not below that from `least`. */
static inline float sheet_scale(float value, float least) {
    const float decade = powf(10.0f, floorf(log10f(fmaxf(value, least)))), steps[] = {1.0f, 2.0f, 5.0f};
    for (int k = 0; k < 3; k++)
        if (value <= steps[k] * decade * 1.0001f) return steps[k] * decade;
    return 10.0f * decade;
}
