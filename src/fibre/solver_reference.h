/* solver_reference.h - the solver's answers as a fit sees them: light scattered more than once, between pairs of
 * directions */
#ifndef WEFT_FIBRE_SOLVER_REFERENCE_H
#define WEFT_FIBRE_SOLVER_REFERENCE_H

#include <stdbool.h>

#include "fibre/slab.h"

/* One slab. Directions, "sides" of a pair, are numbered; w is what one counts for in an average over the
 * hemisphere by dmu dphi / (2 pi), so that  R_i = 2 pi sum over pairs of f w_j mu_j share. */
typedef struct SolvedSlab {
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
} SolvedSlab;

/* Slabs over the same directions. */
typedef struct SolvedSet {
    int count;
    SolvedSlab *slabs;
    double *block; /* all that they point to */
    int *numbers;
} SolvedSet;

/* The grid to solve: every combination of alphas, depths (the last divided by 2^(kept - 1) .. 1), albedos,
 * and, where tilts is not 0, tilts; `rings` cosines by a Gauss rule in sqrt(mu), and `spokes` azimuths where
 * fibres lean, or angles between azimuths where they do not. */
typedef struct SolvedGrid {
    int alphas, albedos, tilts, kept, rings, spokes;
    const double *alpha, *albedo, *tilt;
    double depth;
} SolvedGrid;

/* Called as slabs are done; false stops the work. */
typedef bool (*SolveProgress)(void *user, int done, int all);

/* False where memory is short or progress says so; the set is then empty. threads: 0 for all processors. */
bool solved_set_make(const SolvedGrid *grid, int threads, SolveProgress progress, void *user, SolvedSet *out);
void solved_set_free(SolvedSet *set);

/* The two directions of a pair, unit vectors. */
void solved_pair(const SolvedSlab *reference, int pair, double wi[3], double wo[3]);

/* f of the same pair, scattered once: exact, 1/sr. */
double solved_single_scatter(const SolvedSlab *reference, int pair);

/* The error of f[pairs], light scattered more than once: integral of |f - f_true| mu over R for the
 * directions with R > 1e-3, its mean by dmu and its largest; the largest error of R in any direction, and the
 * largest R with this f. False where memory is short. */
typedef struct FitError {
    double mean, worst, albedo, most;
} FitError;
bool solved_error(const SolvedSlab *reference, const double *f, FitError *out);

/* Return the weight of a pair in the integral of f mu of its first, or second, direction. */
double solved_weight_i(const SolvedSlab *reference, int pair);
double solved_weight_j(const SolvedSlab *reference, int pair);

#endif
