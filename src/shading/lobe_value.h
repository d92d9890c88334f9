/* lobe_value.h - what a pair of directions gets from a lobe, and what its colours make of that */
#ifndef WEFT_LOBE_VALUE_H
#define WEFT_LOBE_VALUE_H

#include "shading/share.h"
#include "shading/tint.h"

STRUCT(LobeValue) {
    float f;   /* 1/sr, of the white lobe */
    float s;   /* share of the second colour, or a cosine (share.h); 0 without TRAIT_TWO_COLORS */
    float pdf; /* density of lobe_sample at a.i, 1/sr */
    Tint tint; /* tint_none without TRAIT_TINTED */
};

FN LobeValue lobe_value_of(float f, float s, float pdf) {
    LobeValue v;
    v.f = f;
    v.s = s;
    v.pdf = pdf;
    v.tint = tint_none();
    return v;
}

/* What f is multiplied by in one channel: the second colour is what lobe_second says, times any weight that
 * the first has too. Of a tinted lobe that makes the weight, and first / second the albedo of its flakes. */
FN float lobe_color(LobeValue v, float first, float second) {
    if (v.tint.s > 0.0f) return second * tint_color(v.tint, first / max(second, 1e-30f));
    return share_mix(v.s, first, second);
}

#endif
