/* charlie-conty-kulla - velvet as its authors and the text of glTF have it: the same rim, dimmer at grazing
 * light
 *
 *   f = color D(h) V(wo, wi)                                                                     [1/sr]
 *
 *   D: term d_charlie.  V: term v_conty_kulla, the fitted Smith shadowing of the same paper.
 *   Alejandro Conty Estevez, Christopher Kulla, "Production Friendly Microfacet Sheen BRDF", SIGGRAPH 2017
 * course; Khronos Group, KHR_materials_sheen, 2020.
 *   roughness: alpha = roughness^2 (KHR_materials_sheen).
 *   reciprocal: yes.
 *   energy: no, E passes 1 near grazing for alpha < 0.07: at cos_o 0.02 it is 1.63 at alpha 0.01. Below cos_o
 *     1e-5 it does so at any alpha, since the fitted Lambda stays finite there.
 *   sampling: half by D, half uniform.
 *   measured by weft check charlie-conty-kulla: E at most 2.10 (alpha 0.01, cos_o 0.001);
 *     reciprocal to 1e-3; weight variance 0.30 of the cosine's;
 *     half precision: finite for any cosines. */
#pragma once

#include "shading/lobe/lobe.h"
#include "shading/terms/d_charlie.h"
#include "shading/terms/v_conty_kulla.h"

#define CHARLIE_CONTY_KULLA_PARAMS(P)                                                                                  \
    P(float, alpha, 0.25f, 0.01f, 1.0f, 0.005f, 1.0f, "width of the fibres' spread; low is a thin rim")
#define CHARLIE_CONTY_KULLA_TRAITS TRAIT_RECIPROCAL

STRUCT(CharlieContyKulla){CHARLIE_CONTY_KULLA_PARAMS(FIELD)};

STRUCT(CharlieContyKullaPrepared) {
    Charlie d;
    ContyKulla shadow;
};
FN void charlie_conty_kulla_prepare(CharlieContyKulla m, CharlieContyKullaPrepared *p) {
    p->d = charlie_of(m.alpha);
    p->shadow = conty_kulla_of(m.alpha);
}

STRUCT(CharlieContyKullaView) {
    CharlieSide side;
    float lambda;
};
FN void charlie_conty_kulla_view(const CharlieContyKullaPrepared *p, Dir o, CharlieContyKullaView *w) {
    w->side = charlie_side(o);
    w->lambda = conty_kulla_lambda(p->shadow, o.z);
}

FN LobeValue charlie_conty_kulla_value(const CharlieContyKullaPrepared *p, const CharlieContyKullaView *w, Angles a) {
    float d = charlie_d_sin2(p->d, a.sin2_h);
    return lobe_value_of(d * conty_kulla_v_of(p->shadow, w->lambda, a.o.z, a.i.z), 0.0f, charlie_pdf(d, w->side, a));
}
FN Dir charlie_conty_kulla_sample(const CharlieContyKullaPrepared *p, const CharlieContyKullaView *w, Dir o, float u,
                                  float v) {
    return charlie_sample(p->d, w->side, o, u, v);
}
