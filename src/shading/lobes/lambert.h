/* lambert - a matt surface, equally bright from everywhere
 *
 *   f = color / pi                                                                               [1/sr]
 *
 *   Johann Heinrich Lambert, "Photometria", 1760.
 *   reciprocal: yes.  energy: E = color exactly.  sampling: cosine, weight constant.
 *   measured by weft check lambert: E at most 1.00 (cos_o 1);
 *     reciprocal to 1e-3; weight variance 1.00 of the cosine's;
 *     half precision: finite for any cosines. */
#pragma once

#include "shading/dialect/warp.h"
#include "shading/lobe/lobe.h"

#define LAMBERT_PARAMS(P)
#define LAMBERT_TRAITS (TRAIT_RECIPROCAL | TRAIT_CONSERVES | TRAIT_LOSSLESS | TRAIT_DIFFUSE)

STRUCT(Lambert) { float none; }; /* neither language has empty records */
PREPARED_AS_IT_IS(lambert, Lambert)
SEEN_AS_IT_IS(lambert, Lambert)

FN LobeValue lambert_value(const LambertPrepared *p, const LambertView *w, Angles a) {
    return lobe_value_of(1.0f / PI, 0.0f, warp_cosine_pdf(a.i));
}
FN Dir lambert_sample(const LambertPrepared *p, const LambertView *w, Dir o, float u, float v) {
    return warp_cosine(u, v);
}
