/* ggx_widen.h - ggx over slopes that a pixel does not resolve (shading/material/widen.h) */
#pragma once

#include "shading/lobes/ggx.h"

FN float widened(float alpha, float more) { return min(sqrt(alpha * alpha + max(more, 0.0f)), 1.0f); }

/* Widens a lobe ggx; others stay. It cannot be longer along y than along x, where it becomes round. */
FN Lobe ggx_widen(Lobe lobe, float xx, float yy) {
    Lobe m = lobe;
    if (m.id != LOBE_GGX) return m;
    float stretch = m.params[GGX_ANISOTROPY], alpha = m.params[GGX_ALPHA];
    float ax = widened(mix(alpha, 1.0f, stretch * stretch), xx), ay = widened(alpha, yy);
    if (ax < ay) {
        ax = sqrt(ax * ay);
        ay = ax;
    }
    m.params[GGX_ALPHA] = ay;
    m.params[GGX_ANISOTROPY] = sqrt((ax - ay) / max(1.0f - ay, 1e-6f));
    return m;
}
