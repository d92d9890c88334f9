/* blend.h - non-negative weights of sums of columns that come closest to samples, separately in each channel, and, if
 * asked, within limits on other sums of the weights */
#pragma once

#include "measure/fit/samples.h"

enum { BLEND_MOST = 4, BLEND_LIMITS = 10 };
typedef struct Blend {
    int columns;
    const float *column[BLEND_MOST][3]; /* [column][channel]: x of the samples */
    const float *fixed[3];              /* [channel]: x without any column; NULL: 0 */
    int limits;                         /* sum over columns of limit[l][column] weight <= room[l][channel] */
    double limit[BLEND_LIMITS][BLEND_MOST], room[BLEND_LIMITS][3]; /* none below 0 */
    float *work;                                                   /* scratch of 3 count floats */
} Blend;

/* Finds the weights that make the error of channel c least over the first count samples, and returns what
 * that channel adds to the error. Minimises weighted absolute differences by iteratively reweighted least
 * squares: Peter J. Green, "Iteratively Reweighted Least Squares for Maximum Likelihood Estimation, and Some
 * Robust and Resistant Alternatives", Journal of the Royal Statistical Society B 46(2), 1984. */
double blend_solve(const Samples *samples, int count, int c, const Blend *blend, double weights[BLEND_MOST]);
