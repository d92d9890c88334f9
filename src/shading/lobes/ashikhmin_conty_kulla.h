/* ashikhmin-conty-kulla - velvet of a soft rim, dimmer at grazing light than with the smooth denominator
 *
 *   f = color D(h) V(wo, wi)                                                                     [1/sr]
 *
 *   D: term d_ashikhmin (2007, 2013).  V: term v_conty_kulla, which was fitted to the Charlie distribution,
 * not to this one: a pair that engines offer as two switches. reciprocal: yes.
 */
#ifndef WEFT_ASHIKHMIN_CONTY_KULLA_H
#define WEFT_ASHIKHMIN_CONTY_KULLA_H

#include "shading/lobes/ashikhmin_neubelt.h"
#include "shading/terms/v_conty_kulla.h"

#define ASHIKHMIN_CONTY_KULLA_PARAMS(P)                                                                      \
    P(float, alpha, 0.25f, 0.05f, 1.0f, 0.02f, 1.0f, "width of the rise at the horizon; low is a thin rim")
#define ASHIKHMIN_CONTY_KULLA_TRAITS TRAIT_RECIPROCAL

STRUCT(AshikhminContyKulla){ASHIKHMIN_CONTY_KULLA_PARAMS(FIELD)};

FN float ashikhmin_conty_kulla_eval(AshikhminContyKulla m, Angles a) {
    return ashikhmin_d(m.alpha, a.h) * conty_kulla_v(m.alpha, max(a.o.z, 1e-5f), max(a.i.z, 1e-5f));
}

FN AshikhminNeubelt ashikhmin_conty_kulla_proposal(AshikhminContyKulla m) {
    AshikhminNeubelt p;
    p.alpha = m.alpha;
    return p;
}
FN float ashikhmin_conty_kulla_pdf(AshikhminContyKulla m, Angles a) {
    return ashikhmin_neubelt_pdf(ashikhmin_conty_kulla_proposal(m), a);
}
FN Dir ashikhmin_conty_kulla_sample(AshikhminContyKulla m, Dir o, float u, float v) {
    return ashikhmin_neubelt_sample(ashikhmin_conty_kulla_proposal(m), o, u, v);
}

#endif
