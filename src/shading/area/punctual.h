/* punctual.h - falloff of punctual lights. Khronos Group, KHR_lights_punctual, 2018-2020 */
#pragma once

#include "shading/dialect/lang.h"

/* Returns the irradiance for an intensity of 1 at the squared distance d2; 0 beyond range. A range of 0 is
 * unlimited. */
FN float punctual_distance(float d2, float range) {
    float x = range > 0.0f ? d2 / (range * range) : 0.0f;
    return clamp(1.0f - x * x, 0.0f, 1.0f) / d2;
}

/* Returns the falloff of a spot light at the cosine c from its axis: 1 inside the inner cone, 0 outside
 * the outer. */
FN float punctual_cone(float c, float cos_inner, float cos_outer) {
    float t = clamp((c - cos_outer) / max(cos_inner - cos_outer, 1e-3f), 0.0f, 1.0f);
    return t * t;
}
