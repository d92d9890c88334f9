#include "trace/distribution.h"

#include <math.h>

double distribution_make(float *cdf, int n) {
    double sum = 0.0, running = 0.0;
    for (int k = 1; k <= n; k++) sum += (double)cdf[k];
    cdf[0] = 0.0f;
    for (int k = 1; k <= n; k++) {
        running += sum > 0.0 ? (double)cdf[k] / sum : 1.0 / n;
        cdf[k] = (float)running;
    }
    cdf[n] = 1.0f;
    return sum;
}

Choice distribution_choose(const float *cdf, int n, float u) {
    /* the last k with cdf[k] <= u, by halving without branches to predict */
    const float *base = cdf;
    for (int length = n; length > 1;) {
        int half = length / 2;
        base = base[half] <= u ? base + half : base;
        length -= half;
    }
    float width = base[1] - base[0];
    float rest = width > 0.0f ? (u - base[0]) / width : 0.0f;
    return (Choice){(int)(base - cdf), width, fminf(fmaxf(rest, 0.0f), 0x1.fffffep-1f)};
}
