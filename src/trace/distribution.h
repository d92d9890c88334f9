/* distribution.h - choosing one of n things with given weights */
#ifndef WEFT_TRACE_DISTRIBUTION_H
#define WEFT_TRACE_DISTRIBUTION_H

/* cdf[0 .. n]: cumulative weights, cdf[0] = 0, cdf[n] = 1. */

/* Turns n weights >= 0 in cdf[1 .. n] into the cumulative form and returns their sum. A sum of 0 gives equal
 * shares. */
double distribution_make(float *cdf, int n);

typedef struct Choice {
    int index;
    float probability;
    float rest; /* what is left of u, uniform in [0, 1) again */
} Choice;

/* By inversion, so that well-spread u give well-spread choices. */
Choice distribution_choose(const float *cdf, int n, float u);

#endif
