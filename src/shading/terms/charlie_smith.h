/* charlie_smith - the shared parts of lobes that join d_charlie and the shadowing v_conty_kulla
 *
 *   Alejandro Conty Estevez, Christopher Kulla, "Production Friendly Microfacet Sheen BRDF", SIGGRAPH 2017 course. */
#ifndef WEFT_CHARLIE_SMITH_H
#define WEFT_CHARLIE_SMITH_H

#include "shading/terms/d_charlie.h"
#include "shading/terms/v_conty_kulla.h"

/* Defines what such a lobe prepares and views, and its sampling. Name: its record, with the member alpha. */
#define CHARLIE_SMITH(Name, Prepared, View, prepare, view, sample)                                           \
    STRUCT(Prepared) {                                                                                       \
        Charlie d;                                                                                           \
        ContyKulla shadow;                                                                                   \
    };                                                                                                       \
    FN void prepare(Name m, Prepared *p) {                                                                   \
        p->d = charlie_of(m.alpha);                                                                          \
        p->shadow = conty_kulla_of(m.alpha);                                                                 \
    }                                                                                                        \
    STRUCT(View) {                                                                                           \
        CharlieSide side;                                                                                    \
        float lambda;                                                                                        \
    };                                                                                                       \
    FN void view(const Prepared *p, Dir o, View *w) {                                                        \
        w->side = charlie_side(o);                                                                           \
        w->lambda = conty_kulla_lambda(p->shadow, o.z);                                                      \
    }                                                                                                        \
    FN Dir sample(const Prepared *p, const View *w, Dir o, float u, float v) {                               \
        return charlie_sample(p->d, w->side, o, u, v);                                                       \
    }

#endif
