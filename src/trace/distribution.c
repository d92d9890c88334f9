#include "trace/distribution.h"

double distribution_make(Distribution *distribution, int n, Step *steps) {
    double sum = 0.0, running = 0.0;
    for (int k = 1; k <= n; k++) sum += (double)steps[k].cdf;
    steps[0].cdf = 0.0f;
    for (int k = 1; k <= n; k++) {
        running += sum > 0.0 ? (double)steps[k].cdf / sum : 1.0 / n;
        steps[k].cdf = (float)running;
    }
    /* from the last thing with any weight on, exactly 1, so that no u < 1 finds one without */
    float last = steps[n].cdf;
    for (int k = n; k > 0 && !(steps[k].cdf < last); k--) steps[k].cdf = 1.0f;
    uint32_t k = 0;
    for (int part = 0; part < n; part++) {
        /* u * n may round up across a boundary: one before is safe */
        float u = (float)part / (float)n * (1.0f - 0x1p-22f);
        while (steps[k + 1].cdf <= u) k++;
        steps[part].guide = k;
    }
    *distribution = (Distribution){n, steps};
    return sum;
}
