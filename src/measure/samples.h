/* samples.h - f at many pairs of directions, which something else is to come close to
 *
 * The metrics and their formulas are in weft/match.h. Everything here is in x = f cos_i. */
#ifndef WEFT_MEASURE_SAMPLES_H
#define WEFT_MEASURE_SAMPLES_H

#include <stdbool.h>

#include "weft/match.h"

typedef struct Samples {
    int count;
    int outs;           /* > 0: sample k has direction wo number k % outs; 0: each its own */
    int first;          /* samples [0, first) stand for all where that is enough */
    int channels;       /* 3, or 1 where the others are the same */
    float *o[3], *i[3]; /* unit vectors, above the horizon */
    float *weight;
    float *x[3];    /* what is to be met */
    float *goal[3]; /* g of it */
    WeftBrdfMetric metric;
    float scale;     /* the m of LOG */
    double whole[2]; /* what is below the line: of `first` samples, of all */
    float *block;
} Samples;

/* Room for count samples, all zero. False where memory is short; release with samples_free in any case. */
bool samples_create(Samples *samples, int count, WeftBrdfMetric metric);
void samples_free(Samples *samples);

/* The directions and weights that the metric is defined by. */
bool samples_spread(Samples *samples, WeftBrdfMetric metric);

/* Fills x with a reflection's. */
void samples_ask(const Samples *samples, const WeftReflection *reflection, int part, float *const x[3]);

/* Returns true if the reflection is isotropic. */
bool samples_isotropic(const Samples *samples, const WeftReflection *reflection);

/* To be called when directions, weights and x are there, before all that follows. */
void samples_finish(Samples *samples);

/* g(x). */
float samples_goal(const Samples *samples, float x);

/* The error of x over the first count samples: `first` or all of them. */
double samples_distance(const Samples *samples, int count, const float *const x[3]);

/* Sums of columns whose weights are not negative, in each channel by itself. */
enum { BLEND_MOST = 4 };
typedef struct Blend {
    int columns;
    const float *column[BLEND_MOST][3]; /* x of column number so in each channel */
    const float *fixed[3];              /* and what is there without them; NULL: nothing */
    float *work;                        /* 3 count floats */
} Blend;

/* The weights that make the error of channel c least over the first count samples, and what that adds to the
 * error. Least weighted absolute differences by least squares, weighed anew some times: Peter J. Green,
 * "Iteratively Reweighted Least Squares for Maximum Likelihood Estimation, and Some Robust and Resistant
 * Alternatives", Journal of the Royal Statistical Society B 46(2), 1984. */
double blend_solve(const Samples *samples, int count, int c, const Blend *blend, double weights[BLEND_MOST]);

#endif
