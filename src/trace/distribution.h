/* distribution.h - choosing one of n things with given weights, by inversion: well-spread u give well-spread
 * choices */
#ifndef WEFT_TRACE_DISTRIBUTION_H
#define WEFT_TRACE_DISTRIBUTION_H

#include <stdint.h>

typedef struct Distribution {
    int n;
    float *cdf;      /* cumulative weights: cdf[0] = 0, cdf[n] = 1 */
    uint32_t *guide; /* for each of n equal steps of u, where the search begins; Chen, Asau 1974 */
} Distribution;

/* Turns n weights >= 0 in cdf[1 .. n] (n + 1 floats) into the distribution and returns their sum. guide takes
 * n integers. Both arrays stay the caller's. A sum of 0 gives equal shares. */
double distribution_make(Distribution *distribution, int n, float *cdf, uint32_t *guide);

typedef struct Choice {
    int index;
    float probability;
    float rest; /* what is left of u, uniform in [0, 1) again */
} Choice;

/* u in [0, 1). */
static inline Choice distribution_choose(const Distribution *distribution, float u) {
    const float *cdf = distribution->cdf;
    uint32_t k = distribution->guide[(int)(u * (float)distribution->n)];
    while (cdf[k + 1] <= u) k++;
    float width = cdf[k + 1] - cdf[k], rest = (u - cdf[k]) / width;
    return (Choice){(int)k, width, rest < 0x1.fffffep-1f ? rest : 0x1.fffffep-1f};
}

static inline float distribution_probability(const Distribution *distribution, int k) {
    return distribution->cdf[k + 1] - distribution->cdf[k];
}

#endif
