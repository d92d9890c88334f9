/* weave_light.h - light at a point of a woven cloth, as lobe yarn reflects it there */
#pragma once

#include "shading/dialect/azimuth.h"
#include "shading/dialect/rgb.h"
#include "shading/lobes/woven.h"
#include "shading/lobes/yarn.h"
#include "shading/weave/weave_point.h"

/* Returns lobe yarn at a point. */
FN Yarn weave_yarn(const Weave *m, WeavePoint p) {
    Yarn y;
    y.alpha = p.weft ? m->weft.alpha : m->warp.alpha;
    y.slope_x = p.slope_x;
    y.slope_y = p.slope_y;
    y.azimuth = azimuth_of(p.fibre);
    y.roundness = p.weft ? m->weft_far.slope_across : m->warp_far.slope_across;
    y.crimp = m->warp_far.slope_along;
    y.cross_crimp = m->weft_far.slope_along;
    y.share = m->warp_far.share / max(m->warp_far.share + m->weft_far.share, 1e-6f);
    return y;
}

/* Returns lobe woven of one system, by its parameters alone. */
FN Woven weave_woven(const Weave *m, bool weft) {
    float all = max(m->warp_far.share + m->weft_far.share, 1e-6f), warp = m->warp_far.share / all;
    float crimp = weft ? m->weft_far.crimp : m->warp_far.crimp;
    float cross = weft ? m->warp_far.slope_along : m->weft_far.slope_along;
    Woven w;
    w.alpha = weft ? m->weft_far.alpha : m->warp_far.alpha;
    w.share = clamp(weft ? 1.0f - warp : warp, 1e-3f, 1.0f);
    w.crimp = azimuth_of(dir(1.0f, crimp, 0.0f));
    w.azimuth = weft ? 0.0f : 0.5f * PI;
    w.twist = weft ? m->weft.twist : m->warp.twist;
    w.roundness = weft ? m->weft_far.roundness : m->warp_far.roundness;
    w.floats = weft ? m->weft_far.floats : m->warp_far.floats;
    w.cross_crimp = azimuth_of(dir(1.0f, cross, 0.0f));
    return w;
}

/* Returns what the fibres at a point reflect in one channel of light that met one of them (single) or several
 * (multiple), times the light that reaches the point. */
FN float weave_single(const Weave *m, WeavePoint p, int channel) {
    float white = p.weft ? m->weft.white : m->warp.white;
    return min(weave_albedo(m, p, channel) + white, 1.0f) * weave_open(m, p);
}
FN float weave_multiple(const Weave *m, WeavePoint p, int channel) {
    return yarn_reflectance(weave_albedo(m, p, channel)) * weave_open(m, p);
}

/* Returns colour c with the part `worn` of it replaced by a white. */
FN Rgb weave_worn(Rgb c, float white, float worn) { return rgb_mix(c, rgb_grey(white), worn); }

/* Return what undyed fibres inside a yarn reflect of light that met one of them, and of all other light. */
FN float weave_core_single(WeaveYarn y) { return min(y.core + y.white, 1.0f); }
FN float weave_core_multiple(WeaveYarn y) { return yarn_reflectance(y.core); }

/* Returns the same in all channels; black where there is no thread. */
FN Rgb weave_single_rgb(const Weave *m, WeavePoint p) {
    float there = p.height > WEAVE_NONE ? 1.0f : 0.0f;
    return rgb_scale(rgb(weave_single(m, p, 0), weave_single(m, p, 1), weave_single(m, p, 2)), there);
}
FN Rgb weave_multiple_rgb(const Weave *m, WeavePoint p) {
    float there = p.height > WEAVE_NONE ? 1.0f : 0.0f;
    return rgb_scale(rgb(weave_multiple(m, p, 0), weave_multiple(m, p, 1), weave_multiple(m, p, 2)), there);
}
