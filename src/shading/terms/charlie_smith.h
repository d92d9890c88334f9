/* charlie_smith - what the lobes of d_charlie with the shadowing v_conty_kulla prepare, view and sample alike */
#ifndef WEFT_CHARLIE_SMITH_H
#define WEFT_CHARLIE_SMITH_H

#include "shading/terms/d_charlie.h"
#include "shading/terms/v_conty_kulla.h"

#define CHARLIE_SMITH(name, Name)                                                                            \
    STRUCT(Name##Prepared) {                                                                                 \
        Charlie d;                                                                                           \
        ContyKulla shadow;                                                                                   \
    };                                                                                                       \
    FN void name##_prepare(Name m, Name##Prepared *p) {                                                      \
        p->d = charlie_of(m.alpha);                                                                          \
        p->shadow = conty_kulla_of(m.alpha);                                                                 \
    }                                                                                                        \
    STRUCT(Name##View) {                                                                                     \
        CharlieSide side;                                                                                    \
        float lambda;                                                                                        \
    };                                                                                                       \
    FN void name##_view(const Name##Prepared *p, Dir o, Name##View *w) {                                     \
        w->side = charlie_side(o);                                                                           \
        w->lambda = conty_kulla_lambda(p->shadow, o.z);                                                      \
    }                                                                                                        \
    FN Dir name##_sample(const Name##Prepared *p, const Name##View *w, Dir o, float u, float v) {            \
        return charlie_sample(p->d, w->side, o, u, v);                                                       \
    }

#endif
