/* sampler.h - Owen-scrambled Sobol points, padded two dimensions at a time
 *
 * Point i of a pixel is, in each pair of dimensions, the (0, 2)-sequence of Sobol', its order shuffled and
 * its digits scrambled by keys made from pixel, seed and pair. A value is a function of its key: threads and
 * order do not matter.
 *
 *   I. M. Sobol', "On the distribution of points in a cube and the approximate evaluation of integrals",
 * 1967. Brent Burley, "Practical Hash-based Owen Scrambling", JCGT 9(4), 2020. */
#ifndef WEFT_TRACE_SAMPLER_H
#define WEFT_TRACE_SAMPLER_H

#include <stdint.h>

#include "base/random.h"

typedef struct Sampler {
    uint32_t key;   /* of the pixel */
    uint32_t index; /* of the sample, bits reversed */
    uint32_t pair;  /* next pair of dimensions */
} Sampler;

typedef struct Point {
    float u, v; /* in [0, 1) */
} Point;

static inline uint32_t reverse_bits(uint32_t x) {
    x = __builtin_bswap32(x);
    x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
    x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
    return ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
}

/* A nested uniform scramble of digits stored lowest first: each bit is flipped by a hash of the bits below
 * it. Samuli Laine, Tero Karras, "Stratified Sampling for Stochastic Transparency", EGSR 2011, with the
 * constants found by Nathan Vegdahl, "Building a Better LK Hash", 2021. */
static inline uint32_t owen_scramble(uint32_t x, uint32_t key) {
    x ^= x * 0x3d20adeau;
    x += key;
    x *= (key >> 16) | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return x;
}

/* The second dimension's generator matrix is Pascal's triangle modulo 2, the fivefold Kronecker power of
 * [1 1; 0 1]: one step a level. */
static inline uint32_t pascal_bits(uint32_t i) {
    i ^= (i >> 1) & 0x55555555u;
    i ^= (i >> 2) & 0x33333333u;
    i ^= (i >> 4) & 0x0f0f0f0fu;
    i ^= (i >> 8) & 0x00ff00ffu;
    return i ^ (i >> 16);
}

static inline Sampler sampler_start(uint32_t x, uint32_t y, uint32_t seed, uint32_t sample) {
    return (Sampler){hash_combine(hash_combine(hash32(seed), x), y), reverse_bits(sample), 0};
}

/* The next pair of dimensions. */
static inline Point sampler_next(Sampler *sampler) {
    uint32_t key = hash32(sampler->key + 0x9e3779b9u * ++sampler->pair);
    uint32_t i = reverse_bits(owen_scramble(sampler->index, key));
    key = key * 0x2c1b3c6du + 0x297a2d39u;
    uint32_t x = reverse_bits(owen_scramble(i, key));
    key = key * 0x2c1b3c6du + 0x297a2d39u;
    uint32_t y = reverse_bits(owen_scramble(pascal_bits(i), key));
    return (Point){unit_float(x), unit_float(y)};
}

/* One plain random number that costs no dimension. */
static inline float sampler_random(Sampler *sampler) {
    return unit_float(hash32(sampler->key ^ hash32(sampler->index + 0x85ebca6bu * ++sampler->pair)));
}

#endif
