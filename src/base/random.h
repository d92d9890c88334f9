/* random.h - counter-based random numbers: a value is a function of its key, so order and threads do not
 * matter */
#ifndef WEFT_BASE_RANDOM_H
#define WEFT_BASE_RANDOM_H

#include <stdint.h>

/* A bijective mix of 32 bits with low bias: the two-round "lowbias32" of Chris Wellons, "Hash Prospector",
 * 2018. */
static inline uint32_t hash32(uint32_t x) {
    x ^= x >> 16;
    x *= 0x7feb352du;
    x ^= x >> 15;
    x *= 0x846ca68bu;
    x ^= x >> 16;
    return x;
}

static inline uint32_t hash_combine(uint32_t a, uint32_t b) {
    return hash32(a ^ (b * 0x9e3779b9u + 0x85ebca6bu));
}

/* 24 bits of x as a float in [0, 1). */
static inline float unit_float(uint32_t x) { return (float)(x >> 8) * 0x1p-24f; }

#endif
