/* distribution.h - random choice of one of n things with given weights, by inversion
 *
 * Well-spread u give well-spread choices. The cumulative weights are the leaves of a tree in which every node has
 * sixteen children: a search compares sixteen numbers a level and never branches on them. */
#pragma once

#include <stddef.h>
#include <string.h>

#include "base/memory.h"

#define DISTRIBUTION_FAN    16
#define DISTRIBUTION_LEVELS 8 /* 16^7 < INT_MAX < 16^8 */

typedef struct Distribution {
    int n, levels;
    int first[DISTRIBUTION_LEVELS]; /* index in ends of each level, the leaves at first */
    const float *ends;              /* cumulative weight with a leaf, or with the last child of a node; ends[-1] is 0 */
} Distribution;

/* Returns the number of floats that distribution_make needs for n >= 1 things. */
size_t distribution_size(int n);

/* Returns so many floats from the arena, on cache lines as groups of children need them; NULL if memory is short. */
float *distribution_alloc(Arena *arena, size_t floats);

/* Makes the distribution of n weights >= 0 and returns their sum. If it is 0, all things are equally likely. storage:
 * distribution_size(n) floats, which stay the caller's. */
double distribution_make(Distribution *distribution, int n, const float *weights, float *storage);

/* Returns the distribution of the same size that lies so many floats further on. */
static inline Distribution distribution_offset(Distribution distribution, size_t floats) {
    distribution.ends += floats;
    return distribution;
}

/* A thing chosen with u. */
typedef struct Choice {
    int index;
    float probability;
    float rest; /* position of u within the thing's interval, uniform in [0, 1) */
} Choice;

/* Returns the number of children that end at or before u. They are compared four at a time. */
static inline int distribution_count(const float *children, float u) {
    typedef float Four __attribute__((vector_size(16)));
    typedef int Counts __attribute__((vector_size(16)));
    Counts count = {0}; /* true is -1 */
    for (int k = 0; k < DISTRIBUTION_FAN; k += 4) {
        Four ends;
        memcpy(&ends, children + k, sizeof ends);
        count -= ends <= (Four){u, u, u, u};
    }
    return count[0] + count[1] + count[2] + count[3];
}

/* Chooses a thing with u in [0, 1). */
static inline Choice distribution_choose(const Distribution *distribution, float u) {
    int k = 0;
    for (int level = distribution->levels - 1; level >= 0; level--) {
        const float *children = distribution->ends + distribution->first[level] + DISTRIBUTION_FAN * k;
        k = DISTRIBUTION_FAN * k + distribution_count(children, u);
    }
    float begin = distribution->ends[k - 1], width = distribution->ends[k] - begin, rest = (u - begin) / width;
    return (Choice){k, width, rest < 0x1.fffffep-1f ? rest : 0x1.fffffep-1f};
}

static inline float distribution_probability(const Distribution *distribution, int k) {
    return distribution->ends[k] - distribution->ends[k - 1];
}
