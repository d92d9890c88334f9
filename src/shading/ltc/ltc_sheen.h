/* ltc_sheen.h - a sheen that is one linearly transformed cosine D times its albedo R:  f = R D / cos_i */
#ifndef WEFT_SHADING_LTC_SHEEN_H
#define WEFT_SHADING_LTC_SHEEN_H

#include "shading/lobe/lobe.h"
#include "shading/ltc/ltc_table.h"

FN LobeValue ltc_sheen_value(Ltc m, float reflected, Angles a) {
    Dir v = ltc_inverse(m, a.o, a.i);
    float r2 = max(dir_dot(v, v), 1e-18f); /* keeps its square a normal number */
    return lobe_value_of(reflected * m.z * m.det / (PI * r2 * r2), 0.0f, ltc_pdf(m, a.o, a.i));
}

/* Defines a lobe that is such a sheen by its parameter alpha. look_up: its LtcLobe for p and o. */
#define LTC_SHEEN(name, Name, look_up)                                                                       \
    PREPARED_AS_IT_IS(name, Name)                                                                            \
    STRUCT(Name##View) {                                                                                     \
        Ltc ltc;                                                                                             \
        float r;                                                                                             \
    };                                                                                                       \
    FN void name##_view(const Name##Prepared *p, Dir o, Name##View *w) {                                     \
        LtcLobe at = look_up;                                                                                \
        w->ltc = at.m;                                                                                       \
        w->r = min(at.f0, 1.0f);                                                                             \
    }                                                                                                        \
    FN LobeValue name##_value(const Name##Prepared *p, const Name##View *w, Angles a) {                      \
        return ltc_sheen_value(w->ltc, w->r, a);                                                             \
    }                                                                                                        \
    FN Dir name##_sample(const Name##Prepared *p, const Name##View *w, Dir o, float u, float v) {            \
        return ltc_sample(w->ltc, o, u, v);                                                                  \
    }

#endif
