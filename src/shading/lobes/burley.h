/* burley - a matt surface that throws light back to where it came from when rough, and darkens at the edges
 * when smooth
 *
 *   f = color (1 + (fd90 - 1) s_i) (1 + (fd90 - 1) s_o) / pi                                     [1/sr]
 *   fd90 = 0.5 + 2 d^2 roughness,  s = (1 - cos)^5,  d = wi . h
 *
 *   Brent Burley, "Physically Based Shading at Disney", SIGGRAPH 2012 course, Section 5.3.
 *   roughness: the artist's own, not squared.
 *   reciprocal: yes.
 *   energy: no, E passes 1 from roughness 0.41 on: at cos_o 0.02 it is 0.535 at roughness 0, 1.011 at 0.5 and
 *     1.519 at 1.
 *   sampling: cosine; the weight is at most 2.5^2.
 *   measured by weft check burley: E at most 1.56 (roughness 1, cos_o 0.001);
 *     reciprocal to 1e-3; weight variance 1.00 of the cosine's;
 *     half precision: finite for any cosines. */
#pragma once

#include "shading/dialect/warp.h"
#include "shading/lobe/lobe.h"
#include "shading/terms/f_schlick.h"

#define BURLEY_PARAMS(P)                                                                                               \
    P(float, roughness, 0.5f, 0.0f, 1.0f, 0.0f, 1.0f, "0 darkens at grazing, 1 brightens towards the light")
#define BURLEY_TRAITS (TRAIT_RECIPROCAL | TRAIT_DIFFUSE)

STRUCT(Burley){BURLEY_PARAMS(FIELD)};
PREPARED_AS_IT_IS(burley, Burley)

STRUCT(BurleyView) { float s_o; };
FN void burley_view(const BurleyPrepared *p, Dir o, BurleyView *w) { w->s_o = schlick_s(o.z); }

FN float burley_f(float roughness, float s_o, float s_i, float d) {
    float fd90 = 0.5f + 2.0f * d * d * roughness;
    return mix(1.0f, fd90, s_i) * mix(1.0f, fd90, s_o) / PI;
}

FN LobeValue burley_value(const BurleyPrepared *p, const BurleyView *w, Angles a) {
    return lobe_value_of(burley_f(p->m.roughness, w->s_o, schlick_s(a.i.z), a.d), 0.0f, warp_cosine_pdf(a.i));
}
FN Dir burley_sample(const BurleyPrepared *p, const BurleyView *w, Dir o, float u, float v) {
    return warp_cosine(u, v);
}
