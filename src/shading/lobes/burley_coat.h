/* burley-coat - the thin varnish of the principled BRDF: a sharp highlight with a long, faint tail
 *
 *   f = D(h) V(wo, wi) F(wi . h),   F = f0 (1 - s) + f90 s                                       [1/sr]
 *
 *   D: term d_gtr1 with alpha.  V: term v_smith_ggx with alpha 0.25 whatever the gloss.  F: term f_schlick.
 *   Brent Burley, "Physically Based Shading at Disney", SIGGRAPH 2012 course, section 5.4 and appendix B.
 *   roughness: alpha = mix(0.1, 0.001, clearcoat_gloss).
 *   reciprocal: yes.
 *   energy: no, not promised of the white lobe: D and V are of different roughness; the paper weighs it by
 *     0.25 clearcoat.
 *   sampling: half by D, half uniform.
 *   measured by weft check burley-coat: E at most 1.38 (alpha 0.1, cos_o 0.001);
 *     reciprocal to 1e-3; weight variance under 0.01 of the cosine's;
 *     half precision: finite for cosines >= 2^-13 and alpha >= 0.0026. */
#pragma once

#include "shading/dialect/warp.h"
#include "shading/lobe/lobe.h"
#include "shading/terms/d_gtr1.h"
#include "shading/terms/f_schlick.h"
#include "shading/terms/v_smith_ggx.h"

#define BURLEY_COAT_PARAMS(P) P(float, alpha, 0.001f, 0.001f, 0.1f, 0.001f, 1.0f, "width of the highlight's peak")
#define BURLEY_COAT_TRAITS    (TRAIT_RECIPROCAL | TRAIT_TWO_COLORS)

STRUCT(BurleyCoat){BURLEY_COAT_PARAMS(FIELD)};
PREPARED_AS_IT_IS(burley_coat, BurleyCoat)
SEEN_AS_IT_IS(burley_coat, BurleyCoat)

FN LobeValue burley_coat_value(const BurleyCoatPrepared *p, const BurleyCoatView *w, Angles a) {
    float d = gtr1_d(p->m.alpha, a.h), half_vectors = d * a.h.z / (4.0f * max(a.d, 1e-6f));
    return lobe_value_of(d * smith_ggx_v(0.25f, a.o, a.i), schlick_s(a.d),
                         0.5f * half_vectors + 0.5f * warp_uniform_pdf(a.i));
}
FN Dir burley_coat_sample(const BurleyCoatPrepared *p, const BurleyCoatView *w, Dir o, float u, float v) {
    Dir i = warp_uniform(2.0f * u - 1.0f, v);
    if (u < 0.5f) i = dir_mirror(o, gtr1_facet(p->m.alpha, 2.0f * u, v));
    return i;
}
FN Proxy burley_coat_proxy(BurleyCoat m) { return gtr1_proxy(m.alpha); }
