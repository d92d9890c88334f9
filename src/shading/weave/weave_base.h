/* weave_base.h - a woven cloth at a place, as the base of a stack: near by a point of a thread, from afar the mean of
 * one system's threads
 *
 *   base = (1 - w) yarn + w (warp + weft),  w = smoothstep(0.85, 2, footprint)
 *
 * The footprint of a pixel is the longer half axis of the ellipse that it covers, twice, in threads. Below one thread
 * a pixel, points are averaged by whoever looks. Beyond two, the colours are those of crossings, averaged over the
 * footprint, and the lobe is woven as it is fitted to the whole cloth: averaged directions of fibres would be 15 to 45 % off
 * (docs/weave.md). */
#ifndef WEFT_SHADING_WEAVE_BASE_H
#define WEFT_SHADING_WEAVE_BASE_H

#include "shading/dialect/azimuth.h"
#include "shading/stack/stack.h"
#include "shading/weave/weave_light.h"

/* A pixel on the cloth, in threads: across the warp, across the weft, along its longest. */
STRUCT(WeaveFootprint) { float x, y, longest; };

/* From two directions at right angles on the picture, each a pixel long, as the cloth has them. */
FN WeaveFootprint weave_footprint(float ax, float ay, float bx, float by) {
    float xx = ax * ax + bx * bx, yy = ay * ay + by * by, xy = ax * ay + bx * by, skew = 0.5f * (xx - yy);
    WeaveFootprint f;
    f.x = sqrt(xx);
    f.y = sqrt(yy);
    f.longest = sqrt(0.5f * (xx + yy) + sqrt(skew * skew + xy * xy));
    return f;
}

/* w. It begins a little below one thread, since pixels of five points vary too much there. */
FN float weave_far_weight(WeaveFootprint f) {
    float t = clamp((f.longest - 0.85f) / 1.15f, 0.0f, 1.0f);
    return t * t * (3.0f - 2.0f * t);
}

/* The level of a picture of the repeat, of which a texel is so many warp threads wide and picks high, that a footprint
 * asks for. */
FN float weave_far_level(WeaveFootprint f, float warps, float picks) {
    return log2(max(max(f.x / warps, f.y / picks), 1.0f));
}

/* The factor on dye, as a mean over a footprint of so many threads about u: of four, whose mean varies as that of
 * all would. Of 16 threads or more nothing is left to see. */
FN float weave_far_dye(const Weave *m, bool weft, float u, float threads) {
    float side = weft ? m->cycle_y : m->cycle_x, sum = 0.0f;
    float dye = weft ? m->weft.dye : m->warp.dye, wide = clamp(threads, 1.0f, 16.0f);
    ROUNDS(k, 4) {
        float c = floor(u + (0.25f * to_float(k) - 0.375f) * wide);
        sum = sum + weave_thread_dye(m->seed, weft, c, side);
    }
    float fades = clamp((16.0f - wide) / 8.0f, 0.0f, 1.0f) * min(2.0f / sqrt(wide), 1.0f);
    return 1.0f - dye * 0.7f * 0.25f * sum * fades;
}

/* A lobe in the place of a base, and its two colours. */
STRUCT(WeaveBase) {
    Lobe lobe;
    Rgb once, again;
};

FN WeaveBase weave_near(const Weave *m, WeavePoint p) {
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
    b.once = weave_once_rgb(m, p);
    b.again = weave_again_rgb(m, p);
    return b;
}

/* The part c of a colour, which covers so much, with so much more dye, as if it were the fibres' albedo. Crowns, which get
 * more than their share of light, may reflect more than they cover. */
FN float weave_dyed(float c, float covers, float dye) {
    float most = max(covers, c);
    return c * most / max(c + (most - c) * dye, 1e-6f);
}
FN Rgb weave_dyed_rgb(Rgb c, float covers, float dye) {
    return rgb(weave_dyed(c.r, covers, dye), weave_dyed(c.g, covers, dye), weave_dyed(c.b, covers, dye));
}

/* The threads of one system, which cover so much of the cloth there. once, again: what they reflect, in parts of
 * the whole cloth, as the colours of the base are: its lobe is to leave the share out. */
FN WeaveBase weave_far(const Weave *m, bool weft, Rgb once, Rgb again, float covers, float dye) {
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
    b.once = rgb_scale(weave_dyed_rgb(once, covers, dye), weft ? m->weft_far.once : m->warp_far.once);
    b.again = rgb_scale(weave_dyed_rgb(again, covers, dye), weft ? m->weft_far.again : m->warp_far.again);
    return b;
}

#endif
