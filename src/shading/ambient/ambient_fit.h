/* ambient_fit.h - makes the table of any lobe for ambient_table.h, from its eval and its sampler */
#ifndef WEFT_SHADING_AMBIENT_FIT_H
#define WEFT_SHADING_AMBIENT_FIT_H

#include "shading/ambient/ambient_lobe.h"

enum { AMBIENT_COLUMNS = 24, AMBIENT_ROWS = 16 };

/* The planes of ambient_table.h over cos_o and one parameter. */
typedef struct AmbientFit {
    Lobe lobe; /* parameter 0 is not used */
    int rows;
    float low, high; /* the range asked for */
    float root_low, root_high;
    float finest; /* the greatest log2 kappa */
    float denser; /* mean, weighted by reflected light, of log2(density of this lobe / density of a
                   * single-axis lobe of the same width) */
    bool turning; /* there are planes for AMBIENT_HEADINGS headings */
    float texels[AMBIENT_HEADINGS * AMBIENT_PLANES * AMBIENT_ROWS][AMBIENT_COLUMNS];
} AmbientFit;

/* Fills the table of a lobe whose parameter 0 varies from low to high; if these are equal, the table has one
 * row. The other parameters are as given. The weights w_k are those for which sum_k w_k G_k is closest to
 * f cos_i under environments of typical spatial correlation (ambient_fit.c); G_k is the filter of look-up
 * k (the table in ambient_lobe.h). Lobes with TRAIT_REFERENCE have no table. Uses `threads` threads, 0 for
 * all; their number does not change the result. */
void ambient_fit(AmbientFit *fit, const Lobe *lobe, float low, float high, int threads);

/* These serve a fit whose texels come from a cache. ambient_fit_shape sets lobe, ranges, roots, rows and
 * turning; then ambient_fit_finish derives finest and denser from the texels. */
void ambient_fit_shape(AmbientFit *fit, const Lobe *lobe, float low, float high);
void ambient_fit_finish(AmbientFit *fit);

/* Returns the parameter that says where the fibres of a lobe lean, by which a stack turns what is fitted, so that no
 * table depends on it; -1 if there is none. Yarns have an azimuth too, which belongs to what is fitted. */
int ambient_lean_azimuth(int lobe);

/* Returns true if the lobes have the same id and the same parameters apart from azimuth, so that one one-row
 * fit serves both. */
bool ambient_alike(const Lobe *a, const Lobe *b);

/* Returns true if this is the fit of that lobe for parameter 0 over low .. high. */
bool ambient_fit_serves(const AmbientFit *fit, const Lobe *lobe, float low, float high);

/* Returns the table as ambient_lobe.h reads it, not baked. Its texels belong to the fit. */
AmbientTable ambient_table(const AmbientFit *fit, int strategy);

/* Computes the polynomials of a fit of one row, by least squares over its nodes. */
void ambient_bake(const AmbientFit *fit, AmbientWeights out[AMBIENT_BAKED]);

/* A lobe whose `denser` exceeds this is a ring or a streak, which one axis and one width describe badly. */
#define AMBIENT_DENSER 2.5f

/* Returns the strategy with the least error for a lobe (docs/environment.md). turning: the lobe depends on azimuth.
 * dense: its `denser` exceeds AMBIENT_DENSER. */
int ambient_strategy(int lobe, bool turning, bool dense);

#endif
