/* distribution.h - choosing one of n things with given weights, by inversion: well-spread u give well-spread
 * choices */
#ifndef WEFT_TRACE_DISTRIBUTION_H
#define WEFT_TRACE_DISTRIBUTION_H

#include <stdint.h>

typedef struct Step {
    float cdf;      /* cumulative weight of all things before this one: 0 at the first, 1 past the last */
    uint32_t guide; /* where the search begins for the u of this one of n equal parts; Chen, Asau 1974 */
} Step;

typedef struct Distribution {
    int n;
    Step *steps; /* n + 1 */
} Distribution;

/* Turns n weights >= 0 in steps[1 .. n].cdf into the distribution and returns their sum. The array (n + 1
 * entries) stays the caller's. A sum of 0 gives equal shares. */
double distribution_make(Distribution *distribution, int n, Step *steps);

typedef struct Choice {
    int index;
    float probability;
    float rest; /* what is left of u, uniform in [0, 1) again */
} Choice;

/* u in [0, 1). */
static inline Choice distribution_choose(const Distribution *distribution, float u) {
    const Step *step = &distribution->steps[distribution->steps[(int)(u * (float)distribution->n)].guide];
    while (step[1].cdf <= u) step++;
    float width = step[1].cdf - step[0].cdf, rest = (u - step[0].cdf) / width;
    return (Choice){(int)(step - distribution->steps), width, rest < 0x1.fffffep-1f ? rest : 0x1.fffffep-1f};
}

static inline float distribution_probability(const Distribution *distribution, int k) {
    return distribution->steps[k + 1].cdf - distribution->steps[k].cdf;
}

#endif
