/* charlie-khronos - velvet as the glTF sample viewer draws it: charlie-conty-kulla cut off at its brightest
 *
 *   f = color D(h) min(V(wo, wi), 1)                                                            [1/sr]
 *
 *   D: term d_charlie.  V: term v_conty_kulla.
 *   Alejandro Conty Estevez, Christopher Kulla, "Production Friendly Microfacet Sheen BRDF", SIGGRAPH 2017
 *     course. The clamp to [0, 1] is in V_Sheen of brdf.glsl of the glTF sample viewer (Khronos Group,
 *     2020), not in the text of KHR_materials_sheen.
 *   roughness: alpha = roughness^2 (KHR_materials_sheen).
 *   reciprocal: yes.
 *   energy: no, E passes 1 near grazing for alpha < 0.035: at cos_o 0.005 it is 1.41 at alpha 0.01. Below
 *     cos_o 1e-5 it does so at 0.05 too.
 *   sampling: half by D, half uniform.
 *   measured by weft check charlie-khronos: E at most 1.41 (alpha 0.01, cos_o 0.005);
 *     reciprocal to 1e-3; weight variance 0.42 of the cosine's;
 *     half precision: finite for any cosines. */
#pragma once

#include "shading/lobe/lobe.h"
#include "shading/terms/d_charlie.h"
#include "shading/terms/v_conty_kulla.h"

#define CHARLIE_KHRONOS_PARAMS(P)                                                                                      \
    P(float, alpha, 0.25f, 0.01f, 1.0f, 0.005f, 1.0f, "width of the fibres' spread; low is a thin rim")
#define CHARLIE_KHRONOS_TRAITS TRAIT_RECIPROCAL

STRUCT(CharlieKhronos){CHARLIE_KHRONOS_PARAMS(FIELD)};

STRUCT(CharlieKhronosPrepared) {
    Charlie d;
    ContyKulla shadow;
};
FN void charlie_khronos_prepare(CharlieKhronos m, CharlieKhronosPrepared *p) {
    p->d = charlie_of(m.alpha);
    p->shadow = conty_kulla_of(m.alpha);
}

STRUCT(CharlieKhronosView) {
    CharlieSide side;
    float lambda;
};
FN void charlie_khronos_view(const CharlieKhronosPrepared *p, Dir o, CharlieKhronosView *w) {
    w->side = charlie_side(o);
    w->lambda = conty_kulla_lambda(p->shadow, o.z);
}

FN LobeValue charlie_khronos_value(const CharlieKhronosPrepared *p, const CharlieKhronosView *w, Angles a) {
    float d = charlie_d_sin2(p->d, a.sin2_h), lambda = w->lambda + conty_kulla_lambda(p->shadow, a.i.z);
    /* not the term's own V, whose floor under cos_o cos_i the clamp makes needless */
    float visibility = min(1.0f / max((1.0f + lambda) * 4.0f * a.o.z * a.i.z, 1e-30f), 1.0f);
    return lobe_value_of(d * visibility, 0.0f, charlie_pdf(d, w->side, a));
}
/* Returns the cosine of wi below which the clamp applies: V falls as the cosine rises. */
FN float charlie_khronos_crease(CharlieKhronos m, float cos_o, int k) {
    ContyKulla shadow = conty_kulla_of(m.alpha);
    float low = 0.0f, high = 1.0f, lambda = conty_kulla_lambda(shadow, cos_o);
    for (int step = 0; step < 32; step++) {
        float c = 0.5f * (low + high);
        bool clamped = 4.0f * (1.0f + lambda + conty_kulla_lambda(shadow, c)) * cos_o * c < 1.0f;
        low = clamped ? c : low;
        high = clamped ? high : c;
    }
    return k == 0 && high < 1.0f ? high : 0.0f;
}
FN Dir charlie_khronos_sample(const CharlieKhronosPrepared *p, const CharlieKhronosView *w, Dir o, float u, float v) {
    return charlie_sample(p->d, w->side, o, u, v);
}
