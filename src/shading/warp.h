/* warp.h - maps from the unit square to directions, each beside its pdf (1/sr) */
#ifndef WEFT_WARP_H
#define WEFT_WARP_H

#include "shading/angles.h"

/* Hemisphere about +z, density proportional to the cosine. */
FN Dir warp_cosine(float u, float v) {
    float r = sqrt(u), phi = 2.0f * PI * v;
    return dir(r * cos(phi), r * sin(phi), sqrt(max(1.0f - u, 0.0f)));
}
FN float warp_cosine_pdf(Dir w) { return max(w.z, 0.0f) / PI; }

/* Hemisphere about +z, constant density. */
FN Dir warp_uniform(float u, float v) {
    float r = sqrt(max(u * (2.0f - u), 0.0f)), phi = 2.0f * PI * v;
    return dir(r * cos(phi), r * sin(phi), 1.0f - u);
}
FN float warp_uniform_pdf(Dir w) { return w.z > 0.0f ? 0.5f / PI : 0.0f; }

#endif
