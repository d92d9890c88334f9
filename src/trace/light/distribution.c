#include "trace/light/distribution.h"

#include <stdint.h>

enum { LINE = 64 }; /* bytes of a cache line */

static int padded(int n) { return (n + DISTRIBUTION_FAN - 1) / DISTRIBUTION_FAN * DISTRIBUTION_FAN; }

/* Fills the levels of a tree with n leaves; returns how many floats they need together. */
static int lay_out(Distribution *d, int n) {
    int size = 0;
    *d = (Distribution){.n = n};
    do {
        d->first[d->levels++] = size;
        size += padded(n);
        n = padded(n) / DISTRIBUTION_FAN;
    } while (n > 1);
    return size;
}

size_t distribution_size(int n) {
    Distribution d;
    return (size_t)lay_out(&d, n) + DISTRIBUTION_FAN;
}

float *distribution_alloc(Arena *arena, size_t floats) {
    char *block = arena_array(arena, floats + LINE / sizeof(float), sizeof(float));
    return block ? (float *)(void *)(block + (LINE - (uintptr_t)block % LINE) % LINE) : NULL;
}

/* Fills the cumulative weights. They are exactly 1 from the last thing with any weight on, so that no u < 1 finds one
 * without, and above any u past the end. */
static void fill_leaves(float *ends, int n, const float *weights, double sum) {
    double running = 0.0;
    for (int k = 0; k < n; k++) {
        running += sum > 0.0 ? (double)weights[k] / sum : 1.0 / n;
        ends[k] = (float)running;
    }
    float last = ends[n - 1];
    for (int k = n - 1; k >= 0 && !(ends[k] < last); k--) ends[k] = 1.0f;
    for (int k = n; k < padded(n); k++) ends[k] = 2.0f;
}

static void fill_nodes(float *nodes, int n, const float *children) {
    for (int k = 0; k < padded(n); k++) nodes[k] = k < n ? children[DISTRIBUTION_FAN * k + DISTRIBUTION_FAN - 1] : 2.0f;
}

double distribution_make(Distribution *distribution, int n, const float *weights, float *storage) {
    double sum = 0.0;
    for (int k = 0; k < n; k++) sum += (double)weights[k];
    lay_out(distribution, n);
    float *ends = storage + DISTRIBUTION_FAN; /* a 0 before the first leaf, with groups still on cache lines */
    for (int k = 0; k < DISTRIBUTION_FAN; k++) storage[k] = 0.0f;
    fill_leaves(ends, n, weights, sum);
    for (int level = 1; level < distribution->levels; level++) {
        n = padded(n) / DISTRIBUTION_FAN;
        fill_nodes(ends + distribution->first[level], n, ends + distribution->first[level - 1]);
    }
    distribution->ends = ends;
    return sum;
}
