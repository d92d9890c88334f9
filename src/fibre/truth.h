/* truth.h - the solver's answers as a fit sees them: light scattered more than once, between pairs of
 * directions */
#ifndef WEFT_FIBRE_TRUTH_H
#define WEFT_FIBRE_TRUTH_H

#include <stdbool.h>

#include "fibre/slab.h"

/* One slab. Directions, "sides" of a pair, are numbered; w is what one counts for in an average over the
 * hemisphere by dmu dphi / (2 pi), so that  R_i = 2 pi sum over pairs of f w_j mu_j share. */
typedef struct Truth {
    Slab slab;
    double tilt; /* radians, towards azimuth 0 */
    int sides, pairs;
    const double *mu, *phi, *w; /* [sides]; azimuths where fibres lean, else 0 */
    const double *nu;           /* [sides]: cosine to the fibre */
    const int *i, *j;           /* [pairs], i <= j */
    const double *turn;  /* [pairs]: azimuth of j less phi_j; where fibres lean, -2 phi_j: mirrored, or 0 */
    const double *x;     /* [pairs]: wi . wo - nu_i nu_o */
    const double *share; /* [pairs]: part of the turn about the normal */
    double *f;           /* [pairs]: scattered more than once, 1/sr */
    const double *white; /* [pairs]: the same of the last albedo in the grid */
    double *reflected;   /* [sides]: R, light scattered once included */
} Truth;

/* Slabs over the same directions. */
typedef struct TruthSet {
    int count;
    Truth *slabs;
    double *block; /* all that they point to */
    int *numbers;
} TruthSet;

/* What is asked for: every combination of alphas, depths (the last divided by 2^(kept - 1) .. 1), albedos,
 * and, where tilts is not 0, tilts; `rings` cosines by a Gauss rule in sqrt(mu), and `spokes` azimuths where
 * fibres lean, or angles between azimuths where they do not. */
typedef struct TruthGrid {
    int alphas, albedos, tilts, kept, rings, spokes;
    const double *alpha, *albedo, *tilt;
    double depth;
} TruthGrid;

/* Called as slabs are done; false stops the work. */
typedef bool (*TruthProgress)(void *user, int done, int all);

/* False where memory is short or progress says so; the set is then empty. threads: 0 for all processors. */
bool truth_make(const TruthGrid *grid, int threads, TruthProgress progress, void *user, TruthSet *out);
void truth_free(TruthSet *set);

/* The two directions of a pair, unit vectors. */
void truth_pair(const Truth *truth, int pair, double wi[3], double wo[3]);

/* f of the same pair, scattered once: exact, 1/sr. */
double truth_once(const Truth *truth, int pair);

/* How far f[pairs], scattered more than once, is off: integral of |f - f_true| mu over R for the directions
 * with R > 1e-3, its mean by dmu and its largest; the largest error of R in any direction, and the largest R
 * with this f. False where memory is short. */
typedef struct TruthError {
    double mean, worst, albedo, most;
} TruthError;
bool truth_error(const Truth *truth, const double *f, TruthError *out);

/* What a pair adds to the integral of one direction's f mu, per f. */
double truth_row_i(const Truth *truth, int pair);
double truth_row_j(const Truth *truth, int pair);

#endif
