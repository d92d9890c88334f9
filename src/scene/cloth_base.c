#include "scene/cloth_base.h"

#include <math.h>

/* The samples of a pixel average points and crossings, without an error: so the mean takes their place from two threads
 * a pixel on, completely at four, and its colours are those of a quarter of the pixel. Fibres half as wide as a pixel are
 * seen. */
enum { LATER = 2, FINER = 4, POINTS = 2 };

/* Rows of picks run up the cloth, v runs down it. Further out than a million threads there are no fractions. */
static void place_of(const WeftCloth *cloth, const float uv[2], float *x, float *y) {
    const float across = uv[0] * cloth->per_uv[WEFT_WARP], up = -uv[1] * cloth->per_uv[WEFT_WEFT];
    const bool there = fabsf(across) < 1e6f && fabsf(up) < 1e6f;
    *x = there ? across : 0.0f;
    *y = there ? up : 0.0f;
}

bool cloth_is_gap(const WeftCloth *cloth, const float uv[2]) {
    float x, y;
    place_of(cloth, uv, &x, &y);
    return weave_top(&cloth->weave, x, y).height <= WEAVE_NONE;
}

/* One system from afar, its colours times `scale`. */
static WeaveBase far_base(const WeftCloth *cloth, WeaveFootprint f, float x, float y, bool weft,
                          float scale) {
    const Weave *m = &cloth->weave;
    const float warps = (float)m->warps, picks = (float)m->picks;
    const float level =
        weave_far_level(f, FINER * warps / (float)cloth->far.width, FINER * picks / (float)cloth->far.height);
    const float *once =
        cloth_far_color(&cloth->far, weft ? FAR_WEFT_ONCE : FAR_WARP_ONCE, x / warps, y / picks, level);
    const float *again =
        cloth_far_color(&cloth->far, weft ? FAR_WEFT_AGAIN : FAR_WARP_AGAIN, x / warps, y / picks, level);
    const float dye = weave_far_dye(m, weft, weft ? y : x, (weft ? f.y : f.x) / FINER);
    WeaveBase b =
        weave_far(m, weft, rgb(once[0], once[1], once[2]), rgb(again[0], again[1], again[2]), once[3], dye);
    b.once = rgb_scale(b.once, scale);
    b.again = rgb_scale(b.again, scale);
    return b;
}

/* About what a base reflects. */
static float weight_of(const WeaveBase *b) {
    return b->lobe.params[WOVEN_SHARE] * (0.3f * rgb_mean(b->once) + 0.7f * rgb_mean(b->again));
}

static WeaveBase from_afar(const WeftCloth *cloth, const ClothLook *look, float x, float y) {
    const Weave *m = &cloth->weave;
    const float scale = look->holed ? 1.0f / fmaxf(m->warp_far.share + m->weft_far.share, 1e-3f) : 1.0f;
    const WeaveBase warp = far_base(cloth, look->footprint, x, y, false, scale),
                    weft = far_base(cloth, look->footprint, x, y, true, scale);
    const float a = weight_of(&warp), b = weight_of(&weft), chance = a + b > 0.0f ? a / (a + b) : 1.0f;
    const bool is_warp = look->system < chance;
    WeaveBase one = is_warp ? warp : weft;
    const float worth = 1.0f / fmaxf(is_warp ? chance : 1.0f - chance, 1e-6f);
    one.once = rgb_scale(one.once, worth);
    one.again = rgb_scale(one.again, worth);
    return one;
}

void cloth_base(const WeftCloth *cloth, const ClothLook *look, Stack *stack) {
    float x, y;
    place_of(cloth, look->uv, &x, &y);
    const WeaveFootprint *f = &look->footprint;
    const bool far =
        look->level < weave_far_weight((WeaveFootprint){f->x / LATER, f->y / LATER, f->longest / LATER});
    const WeaveBase b =
        far ? from_afar(cloth, look, x, y)
            : weave_near(&cloth->weave, weave_point(&cloth->weave, x, y, f->longest / POINTS));
    stack_put_base(stack, &b.lobe, b.once, b.again);
}
