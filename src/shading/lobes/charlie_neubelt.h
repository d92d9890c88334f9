/* charlie-neubelt - velvet as most engines draw it: a soft rim that brightens towards grazing
 *
 *   f = color D(h) V(wo, wi)                                                                     [1/sr]
 *
 *   D: term d_charlie (Conty Estevez, Kulla 2017).  V: term v_neubelt (Neubelt, Pettineo 2013).
 *   roughness: alpha = roughness^2, as in KHR_materials_sheen and three.js. Babylon.js adds 0.0005; Filament
 *     first raises roughness to at least 0.045.
 *   reciprocal: yes.
 *   energy: no, E passes 1 near grazing for alpha < 0.21: at cos_o 0.02 it is 1.38 at alpha 0.0625,
 *     and 2.69 at alpha 0.01.
 *   sampling: half by D, half uniform.
 *   Not for: satin and leather, which have a highlight in the mirror direction.
 *   measured by weft check charlie-neubelt: E at most 3.88 (alpha 0.01, cos_o 0.001);
 *     reciprocal to 1e-3; weight variance 0.32 of the cosine's;
 *     half precision: finite for cosines >= 2^-13. */
#pragma once

#include "shading/lobe/lobe.h"
#include "shading/terms/d_charlie.h"
#include "shading/terms/v_neubelt.h"

#define CHARLIE_NEUBELT_PARAMS(P)                                                                                      \
    P(float, alpha, 0.25f, 0.01f, 1.0f, 0.005f, 4.0f, "width of the fibres' spread; low is a thin rim")
#define CHARLIE_NEUBELT_TRAITS TRAIT_RECIPROCAL

STRUCT(CharlieNeubelt){CHARLIE_NEUBELT_PARAMS(FIELD)};

STRUCT(CharlieNeubeltPrepared) { Charlie d; };
FN void charlie_neubelt_prepare(CharlieNeubelt m, CharlieNeubeltPrepared *p) { p->d = charlie_of(m.alpha); }

STRUCT(CharlieNeubeltView) { CharlieSide side; };
FN void charlie_neubelt_view(const CharlieNeubeltPrepared *p, Dir o, CharlieNeubeltView *w) {
    w->side = charlie_side(o);
}

FN LobeValue charlie_neubelt_value(const CharlieNeubeltPrepared *p, const CharlieNeubeltView *w, Angles a) {
    float d = charlie_d_sin2(p->d, a.sin2_h);
    return lobe_value_of(d * neubelt_v(a.o.z, a.i.z), 0.0f, charlie_pdf(d, w->side, a));
}
FN Dir charlie_neubelt_sample(const CharlieNeubeltPrepared *p, const CharlieNeubeltView *w, Dir o, float u, float v) {
    return charlie_sample(p->d, w->side, o, u, v);
}
