/* charlie-neubelt - velvet as most engines draw it: a soft rim that brightens towards grazing
 *
 *   f = color D(h) V(wo, wi)                                                                     [1/sr]
 *
 *   D: term d_charlie (Conty Estevez, Kulla 2017).  V: term v_neubelt (Neubelt, Pettineo 2013).
 *   roughness: alpha = roughness^2 (KHR_materials_sheen; Filament, three.js, Babylon.js).
 *   reciprocal: yes.
 *   energy: no, E passes 1 near grazing for alpha < 0.21: at cos_o 0.02 it is 1.38 at alpha 0.0625,
 *     and 2.69 at alpha 0.01.
 *   sampling: half by D, half uniform.
 *   Not for: satin and leather, which have a highlight in the mirror direction.
 *   measured by weft check charlie-neubelt: E at most 3.88 (alpha 0.01, cos_o 0.001);
 *     reciprocal to 1e-3; weight variance 0.32 of the cosine's;
 *     half precision: finite for cosines >= 2^-13. */
#ifndef WEFT_CHARLIE_NEUBELT_H
#define WEFT_CHARLIE_NEUBELT_H

#include "shading/terms/d_charlie.h"
#include "shading/terms/v_neubelt.h"

#define CHARLIE_NEUBELT_PARAMS(P)                                                                            \
    P(float, alpha, 0.25f, 0.01f, 1.0f, 0.005f, 4.0f, "width of the fibres' spread; low is a thin rim")
#define CHARLIE_NEUBELT_TRAITS TRAIT_RECIPROCAL

STRUCT(CharlieNeubelt){CHARLIE_NEUBELT_PARAMS(FIELD)};

FN float charlie_neubelt_eval(CharlieNeubelt m, Angles a) {
    return charlie_d_sin2(m.alpha, a.sin2_h) * neubelt_v(a.o.z, a.i.z);
}
FN float charlie_neubelt_pdf(CharlieNeubelt m, Angles a) { return charlie_pdf(m.alpha, a); }
FN Dir charlie_neubelt_sample(CharlieNeubelt m, Dir o, float u, float v) {
    return charlie_sample(m.alpha, o, u, v);
}

#endif
