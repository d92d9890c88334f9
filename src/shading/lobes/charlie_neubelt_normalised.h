/* charlie-neubelt-normalised - velvet as most engines draw it, without the light it invents at grazing
 *
 *   f = color D(h) V(wo, wi) / max(1, E(cos_o), E(cos_i))                                        [1/sr]
 *
 *   D, V: those of charlie-neubelt, and E its directional albedo from a table made at run time. Dividing by
 * the larger of the two keeps the lobe reciprocal, and E below 1; where charlie-neubelt conserves energy the
 * two are the same.
 *   Alejandro Conty Estevez, Christopher Kulla, SIGGRAPH 2017 course (D); David Neubelt, Matt Pettineo,
 * SIGGRAPH 2013 course (V); the division is weft's own.
 *   roughness: alpha = roughness^2.
 *   reciprocal: yes.
 *   energy: E <= 1, to the interpolation of the table.
 *   sampling: that of charlie-neubelt.
 *   measured by weft check charlie-neubelt-normalised: E at most 1.00 (alpha 0.01, cos_o 0.001);
 *     reciprocal to 1e-3; weight variance 0.32 of the cosine's;
 *     half precision: finite for cosines >= 2^-13. */
#pragma once

#include "shading/lobe/lobe_tables.h"
#include "shading/lobes/charlie_neubelt.h"

#define CHARLIE_NEUBELT_NORMALISED_PARAMS(P)                                                                           \
    P(float, alpha, 0.25f, 0.01f, 1.0f, 0.005f, 4.0f, "width of the fibres' spread; low is a thin rim")
#define CHARLIE_NEUBELT_NORMALISED_TRAITS (TRAIT_RECIPROCAL | TRAIT_CONSERVES | TRAIT_TABLE)

STRUCT(CharlieNeubeltNormalised){CHARLIE_NEUBELT_NORMALISED_PARAMS(FIELD)};

STRUCT(CharlieNeubeltNormalisedPrepared) {
    Charlie d;
    float alpha;
};
FN void charlie_neubelt_normalised_prepare(CharlieNeubeltNormalised m, CharlieNeubeltNormalisedPrepared *p) {
    p->d = charlie_of(m.alpha);
    p->alpha = m.alpha;
}

STRUCT(CharlieNeubeltNormalisedView) {
    CharlieSide side;
    float e; /* of charlie-neubelt */
};
FN void charlie_neubelt_normalised_view(const CharlieNeubeltNormalisedPrepared *p, Dir o,
                                        CharlieNeubeltNormalisedView *w) {
    w->side = charlie_side(o);
    w->e = table_roots(lobe_table_charlie_neubelt(), o.z, p->alpha);
}

FN LobeValue charlie_neubelt_normalised_value(const CharlieNeubeltNormalisedPrepared *p,
                                              const CharlieNeubeltNormalisedView *w, Angles a) {
    float d = charlie_d_sin2(p->d, a.sin2_h);
    float most = max(w->e, table_roots(lobe_table_charlie_neubelt(), a.i.z, p->alpha));
    return lobe_value_of(d * neubelt_v(a.o.z, a.i.z) / max(1.0f, most), 0.0f, charlie_pdf(d, w->side, a));
}
FN Dir charlie_neubelt_normalised_sample(const CharlieNeubeltNormalisedPrepared *p,
                                         const CharlieNeubeltNormalisedView *w, Dir o, float u, float v) {
    return charlie_sample(p->d, w->side, o, u, v);
}
