/* occlusion_cone.h - the visible part of each direction, where only the number of the occlusion is given
 *
 * With x = cos^2, over which cosine-weighted directions are even, a ramp from b^2 to 2 b - b^2, b = 1 -
 * occlusion, has the mean `occlusion`: a cone about the normal with a soft rim. Jorge Jimenez et al.,
 * "Practical Real-Time Strategies for Accurate Indirect Occlusion", SIGGRAPH 2016 course, take a cone so. */
#pragma once

#include "shading/dialect/angles.h"

/* Returns the visible part, 0 to 1, of a direction with that cosine to the normal. */
FN float occlusion_cone(float occlusion, float cos_i) {
    float b = 1.0f - occlusion, x = max(cos_i, 0.0f) * max(cos_i, 0.0f);
    return occlusion >= 1.0f ? 1.0f : clamp((x - b * b) / max(2.0f * b * occlusion, 1e-4f), 0.0f, 1.0f);
}
