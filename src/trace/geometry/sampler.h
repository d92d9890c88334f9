/* sampler.h - Owen-scrambled Sobol points, padded two dimensions at a time
 *
 * In each pair of dimensions, the points of a pixel are the (0, 2)-sequence of Sobol', its order shuffled and its
 * digits scrambled by keys made from pixel, seed and pair. A value is a function of its key: it depends neither on
 * threads nor on order, and loops over many of them are loops of vectors.
 *
 *   I. M. Sobol', "On the distribution of points in a cube and the approximate evaluation of integrals",
 * 1967. Brent Burley, "Practical Hash-based Owen Scrambling", JCGT 9(4), 2020. */
#pragma once

#include <stdint.h>

#include "base/random.h"

typedef struct Point {
    float u, v; /* in [0, 1) */
} Point;

/* Pairs of dimensions of a path. */
enum {
    SAMPLER_PIXEL,                      /* the point in the pixel */
    SAMPLER_FLOOR,                      /* where it meets the floor: for each group of lights, and for the mirror */
    SAMPLER_VERTEX = SAMPLER_FLOOR + 4, /* at each depth: for each group of lights, and for the lobe */
    SAMPLER_PER_VERTEX = 4,
    SAMPLER_CLOTH = 1 << 16, /* at each depth: for the threads of a woven cloth */
};

static inline uint32_t reverse_bits(uint32_t x) {
    x = (x >> 16) | (x << 16);
    x = ((x >> 8) & 0x00ff00ffu) | ((x & 0x00ff00ffu) << 8);
    x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
    x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
    return ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
}

/* Applies a nested uniform scramble to digits stored lowest first: each bit is flipped by a hash of the bits below it.
 * Samuli Laine, Tero Karras, "Stratified Sampling for Stochastic Transparency", EGSR 2011, with the constants of Nathan
 * Vegdahl, "Building a Better LK Hash", 2021. */
static inline uint32_t owen_scramble(uint32_t x, uint32_t key) {
    x ^= x * 0x3d20adeau;
    x += key;
    x *= (key >> 16) | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return x;
}

/* Multiplies by the generator matrix of the second dimension: Pascal's triangle modulo 2, the fivefold Kronecker power
 * of [1 1; 0 1], one step a level. */
static inline uint32_t pascal_bits(uint32_t i) {
    i ^= (i >> 1) & 0x55555555u;
    i ^= (i >> 2) & 0x33333333u;
    i ^= (i >> 4) & 0x0f0f0f0fu;
    i ^= (i >> 8) & 0x00ff00ffu;
    return i ^ (i >> 16);
}

/* Returns the key of a pixel, which all of its samples share. */
static inline uint32_t sampler_key(uint32_t x, uint32_t y, uint32_t seed) {
    return hash_combine(hash_combine(hash32(seed), x), y);
}

/* Returns the index of a sample of a pixel: its number with reversed bits. */
static inline uint32_t sampler_index(uint32_t sample) { return reverse_bits(sample); }

/* Returns the point in a pair of dimensions. Each pair has its own order, and its own scramble of either coordinate. */
static inline Point sampler_point(uint32_t key, uint32_t index, uint32_t pair) {
    uint32_t own = hash32(key + 0x9e3779b9u * (pair + 1)), i = reverse_bits(owen_scramble(index, own));
    uint32_t scramble = own * 0x2c1b3c6du;
    uint32_t x = reverse_bits(owen_scramble(i, scramble + 0x297a2d39u));
    uint32_t y = reverse_bits(owen_scramble(pascal_bits(i), scramble + 0x7feb352du));
    Point p = {unit_float(x), unit_float(y)};
    return p;
}

/* Returns a random number in [0, 1) without stratification, which takes no dimension. */
static inline float sampler_random(uint32_t key, uint32_t index, uint32_t place) {
    return unit_float(hash32(key ^ hash32(index + 0x85ebca6bu * (place + 1))));
}
