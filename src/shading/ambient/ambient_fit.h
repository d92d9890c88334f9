/* ambient_fit.h - makes the table of any lobe for ambient_table.h, from its eval and its sampler */
#pragma once

#include "shading/ambient/ambient_lobe.h"

enum { AMBIENT_COLUMNS = 24, AMBIENT_ROWS = 16 };

/* The planes of ambient_table.h over cos_o and parameter 0 of a lobe. */
typedef struct AmbientFit {
    Lobe lobe;       /* parameter 0 is not used */
    int rows;        /* AMBIENT_ROWS, or 1 if parameter 0 is constant */
    float low, high; /* the requested range of parameter 0 */
    float root_low;  /* square roots of the range that the lobe accepts */
    float root_high;
    float finest;    /* the greatest log2 kappa */
    float denser;    /* mean, weighted by reflected light, of log2(density of this lobe / density of a
                      * single-axis lobe of the same width) */
    bool by_azimuth; /* the lobe depends on azimuth: there are planes for AMBIENT_HEADINGS headings */
    float texels[AMBIENT_HEADINGS * AMBIENT_PLANES * AMBIENT_ROWS][AMBIENT_COLUMNS];
} AmbientFit;

/* Fills the table of a lobe whose parameter 0 varies from low to high; if these are equal, the table has one row. The
 * other parameters are those of the lobe. A lobe with TRAIT_REFERENCE has no table. Uses `threads` threads, 0 for all;
 * their number does not change the result. */
void ambient_fit(AmbientFit *fit, const Lobe *lobe, float low, float high, int threads);

/* A lobe of a mixture, and factors on its two colours. */
typedef struct AmbientPart {
    Lobe lobe;
    float first, second;
} AmbientPart;

/* Lobes with one id that stand side by side, such as the points of a cloth: a surface shows the mean of all. */
typedef struct AmbientMixture {
    int count;
    const AmbientPart *parts;
} AmbientMixture;

/* Fills a table of one row, by azimuth, for a mixture. More than 1,024 lobes are not all looked at from each
 * direction. fit->lobe becomes the first of them, fit->denser 0. */
void ambient_fit_mixture(AmbientFit *fit, const AmbientMixture *mixture, int threads);

/* Sets all members but texels, finest and denser, for a fit whose texels come from a cache. */
void ambient_fit_shape(AmbientFit *fit, const Lobe *lobe, float low, float high);

/* Sets finest and denser from the texels. */
void ambient_fit_finish(AmbientFit *fit);

/* Returns the index of the parameter with the azimuth of a lobe's leaning fibres, -1 if there is none. Tables are for
 * azimuth 0, and a stack rotates directions instead. The azimuth of yarns is no such parameter: their tables depend on
 * it. */
int ambient_lean_azimuth(int lobe);

/* Returns true if the lobes have the same id and the same parameters apart from that azimuth: one fit of one row
 * serves both. */
bool ambient_alike(const Lobe *a, const Lobe *b);

/* Returns true if this is the fit of that lobe for parameter 0 over low .. high. */
bool ambient_fit_serves(const AmbientFit *fit, const Lobe *lobe, float low, float high);

/* Returns the table as ambient_lobe.h reads it, not baked. Its texels belong to the fit. */
AmbientTable ambient_table(const AmbientFit *fit, int strategy);

/* Sets the polynomials of a fit of one row, by least squares over its nodes. */
void ambient_bake(const AmbientFit *fit, AmbientWeights out[AMBIENT_BAKED]);

/* A lobe whose AmbientFit.denser exceeds this is a ring or a streak, which one axis and one width describe badly. */
#define AMBIENT_DENSER 2.5f

/* Returns the strategy with the least error for a lobe (docs/environment.md). by_azimuth, dense: the lobe depends on
 * azimuth, and its AmbientFit.denser exceeds AMBIENT_DENSER. */
int ambient_strategy(int lobe, bool by_azimuth, bool dense);
