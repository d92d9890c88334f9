#include "trace/distribution.h"

double distribution_make(Distribution *distribution, int n, float *cdf, uint32_t *guide) {
    double sum = 0.0, running = 0.0;
    for (int k = 1; k <= n; k++) sum += (double)cdf[k];
    cdf[0] = 0.0f;
    for (int k = 1; k <= n; k++) {
        running += sum > 0.0 ? (double)cdf[k] / sum : 1.0 / n;
        cdf[k] = (float)running;
    }
    /* from the last thing with any weight on, exactly 1, so that no u < 1 finds one without */
    float last = cdf[n];
    for (int k = n; k > 0 && !(cdf[k] < last); k--) cdf[k] = 1.0f;
    uint32_t k = 0;
    for (int step = 0; step < n; step++) {
        /* u * n may round up across a step: one before is safe */
        float u = (float)step / (float)n * (1.0f - 0x1p-22f);
        while (cdf[k + 1] <= u) k++;
        guide[step] = k;
    }
    *distribution = (Distribution){n, cdf, guide};
    return sum;
}
