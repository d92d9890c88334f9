/* texel.h - values of inputs from a texture's channels */
#pragma once

#include "shading/dialect/angles.h"

/* Returns a tangent-space normal from colours in 0 .. 1, its slopes multiplied by strength. A normal that points down,
 * as in a damaged map, is raised above the surface. */
FN Dir texel_normal(float r, float g, float b, float strength) {
    Dir n = dir((2.0f * r - 1.0f) * strength, (2.0f * g - 1.0f) * strength, max(2.0f * b - 1.0f, 1e-3f));
    float s = 1.0f / sqrt(dir_dot(n, n));
    return dir(n.x * s, n.y * s, n.z * s);
}

/* Returns a direction in the tangent plane, rotated by the angle whose cosine and sine are x and y; (x, y) itself if
 * the texel has no direction. */
FN Dir texel_direction(float r, float g, float x, float y) {
    float tx = 2.0f * r - 1.0f, ty = 2.0f * g - 1.0f, s = sqrt(tx * tx + ty * ty);
    if (s < 1e-3f) return dir(x, y, 0.0f);
    return dir((x * tx - y * ty) / s, (x * ty + y * tx) / s, 0.0f);
}
