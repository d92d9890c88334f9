/* warp.h - maps from the unit square to directions, each beside its pdf (1/sr) */
#pragma once

#include "shading/dialect/angles.h"

/* Returns a direction of the hemisphere about +z, with a density proportional to the cosine. */
FN Dir warp_cosine(float u, float v) {
    float r = sqrt(u), phi = 2.0f * PI * v;
    return dir(r * cos(phi), r * sin(phi), sqrt(max(1.0f - u, 0.0f)));
}
FN float warp_cosine_pdf(Dir w) { return max(w.z, 0.0f) / PI; }

/* Returns a direction of the hemisphere about +z, with a constant density. */
FN Dir warp_uniform(float u, float v) {
    float r = sqrt(max(u * (2.0f - u), 0.0f)), phi = 2.0f * PI * v;
    return dir(r * cos(phi), r * sin(phi), 1.0f - u);
}
FN float warp_uniform_pdf(Dir w) { return w.z > 0.0f ? 0.5f / PI : 0.0f; }

/* Returns a direction with constant density with the probability `share`, otherwise one by the cosine. This bounds the
 * weight of a lobe whose f cos does not go to 0 at the horizon. */
FN Dir warp_uniform_cosine(float share, float u, float v) {
    Dir w = warp_cosine(max((u - share) / (1.0f - share), 0.0f), v);
    if (u < share) w = warp_uniform(u / share, v);
    return w;
}
FN float warp_uniform_cosine_pdf(float share, Dir w) {
    return (1.0f - share) * warp_cosine_pdf(w) + share * warp_uniform_pdf(w);
}
