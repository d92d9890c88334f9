/* wrap - light that creeps past the terminator: a soft edge of the shadow without any scattering
 *
 *   f = color (cos_i + wrap) / (pi (1 + wrap)^2 cos_i)                                           [1/sr]
 *
 *   Google, Filament, Fd_Wrap in surface_brdf.fs, 2018; normalised so that E is 1 over the whole sphere of
 * lights.
 *   Departures: a lobe ends at the horizon, so light from below, which the original takes down to cos_i =
 * -wrap, is left out; cos_i below 1e-6 counts as 1e-6.
 *   roughness: none; wrap is how far past the horizon the light reaches, 0 is Lambert.
 *   reciprocal: no, cos_i alone is in it.
 *   energy: E = color (1 + 2 wrap) / (1 + wrap)^2 from everywhere, 3/4 at wrap 1.
 *   sampling: cosine and uniform mixed in the ratio 1 : 2 wrap, weight constant.
 *   measured by weft check wrap: E at most 1.00 (wrap 0, cos_o 1);
 *     f(wo, wi) and f(wi, wo) up to 1.00 of the larger apart; weight variance under 0.01 of the cosine's;
 *     half precision: finite for cosines >= 2^-19. */
#pragma once

#include "shading/dialect/warp.h"
#include "shading/lobe/lobe.h"

#define WRAP_PARAMS(P) P(float, wrap, 0.5f, 0.0f, 1.0f, 0.0f, 1.0f, "reach past the terminator, 0 is Lambert")
#define WRAP_TRAITS    (TRAIT_CONSERVES | TRAIT_DIFFUSE)

STRUCT(Wrap){WRAP_PARAMS(FIELD)};

STRUCT(WrapPrepared) {
    float wrap, scale; /* scale = 1 / (pi (1 + wrap)^2) */
    float uniform_part;
};
FN void wrap_prepare(Wrap m, WrapPrepared *p) {
    float w1 = 1.0f + m.wrap;
    p->wrap = m.wrap;
    p->scale = 1.0f / (PI * w1 * w1);
    p->uniform_part = 2.0f * m.wrap / (1.0f + 2.0f * m.wrap);
}
SEEN_AS_IT_IS(wrap, Wrap)

FN LobeValue wrap_value(const WrapPrepared *p, const WrapView *w, Angles a) {
    float cos_i = max(a.i.z, 1e-6f);
    return lobe_value_of(p->scale * (cos_i + p->wrap) / cos_i, 0.0f, warp_uniform_cosine_pdf(p->uniform_part, a.i));
}
FN Dir wrap_sample(const WrapPrepared *p, const WrapView *w, Dir o, float u, float v) {
    return warp_uniform_cosine(p->uniform_part, u, v);
}
