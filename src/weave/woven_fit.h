/* woven_fit.h - lobe woven of one system of a cloth, fitted to what points of its threads reflect */
#pragma once

#include "shading/weave/weave_light.h"

/* The largest parameters of lobe woven. */
#define ROUNDNESS_MOST 1.5f
#define CRIMP_MOST     2.5f /* a tangent */
#define FLOATS_MOST    16.0f

enum { LIT_PAIRS = 144 };

/* Pairs of directions, and f cos_i of each pair: of light that met one fibre (single), and of all other light. */
typedef struct Lit {
    float o[3][LIT_PAIRS], i[3][LIT_PAIRS];
    double single[LIT_PAIRS], multiple[LIT_PAIRS];
} Lit;

/* Sets the pairs, evenly spread, and no light. */
void lit_start(Lit *lit);

/* f cos_i of one lobe. */
typedef struct PairsLit {
    float single[LIT_PAIRS], multiple[LIT_PAIRS];
} PairsLit;

/* A loop over the pairs for a prepared lobe p. */
#define EACH_LIT(name, Name)                                                                                           \
    for (int k = 0; k < LIT_PAIRS; k++) {                                                                              \
        const Dir o = {lit->o[0][k], lit->o[1][k], lit->o[2][k]};                                                      \
        const Dir i = {lit->i[0][k], lit->i[1][k], lit->i[2][k]};                                                      \
        Name##View w;                                                                                                  \
        name##_view(&p, o, &w);                                                                                        \
        const LobeValue v = name##_value(&p, &w, angles_between(o, i));                                                \
        out->single[k] = v.f * i.z * (1.0f - v.s);                                                                     \
        out->multiple[k] = v.f * i.z * v.s;                                                                            \
    }

/* Adds the light of pairs, each kind times its factor. */
void lit_add(Lit *lit, const PairsLit *pairs, double single, double multiple);

/* Returns the sum over the pairs. */
double lit_sum(const double values[LIT_PAIRS]);

/* Fits the lobe of one system of m to `near`, what its points reflect. The WeaveFar of the system contains the moments
 * of the points; its alpha, crimp, roundness and floats become those of the fit. Sets woven to the prepared lobe, and
 * returns what it reflects between the pairs. If the search fails, as it does where memory is short, the lobe is that
 * of the moments. */
Lit woven_fit(Weave *m, bool weft, const Lit *near, WovenPrepared *woven);
