/* weave_base.h - a woven cloth at a place, as the base of a stack: near by a point of a thread, from afar the mean of
 * the threads of one system
 *
 *   base = (1 - w) yarn + w (warp + weft),  w = smoothstep(0.85, 2, footprint)
 *
 * The footprint of a pixel is the ellipse on the cloth that it covers; its size is the longer axis, in threads. Below
 * one thread a pixel, callers average points. Beyond two, the colours are those of crossings, averaged over the
 * footprint, and the lobe is the woven one that is fitted to the whole cloth. Averaged directions of fibres, in lobe
 * yarn, would be 15 to 45 % off (docs/weave.md). */
#pragma once

#include "shading/dialect/azimuth.h"
#include "shading/stack/stack.h"
#include "shading/weave/weave_light.h"

/* A pixel on the cloth, in threads. */
STRUCT(WeaveFootprint) {
    float x, y;    /* width across the warp and across the weft */
    float longest; /* longer axis of the ellipse */
};

/* Returns the footprint of a pixel whose sides are (ax, ay) and (bx, by) on the cloth. */
FN WeaveFootprint weave_footprint(float ax, float ay, float bx, float by) {
    float xx = ax * ax + bx * bx, yy = ay * ay + by * by, xy = ax * ay + bx * by, skew = 0.5f * (xx - yy);
    WeaveFootprint f;
    f.x = sqrt(xx);
    f.y = sqrt(yy);
    f.longest = sqrt(0.5f * (xx + yy) + sqrt(skew * skew + xy * xy));
    return f;
}

/* Returns w. It rises from a little below one thread, since five points a pixel vary too much there. */
FN float weave_far_weight(WeaveFootprint f) {
    float t = clamp((f.longest - 0.85f) / 1.15f, 0.0f, 1.0f);
    return t * t * (3.0f - 2.0f * t);
}

/* Returns w for pixels of a single point. Two points side by side on a thread still tell it from its neighbours by their
 * colours, and so do its colours from afar. */
FN float weave_far_weight_alone(WeaveFootprint f) {
    float t = clamp(4.0f * f.longest - 1.0f, 0.0f, 1.0f);
    return t * t * (3.0f - 2.0f * t);
}

/* Returns the mipmap level for a footprint. warps, picks: threads that a texel of level 0 spans. */
FN float weave_far_level(WeaveFootprint f, float warps, float picks) {
    return log2(max(max(f.x / warps, f.y / picks), 1.0f));
}

/* Returns the factor on the amount of dye of a system, as a mean over a footprint of f about x, y. Four threads stand
 * for all that it covers, scaled so that the mean varies as that of all does, which fades from 8 to 16 threads. What
 * varies over many threads does not. */
FN float weave_far_dye(const Weave *m, bool weft, float x, float y, WeaveFootprint f) {
    WeaveYarn yarn = weave_yarn_of(m, weft);
    float side = weft ? m->cycle_y : m->cycle_x, cycle = weft ? m->cycle_x : m->cycle_y, sum = 0.0f;
    float u = weft ? y : x, v = weft ? x : y;
    float threads = clamp(weft ? f.y : f.x, 1.0f, 1e6f), crossings = clamp(weft ? f.x : f.y, 1.0f, 1e6f);
    float width = min(threads, 16.0f);
    WeaveNodes thick = weave_nodes_along(yarn.slub_nodes, v, cycle);
    ROUNDS(k, 4) {
        float c = floor(u + (0.25f * to_float(k) - 0.375f) * width);
        float slub = weave_noise(m->seed, WEAVE_OF_THREADS + (weft ? 1 : 0), weave_wrap(c, side), thick).second;
        sum = sum + weave_slub_dye(yarn, slub) - 1.0f - 0.7f * yarn.dye * weave_thread_dye(m->seed, weft, c, side);
    }
    float fades = clamp((16.0f - width) / 8.0f, 0.0f, 1.0f) * min(2.0f / sqrt(width), 1.0f);
    return (1.0f + 0.25f * sum * fades) * weave_lot_dye(m, yarn, weft, u, v, threads, crossings);
}

/* The content of the diffuse slot of a stack. */
STRUCT(WeaveBase) {
    Lobe lobe;
    Rgb single;   /* colour of light that met one fibre */
    Rgb multiple; /* colour of all other light */
};

/* Return the colours of a point of which wear has taken the dye as far as it lies high. */
FN Rgb weave_worn_single(const Weave *m, WeavePoint p, float wear) {
    return weave_worn(weave_single_rgb(m, p), weave_core_single(weave_yarn_of(m, p.weft)) * weave_open(m, p),
                      wear * weave_raised(m, p));
}
FN Rgb weave_worn_multiple(const Weave *m, WeavePoint p, float wear) {
    return weave_worn(weave_multiple_rgb(m, p), weave_core_multiple(weave_yarn_of(m, p.weft)) * weave_open(m, p),
                      wear * weave_raised(m, p));
}

/* Returns a point of a thread. wear: the input of the material. */
FN WeaveBase weave_near(const Weave *m, WeavePoint p, float wear) {
    Yarn y = weave_yarn(m, p);
    WeaveBase b;
    b.lobe = lobe_default(LOBE_YARN);
    b.lobe.params[YARN_ALPHA] = y.alpha;
    b.lobe.params[YARN_SLOPE_X] = y.slope_x;
    b.lobe.params[YARN_SLOPE_Y] = y.slope_y;
    b.lobe.params[YARN_AZIMUTH] = y.azimuth;
    b.lobe.params[YARN_ROUNDNESS] = y.roundness;
    b.lobe.params[YARN_CRIMP] = y.crimp;
    b.lobe.params[YARN_CROSS_CRIMP] = y.cross_crimp;
    b.lobe.params[YARN_SHARE] = y.share;
    b.single = weave_worn_single(m, p, wear);
    b.multiple = weave_worn_multiple(m, p, wear);
    return b;
}

/* Return the part c of a colour with dye times as much dye: of light that met one fibre, whose share `white` has no
 * dye, and of all other light, in which rho(A) of yarn_medium.h is solved for the albedo A. covers: the share of the
 * cloth that reflects c. Crowns get more than their share of light, so c may be greater. */
FN float weave_dyed_single(float c, float covers, float white, float dye) {
    float most = max(max(covers, c), 1e-6f), undyed = min(white, c / most);
    return most * (undyed + weave_dyed(c / most - undyed, dye));
}
FN float weave_dyed_multiple(float c, float covers, float dye) {
    float most = max(max(covers, c), 1e-6f), root = sqrt(c / most), g = (1.0f - root) / (1.0f + 0.32f * root);
    return most * yarn_reflectance(weave_dyed(1.0f - g * g, dye));
}
FN Rgb weave_dyed_single_rgb(Rgb c, float covers, float white, float dye) {
    return rgb(weave_dyed_single(c.r, covers, white, dye), weave_dyed_single(c.g, covers, white, dye),
               weave_dyed_single(c.b, covers, white, dye));
}
FN Rgb weave_dyed_multiple_rgb(Rgb c, float covers, float dye) {
    return rgb(weave_dyed_multiple(c.r, covers, dye), weave_dyed_multiple(c.g, covers, dye),
               weave_dyed_multiple(c.b, covers, dye));
}

/* Return the colours that the cloth has of a system that covers so much of it: c with dye times as much dye, and worn.
 * What shows instead of the dye is as much in the shade of other threads as the system is. */
FN Rgb weave_far_single(const Weave *m, bool weft, Rgb c, float covers, float dye, float wear) {
    WeaveYarn y = weave_yarn_of(m, weft);
    float open = weft ? m->weft_far.open : m->warp_far.open, raised = weft ? m->weft_far.raised : m->warp_far.raised;
    return weave_worn(weave_dyed_single_rgb(c, covers, y.white, dye), covers * open * weave_core_single(y),
                      wear * raised);
}
FN Rgb weave_far_multiple(const Weave *m, bool weft, Rgb c, float covers, float dye, float wear) {
    WeaveYarn y = weave_yarn_of(m, weft);
    float open = weft ? m->weft_far.open : m->warp_far.open, raised = weft ? m->weft_far.raised : m->warp_far.raised;
    return weave_worn(weave_dyed_multiple_rgb(c, covers, dye), covers * open * weave_core_multiple(y), wear * raised);
}

/* Return the same for the system's lobe: times the factor that gives it the mean of points. */
FN Rgb weave_fitted_single(const Weave *m, bool weft, Rgb c, float covers, float dye, float wear) {
    return rgb_scale(weave_far_single(m, weft, c, covers, dye, wear), weft ? m->weft_far.single : m->warp_far.single);
}
FN Rgb weave_fitted_multiple(const Weave *m, bool weft, Rgb c, float covers, float dye, float wear) {
    return rgb_scale(weave_far_multiple(m, weft, c, covers, dye, wear),
                     weft ? m->weft_far.multiple : m->warp_far.multiple);
}

/* Returns the threads of one system. single, multiple: the colours that the cloth has of these threads, which cover so
 * much of it. So the colours of the base contain the share, which the lobe must not apply a second time. */
FN WeaveBase weave_far(const Weave *m, bool weft, Rgb single, Rgb multiple, float covers, float dye, float wear) {
    Woven w = weave_woven(m, weft);
    WeaveBase b;
    b.lobe = lobe_default(LOBE_WOVEN);
    b.lobe.params[WOVEN_ALPHA] = w.alpha;
    b.lobe.params[WOVEN_SHARE] = w.share;
    b.lobe.params[WOVEN_CRIMP] = w.crimp;
    b.lobe.params[WOVEN_AZIMUTH] = w.azimuth;
    b.lobe.params[WOVEN_TWIST] = w.twist;
    b.lobe.params[WOVEN_ROUNDNESS] = w.roundness;
    b.lobe.params[WOVEN_FLOATS] = w.floats;
    b.lobe.params[WOVEN_CROSS_CRIMP] = w.cross_crimp;
    b.single = weave_fitted_single(m, weft, single, covers, dye, wear);
    b.multiple = weave_fitted_multiple(m, weft, multiple, covers, dye, wear);
    return b;
}
