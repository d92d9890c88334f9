/* toy - a cloth for tests: dark towards the edge, where light that was scattered twice shows its colour
 *
 *   f = (1 - s + s c) c (k + 2) / (2 pi) (cos_o cos_i)^k,   k = 1 - roughness                    [1/sr]
 *   s = (1 - cos_o)(1 - cos_i)
 *
 *   Made for weft's tests, 2026. c = color; the second colour is c c, whatever f90 says.
 *   roughness: as it is; 1 is Lambert in front.
 *   reciprocal: yes.
 *   energy: E <= color cos_o^k.
 *   sampling: by cos_i^(k + 1), which is f cos_i but for s; weight constant in front. */
#ifndef WEFT_TOY_H
#define WEFT_TOY_H

#include "shading/lobe/lobe.h"

#define TOY_PARAMS(P)                                                                                                  \
    P(float, roughness, 0.5f, 0.0f, 1.0f, 0.0f, 1.0f, "how slowly it darkens towards the edge")                        \
    P(float, fade, 1.0f, 0.0f, 1.0f, 0.0f, 1.0f, "how much of the second colour the edge shows")
#define TOY_TRAITS (TRAIT_RECIPROCAL | TRAIT_CONSERVES | TRAIT_TWO_COLORS)

STRUCT(Toy){TOY_PARAMS(FIELD)};

STRUCT(ToyPrepared) { float power, scale, fade; };
FN void toy_prepare(Toy m, ToyPrepared *p) {
    p->power = 1.0f - m.roughness;
    p->scale = (p->power + 2.0f) / (2.0f * PI);
    p->fade = m.fade;
}

STRUCT(ToyView) { float factor, away; };
FN void toy_view(const ToyPrepared *p, Dir o, ToyView *w) {
    w->factor = p->scale * pow(max(o.z, 1e-6f), p->power);
    w->away = p->fade * (1.0f - o.z);
}

FN float toy_second(Toy m, float f0, float f90) { return f0 * f0; }

FN LobeValue toy_value(const ToyPrepared *p, const ToyView *w, Angles a) {
    float i = pow(max(a.i.z, 1e-6f), p->power);
    return lobe_value_of(w->factor * i, w->away * (1.0f - a.i.z), p->scale * i * a.i.z);
}

FN Dir toy_sample(const ToyPrepared *p, const ToyView *w, Dir o, float u, float v) {
    float z = pow(1.0f - u, 1.0f / (p->power + 2.0f)), r = sqrt(max(1.0f - z * z, 0.0f)), phi = 2.0f * PI * v;
    return dir(r * cos(phi), r * sin(phi), z);
}

#endif
