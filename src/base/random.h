/* random.h - counter-based random numbers: a value is a function of its key, whatever the order and the threads */
#pragma once

#include <stdint.h>

/* Mixes 32 bits by a bijection with low bias: the two-round "lowbias32" of Chris Wellons, "Hash Prospector", 2018. */
static inline uint32_t hash32(uint32_t x) {
    x ^= x >> 16;
    x *= 0x7feb352du;
    x ^= x >> 15;
    x *= 0x846ca68bu;
    x ^= x >> 16;
    return x;
}

static inline uint32_t hash_combine(uint32_t a, uint32_t b) { return hash32(a ^ (b * 0x9e3779b9u + 0x85ebca6bu)); }

/* Returns 24 bits of x as a float in [0, 1). */
static inline float unit_float(uint32_t x) { return (float)(int32_t)(x >> 8) * 0x1p-24f; }

/* Mixes 64 bits, for streams that are too long for 32. Guy L. Steele, Doug Lea, Christine H. Flood, "Fast Splittable
 * Pseudorandom Number Generators", OOPSLA 2014, SplitMix64. */
static inline uint64_t hash64(uint64_t x) {
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
}

/* Returns the start of the SplitMix64 stream of a key of two numbers, and the stream's next number: the counter goes in
 * steps of the golden ratio. */
static inline uint64_t stream_start(uint64_t a, uint64_t b) { return hash64(hash64(a + 0x9e3779b97f4a7c15u) + b); }
static inline uint64_t stream_next(uint64_t *stream) { return hash64(*stream += 0x9e3779b97f4a7c15u); }

/* Returns 53 bits of x as a number in [0, 1). */
static inline double unit_double(uint64_t x) { return (double)(x >> 11) * 0x1p-53; }
