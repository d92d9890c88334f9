/* azimuth.h - the angle of a direction about the normal, from the tangent
 *
 *   phi = atan2(y, x) in [0, 2 pi]
 *
 *   tan(a / 2) = y / (|w| + x), then tan(a / 2) = tan a / (1 + sqrt(1 + tan^2 a)) twice, leaves an eighth of
 * an angle of at most pi / 2; for that, five terms of the arctangent's series are within 2e-9. Shading text
 * has no atan of its own, since those of GPUs have a few correct digits only. */
#pragma once

#include "shading/dialect/angles.h"

FN float azimuth_half(float t) { return t / (1.0f + sqrt(1.0f + t * t)); }

/* Returns the azimuth of w in the tangent plane, radians; 0 if w has no tangential part. */
FN float azimuth_of(Dir w) {
    float r = sqrt(w.x * w.x + w.y * w.y);
    float t = azimuth_half(azimuth_half(abs(w.y) / max(r + abs(w.x), 1e-30f))), q = t * t;
    float phi = 8.0f * t * (1.0f - q * (1.0f / 3.0f - q * (1.0f / 5.0f - q * (1.0f / 7.0f - q * (1.0f / 9.0f)))));
    phi = w.x < 0.0f ? PI - phi : phi;
    phi = w.y < 0.0f ? 2.0f * PI - phi : phi;
    return r < 1e-15f ? 0.0f : phi;
}
