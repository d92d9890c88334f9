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

/* Two pairs of dimensions at once: the lanes of a register. */
typedef uint32_t Lanes __attribute__((vector_size(16)));

static inline uint32_t reverse_bits(uint32_t x) {
    x = __builtin_bswap32(x);
    x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
    x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
    return ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
}

static inline Lanes reverse_lanes(Lanes x) {
    x = (x >> 16) | (x << 16);
    x = ((x >> 8) & 0x00ff00ffu) | ((x & 0x00ff00ffu) << 8);
    x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
    x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
    return ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
}

/* A nested uniform scramble of digits stored lowest first: each bit is flipped by a hash of the bits below
 * it. Samuli Laine, Tero Karras, "Stratified Sampling for Stochastic Transparency", EGSR 2011, with the
 * constants found by Nathan Vegdahl, "Building a Better LK Hash", 2021. */
static inline Lanes owen_scramble(Lanes x, Lanes key) {
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

/* The key of a pixel, the same for all of its samples. */
static inline uint32_t sampler_key(uint32_t x, uint32_t y, uint32_t seed) {
    return hash_combine(hash_combine(hash32(seed), x), y);
}

static inline Sampler sampler_start(uint32_t key, uint32_t sample) {
    return (Sampler){key, reverse_bits(sample), 0};
}

typedef struct TwoPoints {
    Point first, second;
} TwoPoints;

/* The next two pairs of dimensions. Each pair has its own shuffle of the order (one key) and its own scramble
 * of either coordinate (one key a lane). */
static inline TwoPoints sampler_next(Sampler *sampler) {
    uint32_t a = hash32(sampler->key + 0x9e3779b9u * (sampler->pair + 1));
    uint32_t b = hash32(sampler->key + 0x9e3779b9u * (sampler->pair + 2));
    sampler->pair += 2;
    Lanes key = {a, a, b, b};
    Lanes i = reverse_lanes(owen_scramble((Lanes){0} + sampler->index, key));
    Lanes x = {i[0], pascal_bits(i[0]), i[2], pascal_bits(i[2])};
    key = key * 0x2c1b3c6du + (Lanes){0x297a2d39u, 0x7feb352du, 0x297a2d39u, 0x7feb352du};
    x = reverse_lanes(owen_scramble(x, key));
    return (TwoPoints){{unit_float(x[0]), unit_float(x[1])}, {unit_float(x[2]), unit_float(x[3])}};
}

/* One plain random number that costs no dimension. */
static inline float sampler_random(Sampler *sampler) {
    return unit_float(hash32(sampler->key ^ hash32(sampler->index + 0x85ebca6bu * ++sampler->pair)));
}

#endif
