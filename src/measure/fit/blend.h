/* blend.h - sums of columns whose weights are not negative, as near to samples as can be, in each channel by itself */
#ifndef WEFT_MEASURE_BLEND_H
#define WEFT_MEASURE_BLEND_H

#include "measure/fit/samples.h"

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
