/* weave_light.h - light at a point of a woven cloth, as lobe yarn reflects it there */
#ifndef WEFT_SHADING_WEAVE_LIGHT_H
#define WEFT_SHADING_WEAVE_LIGHT_H

#include "shading/azimuth.h"
#include "shading/lobes/yarn.h"
#include "shading/weave_point.h"

/* Lobe yarn at the point. */
FN Yarn weave_yarn(const Weave *m, WeavePoint p) {
    float k_warp = sqrt(max(m->warp_run, 1.0f)), k_weft = sqrt(max(m->weft_run, 1.0f));
    Yarn y;
    y.alpha = p.weft ? m->weft.alpha : m->warp.alpha;
    y.slope_x = p.slope_x;
    y.slope_y = p.slope_y;
    y.azimuth = azimuth_of(p.fibre);
    y.roundness = p.weft ? m->weft.roundness : m->warp.roundness;
    y.crimp = m->warp.crimp / k_warp;
    y.cross_crimp = m->weft.crimp / k_weft;
    y.share = m->warp_share / max(m->warp_share + m->weft_share, 1e-6f);
    return y;
}

/* The colours of that lobe in one channel: of light that met one fibre, and of all other. */
FN float weave_once(const Weave *m, WeavePoint p, int channel) {
    float white = p.weft ? m->weft.white : m->warp.white;
    return min(weave_albedo(m, p, channel) + white, 1.0f) * weave_open(m, p);
}
FN float weave_reflectance(const Weave *m, WeavePoint p, int channel) {
    return yarn_reflectance(weave_albedo(m, p, channel)) * weave_open(m, p);
}

#endif
