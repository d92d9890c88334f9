/* solver_reference.h - the solver's results for a fit: multiple scattering between pairs of directions */
#pragma once

#include <stdbool.h>

#include "fibre/slab.h"

/* One slab. Directions, the "sides" of pairs, are numbered; w is their weight in an average over the hemisphere by
 * dmu dphi / (2 pi), so that  R_i = 2 pi sum over pairs of f w_j mu_j share. */
typedef struct SolvedSlab {
    Slab slab;
    double tilt; /* radians, towards azimuth 0 */
    int sides, pairs;
    const double *mu, *phi, *w; /* [sides]; phi is 0 if the fibres are upright */
    const double *nu;           /* [sides]: cosine to the fibre */
    const int *i, *j;           /* [pairs], i <= j */
    const double *delta_phi;    /* [pairs]: azimuth of j minus phi_j; for tilted fibres 0, or -2 phi_j: mirrored */
    const double *x;            /* [pairs]: wi . wo - nu_i nu_o */
    const double *share;        /* [pairs]: 1 / (pairs of the same directions) */
    double *f;                  /* [pairs]: multiple scattering, 1/sr */
    const double *white;        /* [pairs]: f of the last albedo in the grid */
    double *reflected;          /* [sides]: R, single scattering included */
} SolvedSlab;

/* Slabs over the same directions. */
typedef struct SolvedSet {
    int count;
    SolvedSlab *slabs;
    double *block; /* storage of their doubles, */
    int *numbers;  /* and of their integers */
} SolvedSet;

/* The grid to solve: every combination of alphas, albedos, depths (`depth` divided by 2^(kept - 1) .. 1), and of tilts
 * if there are any. `rings` cosines are by a Gauss rule in sqrt(mu). `spokes` counts azimuths of tilted fibres, or
 * angles between azimuths of upright ones. */
typedef struct SolvedGrid {
    int alphas, albedos, tilts, kept, rings, spokes;
    const double *alpha, *albedo, *tilt;
    double depth;
} SolvedGrid;

/* Reports that `done` of `all` parts are done; false stops the work. */
typedef bool (*SolveProgress)(void *user, int done, int all);

/* Solves the grid. Returns false if memory is short or progress stops it; the set is then empty. threads: 0 for all
 * processors. */
bool solved_set_make(const SolvedGrid *grid, int threads, SolveProgress progress, void *user, SolvedSet *out);
void solved_set_free(SolvedSet *set);

/* Gives the two directions of a pair, unit vectors. */
void solved_pair(const SolvedSlab *reference, int pair, double wi[3], double wo[3]);

/* Returns f of single scattering for a pair, exact, 1/sr. */
double solved_single_scatter(const SolvedSlab *reference, int pair);

/* The error of a fit. That of a direction with R > 1e-3 is the integral of |f - f_true| mu over R. */
typedef struct FitError {
    double mean;   /* of the directions, by dmu */
    double worst;  /* of the directions */
    double albedo; /* largest error of R in any direction */
    double most;   /* largest R of the fit */
} FitError;

/* Computes the error of f[pairs], multiple scattering. Returns false if memory is short. */
bool solved_error(const SolvedSlab *reference, const double *f, FitError *out);

/* Returns the weight of a pair in the integral of f mu for its first direction. */
double solved_weight_i(const SolvedSlab *reference, int pair);

/* Returns the same for its second direction; 0 if they are the same. */
double solved_weight_j(const SolvedSlab *reference, int pair);
