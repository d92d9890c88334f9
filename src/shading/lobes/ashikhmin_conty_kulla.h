/* ashikhmin-conty-kulla - velvet with a soft rim, which fades again at the very edge
 *
 *   f = color D(h) V(wo, wi)                                                                    [1/sr]
 *
 *   D: term d_ashikhmin (Ashikhmin, Premoze 2007; Neubelt, Pettineo 2013).  V: term v_conty_kulla (Conty
 *     Estevez, Kulla 2017), fitted to another distribution, Charlie: what a renderer draws that offers D
 *     and V as two switches.
 *   Departure: a cosine below 1e-5 is taken for 1e-5 in V. The fitted Lambda stays finite at the horizon,
 *     so that E would pass 1 there.
 *   roughness: alpha = roughness^2, the same in D and V.
 *   reciprocal: yes.
 *   energy: E <= 0.97, the most at alpha 0.6 near cos_o 0.01; at cos_o 0.02 it is 0.67 at alpha 0.25.
 *   sampling: half by D, half uniform.
 *   measured by weft check ashikhmin-conty-kulla: E at most 0.96 (alpha 0.64, cos_o 0.01);
 *     reciprocal to 1e-3; weight variance 0.29 of the cosine's;
 *     half precision: no floor keeps it finite (alpha 1, cos_o 1, cos_i 1, phi 0). */
#pragma once

#include "shading/lobes/ashikhmin_neubelt.h"
#include "shading/terms/v_conty_kulla.h"

#define ASHIKHMIN_CONTY_KULLA_PARAMS(P)                                                                                \
    P(float, alpha, 0.25f, 0.05f, 1.0f, 0.02f, 1.0f, "width of the rise at the horizon; low is a thin rim")
#define ASHIKHMIN_CONTY_KULLA_TRAITS (TRAIT_RECIPROCAL | TRAIT_CONSERVES)

STRUCT(AshikhminContyKulla){ASHIKHMIN_CONTY_KULLA_PARAMS(FIELD)};

STRUCT(AshikhminContyKullaPrepared) {
    float alpha;
    ContyKulla shadow;
};
FN void ashikhmin_conty_kulla_prepare(AshikhminContyKulla m, AshikhminContyKullaPrepared *p) {
    p->alpha = m.alpha;
    p->shadow = conty_kulla_of(m.alpha);
}

STRUCT(AshikhminContyKullaView) { float lambda; };
FN void ashikhmin_conty_kulla_view(const AshikhminContyKullaPrepared *p, Dir o, AshikhminContyKullaView *w) {
    w->lambda = conty_kulla_lambda(p->shadow, max(o.z, 1e-5f));
}

FN LobeValue ashikhmin_conty_kulla_value(const AshikhminContyKullaPrepared *p, const AshikhminContyKullaView *w,
                                         Angles a) {
    float d = ashikhmin_d(p->alpha, a.h);
    float f = d * conty_kulla_v_of(p->shadow, w->lambda, max(a.o.z, 1e-5f), max(a.i.z, 1e-5f));
    return lobe_value_of(f, 0.0f, ashikhmin_pdf(d, a));
}
FN Dir ashikhmin_conty_kulla_sample(const AshikhminContyKullaPrepared *p, const AshikhminContyKullaView *w, Dir o,
                                    float u, float v) {
    return ashikhmin_sample(p->alpha, o, u, v);
}
