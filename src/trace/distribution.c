#include "trace/distribution.h"

#include <stdint.h>

enum { LINE = 64 };

static int padded(int n) { return (n + DISTRIBUTION_FAN - 1) / DISTRIBUTION_FAN * DISTRIBUTION_FAN; }

/* The levels above n leaves; returns their floats together. */
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

float *distribution_room(Arena *arena, size_t floats) {
    char *block = arena_array(arena, floats + LINE / sizeof(float), sizeof(float));
    return block ? (float *)(void *)(block + (LINE - (uintptr_t)block % LINE) % LINE) : NULL;
}

/* From the last thing with any weight on, exactly 1, so that no u < 1 finds one without; past the end more
 * than any u. */
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
    for (int k = 0; k < padded(n); k++)
        nodes[k] = k < n ? children[DISTRIBUTION_FAN * k + DISTRIBUTION_FAN - 1] : 2.0f;
}

double distribution_make(Distribution *distribution, int n, const float *weights, float *room) {
    double sum = 0.0;
    for (int k = 0; k < n; k++) sum += (double)weights[k];
    lay_out(distribution, n);
    float *ends =
        room + DISTRIBUTION_FAN; /* what lies before the first leaf keeps groups on lines of memory */
    for (int k = 0; k < DISTRIBUTION_FAN; k++) room[k] = 0.0f;
    fill_leaves(ends, n, weights, sum);
    for (int level = 1; level < distribution->levels; level++) {
        n = padded(n) / DISTRIBUTION_FAN;
        fill_nodes(ends + distribution->first[level], n, ends + distribution->first[level - 1]);
    }
    distribution->ends = ends;
    return sum;
}
