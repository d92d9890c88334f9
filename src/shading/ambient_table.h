/* ambient_table.h - tables of any lobe for ambient.h, made from its eval and its sampler */
#ifndef WEFT_SHADING_AMBIENT_TABLE_H
#define WEFT_SHADING_AMBIENT_TABLE_H

#include "shading/ambient.h"

enum { AMBIENT_COLUMNS = 24, AMBIENT_ROWS = 16, AMBIENT_SIDES = 3 };

/* The planes of ambient.h over cos_o and one parameter. */
typedef struct AmbientFit {
    Lobe lobe; /* parameter 0 is not used */
    int rows;
    float low, high; /* the range asked for */
    float root_low, root_high;
    float finest; /* the greatest log2 kappa */
    float denser; /* mean over its light of log2 of how much denser it is than lobes as wide about one axis */
    bool turning; /* there are planes for AMBIENT_SIDES headings */
    float texels[AMBIENT_SIDES * AMBIENT_PLANES * AMBIENT_ROWS][AMBIENT_COLUMNS];
} AmbientFit;

/* Fills the table for a lobe as its parameter 0 runs over low .. high (equal: one row), the others as given:
 * the weights that bring sum_k w_k G_k nearest to f cos_i, both convolved with what an environment's two
 * points have in common (the source says what that is). Not for lobes with TRAIT_REFERENCE. Runs on `threads`
 * threads (0: all); the same numbers on any number of them. */
void ambient_fit(AmbientFit *fit, const Lobe *lobe, float low, float high, int threads);

/* Completes a fit whose texels were cached: sets all other members. */
void ambient_fit_shape(AmbientFit *fit, const Lobe *lobe, float low, float high);
void ambient_fit_finish(AmbientFit *fit);

/* Returns true if one fit for a single value of parameter 0 serves both lobes. */
bool ambient_alike(const Lobe *a, const Lobe *b);

/* Returns true if this is the fit of that lobe for parameter 0 over low .. high. */
bool ambient_fit_serves(const AmbientFit *fit, const Lobe *lobe, float low, float high);

/* The table for ambient.h to read, not baked; the fit must outlive it. */
AmbientTable ambient_table(const AmbientFit *fit, int strategy);

/* The polynomials of a fit of one row, by least squares over its nodes. */
void ambient_bake(const AmbientFit *fit, AmbientWeights out[AMBIENT_BAKED]);

/* A lobe that is so much denser than one as wide, log2 of it, is a ring or a streak: one axis and one width
 * say little of it. */
#define AMBIENT_DENSER 2.5f

/* The strategy with the least error for that lobe, with or without an azimuth that matters, and dense as
 * AMBIENT_DENSER has it or not (docs/environment.md). */
int ambient_strategy(int lobe, bool turning, bool dense);

#endif
