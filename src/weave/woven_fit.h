/* woven_fit.h - lobe woven of one system of a cloth, fitted to what points of its threads reflect */
#ifndef WEFT_WEAVE_WOVEN_FIT_H
#define WEFT_WEAVE_WOVEN_FIT_H

#include "shading/weave/weave_light.h"

/* The ends of the numbers of lobe woven; the crimp is a tangent. */
#define ROUNDNESS_MOST 1.5f
#define CRIMP_MOST     2.5f
#define FLOATS_MOST    16.0f

enum { LIT_PAIRS = 144 };

/* Pairs of directions, and what is reflected between them of light that met one fibre, and of all other, times the cosine. */
typedef struct Lit {
    float o[3][LIT_PAIRS], i[3][LIT_PAIRS];
    double once[LIT_PAIRS], again[LIT_PAIRS];
} Lit;

/* Sets the pairs, evenly spread as cloth_far.c spreads places, between which nothing is reflected yet. */
void lit_start(Lit *lit);

/* Light of both kinds between each pair, times the cosine. */
typedef struct PairsLit {
    float once[LIT_PAIRS], again[LIT_PAIRS];
} PairsLit;

/* A loop over the pairs for p, a lobe that was prepared. */
#define EACH_LIT(name, Name)                                                                                 \
    for (int k = 0; k < LIT_PAIRS; k++) {                                                                    \
        const Dir o = {lit->o[0][k], lit->o[1][k], lit->o[2][k]};                                            \
        const Dir i = {lit->i[0][k], lit->i[1][k], lit->i[2][k]};                                            \
        Name##View w;                                                                                        \
        name##_view(&p, o, &w);                                                                              \
        const LobeValue v = name##_value(&p, &w, angles_between(o, i));                                      \
        out->once[k] = v.f * i.z * (1.0f - v.s);                                                             \
        out->again[k] = v.f * i.z * v.s;                                                                     \
    }

/* Adds the light of pairs, of either kind by a factor. */
void lit_add(Lit *lit, const PairsLit *pairs, double once, double again);

/* Returns the sum over the pairs. */
double lit_sum(const double values[LIT_PAIRS]);

/* Fits the lobe of one system of m to what its points reflect, `near`: alpha, crimp, roundness and floats of that system's
 * WeaveFar, which says what moments of the points are, and what woven_fit.c says. woven is the lobe, prepared. Returns what
 * it reflects between the pairs. Where the search fails, as it does where memory is short, that is the lobe of the moments. */
Lit woven_fit(Weave *m, bool weft, const Lit *near, WovenPrepared *woven);

#endif
