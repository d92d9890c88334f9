/* fabric-lambert - cotton and wool as one engine has them: matt, and darker the rougher
 *
 *   f = color (1 - roughness / 2) / pi                                                           [1/sr]
 *
 *   Unity Technologies, High Definition Render Pipeline, FabricLambertNoPI in BSDF.hlsl, 2018; empirical by
 * its own comment.
 *   roughness: Fabric.hlsl passes alpha, the square of the artist's roughness.
 *   reciprocal: yes.  energy: E = color (1 - roughness / 2) exactly.  sampling: cosine, weight constant.
 *   measured by weft check fabric-lambert: E at most 1.00 (roughness 0, cos_o 1);
 *     reciprocal to 1e-3; weight variance 1.00 of the cosine's;
 *     half precision: finite for any cosines. */
#pragma once

#include "shading/dialect/warp.h"
#include "shading/lobe/lobe.h"

#define FABRIC_LAMBERT_PARAMS(P) P(float, roughness, 0.5f, 0.0f, 1.0f, 0.0f, 1.0f, "0 is Lambert, 1 half as bright")
#define FABRIC_LAMBERT_TRAITS    (TRAIT_RECIPROCAL | TRAIT_CONSERVES | TRAIT_DIFFUSE)

STRUCT(FabricLambert){FABRIC_LAMBERT_PARAMS(FIELD)};
PREPARED_AS_IT_IS(fabric_lambert, FabricLambert)
SEEN_AS_IT_IS(fabric_lambert, FabricLambert)

FN LobeValue fabric_lambert_value(const FabricLambertPrepared *p, const FabricLambertView *w, Angles a) {
    return lobe_value_of(mix(1.0f, 0.5f, p->m.roughness) / PI, 0.0f, warp_cosine_pdf(a.i));
}
FN Dir fabric_lambert_sample(const FabricLambertPrepared *p, const FabricLambertView *w, Dir o, float u, float v) {
    return warp_cosine(u, v);
}
