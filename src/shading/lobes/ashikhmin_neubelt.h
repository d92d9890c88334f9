/* ashikhmin-neubelt - velvet with a rim that stays soft, over a little light from everywhere
 *
 *   f = color D(h) V(wo, wi)                                                                    [1/sr]
 *
 *   D: term d_ashikhmin.  V: term v_neubelt.
 *   David Neubelt, Matt Pettineo, "Crafting a Next-Gen Material Pipeline for The Order: 1886", SIGGRAPH
 *     2013 course, after Michael Ashikhmin, Simon Premoze, "Distribution-based BRDFs", 2007.
 *   roughness: alpha = roughness^2 (Filament); the papers state alpha itself.
 *   reciprocal: yes.
 *   energy: E <= 0.87, the most at the horizon at alpha 0.32; at cos_o 0.02 it is 0.73 at alpha 0.25 and
 *     0.52 at alpha 1.
 *   sampling: half by D, half uniform.
 *   Not for: a pure rim; a part 1 / (1 + 4 alpha^2) of D is the same for all h, and hazes the front.
 *   measured by weft check ashikhmin-neubelt: E at most 0.85 (alpha 0.36, cos_o 0.001);
 *     reciprocal to 1e-3; weight variance 0.30 of the cosine's;
 *     half precision: no floor keeps it finite (alpha 1, cos_o 1, cos_i 1, phi 0). */
#pragma once

#include "shading/lobe/lobe.h"
#include "shading/terms/d_ashikhmin.h"
#include "shading/terms/v_neubelt.h"

#define ASHIKHMIN_NEUBELT_PARAMS(P)                                                                                    \
    P(float, alpha, 0.25f, 0.05f, 1.0f, 0.02f, 4.0f, "width of the rise at the horizon; low is a thin rim")
#define ASHIKHMIN_NEUBELT_TRAITS (TRAIT_RECIPROCAL | TRAIT_CONSERVES)

STRUCT(AshikhminNeubelt){ASHIKHMIN_NEUBELT_PARAMS(FIELD)};
PREPARED_AS_IT_IS(ashikhmin_neubelt, AshikhminNeubelt)
SEEN_AS_IT_IS(ashikhmin_neubelt, AshikhminNeubelt)

/* Returns a number that is positive if h is on the same side as wo. Half of the samples are drawn by D cos_h, with h
 * rotated to the side of wo, where wo . h > 0 always holds and the density doubles. The other half is uniform, which
 * bounds the weight. */
FN float ashikhmin_side(Dir o, Dir h) { return o.x * o.x + o.y * o.y > 1e-12f ? h.x * o.x + h.y * o.y : h.x; }

FN float ashikhmin_pdf(float d, Angles a) {
    float by_d = 2.0f * d * a.h.z / (4.0f * max(a.d, 1e-6f));
    return 0.5f * (ashikhmin_side(a.o, a.h) > 0.0f ? by_d : 0.0f) + 0.5f * warp_uniform_pdf(a.i);
}

FN Dir ashikhmin_sample(float alpha, Dir o, float u, float v) {
    Dir i = warp_uniform(2.0f * u - 1.0f, v);
    if (u < 0.5f) {
        Dir h = ashikhmin_facet(alpha, 2.0f * u, v);
        float sign = ashikhmin_side(o, h) < 0.0f ? -1.0f : 1.0f;
        i = dir_mirror(o, dir(sign * h.x, sign * h.y, h.z));
    }
    return i;
}

FN LobeValue ashikhmin_neubelt_value(const AshikhminNeubeltPrepared *p, const AshikhminNeubeltView *w, Angles a) {
    float d = ashikhmin_d(p->m.alpha, a.h);
    return lobe_value_of(d * neubelt_v(a.o.z, a.i.z), 0.0f, ashikhmin_pdf(d, a));
}
FN Dir ashikhmin_neubelt_sample(const AshikhminNeubeltPrepared *p, const AshikhminNeubeltView *w, Dir o, float u,
                                float v) {
    return ashikhmin_sample(p->m.alpha, o, u, v);
}
