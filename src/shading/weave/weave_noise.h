/* weave_noise.h - random numbers for the threads of a woven cloth, and noise along them
 *
 *   noise(t) = mix(random(i), random(i + 1), e(t - i)),  i = floor(t),  e(x) = x^2 (3 - 2 x)
 *
 * A random number is a hash of the thread's number and of i. Threads are numbered on through all repeats of the draft,
 * so the draft repeats and its irregularities do not. If a cloth is to tile, they repeat after a cycle of threads. */
#pragma once

#include "shading/dialect/lang.h"

/* Returns x mod n of a whole number, n > 0. 1 / n is rounded, so the quotient may be one off: this is put right. */
FN float weave_mod(float x, float n) {
    float over_n = 1.0f / n, m = x - n * floor(x * over_n);
    return m >= n ? m - n : m < 0.0f ? m + n : m;
}

/* Returns x mod n, or x if n is 0. */
FN float weave_wrap(float x, float n) { return n > 0.0f ? weave_mod(x, n) : x; }

/* Returns a coordinate on the cloth, in threads, or 0 if it is beyond a million or not a number: a float that large has
 * few digits left for fractions, and numbers of threads have to fit into 32 bits. */
FN float weave_in_range(float x) { return abs(x) < 1e6f ? x : 0.0f; }

/* Permutes the numbers of 32 bits: a change of one bit of x flips about half of the bits. lowbias32 of Chris Wellons,
 * "Prospecting for Hash Functions", 2018. */
FN uint weave_hash(uint x) {
    uint y = (x ^ (x >> 16u)) * 0x7feb352du;
    y = (y ^ (y >> 15u)) * 0x846ca68bu;
    return y ^ (y >> 16u);
}

/* Returns a hash of two whole numbers i and j, at least -2^31 and below 2^31. seed: of the cloth, 0 to 288; purpose: 0
 * to 15, so that numbers for different purposes are independent. The factors are those of MurmurHash3's last step and
 * 2^32 by the golden ratio: near pairs have different sums, of which hardly any is 0, whose hash is 0. */
FN uint weave_key(float seed, int purpose, float i, float j) {
    uint cloth = to_uint(16 * to_int(seed) + purpose + 32) * 0x9e3779b9u;
    return weave_hash(cloth + to_uint(to_int(i)) * 0x85ebca6bu + to_uint(to_int(j)) * 0xc2b2ae35u);
}

/* Returns `count` bits of a hash, from bit `start` up, as a number from -1 to 1. */
FN float weave_bits(uint key, uint start, uint count) {
    uint all = (1u << count) - 1u;
    return to_float(to_int((key >> start) & all)) * (2.0f / to_float(to_int(all))) - 1.0f;
}

/* Returns one of the two independent numbers of a hash, -1 to 1. */
FN float weave_first(uint key) { return weave_bits(key, 16u, 16u); }
FN float weave_second(uint key) { return weave_bits(key, 0u, 16u); }

/* Returns e(t). */
FN float weave_ease(float t) { return t * t * (3.0f - 2.0f * t); }

/* The random numbers between which noise lies. */
STRUCT(WeaveNodes) {
    float low, high; /* i and i + 1, both mod n */
    float part;      /* e: the weight of the one at high */
};
/* Returns the nodes beside t. n: how many nodes there are until they repeat; 0: they do not. */
FN WeaveNodes weave_nodes(float t, float n) {
    float i = floor(t);
    WeaveNodes s;
    s.low = weave_wrap(i, n);
    s.high = n > 0.0f && s.low + 1.0f >= n ? 0.0f : s.low + 1.0f;
    s.part = weave_ease(t - i);
    return s;
}

/* Returns the number of nodes in a cycle, if there are about f > 0 per crossing: a whole number, at least 1. cycle: in
 * crossings; 0: there is none, and the number is 0. */
FN float weave_node_count(float f, float cycle) { return cycle > 0.0f ? max(floor(f * cycle + 0.5f), 1.0f) : 0.0f; }

/* Returns the nodes per crossing that make weave_node_count in a cycle; f if there is none. */
FN float weave_frequency(float f, float cycle) { return cycle > 0.0f ? weave_node_count(f, cycle) / cycle : f; }

/* Returns by how many nodes a lattice at a slant to the thread advances per crossing: f, rounded so that in a cycle it
 * advances by a multiple of n, the nodes after which the lattice repeats. */
FN float weave_slant(float f, float n, float cycle) {
    return cycle > 0.0f ? n * floor(f * cycle / n + 0.5f) / cycle : f;
}

/* Returns the nodes beside v, in crossings along a thread, if there are about f per crossing. */
FN WeaveNodes weave_nodes_along(float f, float v, float cycle) {
    float frequency = weave_frequency(f, cycle);
    return weave_nodes(frequency * v, weave_node_count(frequency, cycle));
}

/* Returns two independent noises along a thread, each from -1 to 1. */
STRUCT(WeaveNoise) { float first, second; };
FN WeaveNoise weave_noise(float seed, int purpose, float thread, WeaveNodes t) {
    uint a = weave_key(seed, purpose, thread, t.low), b = weave_key(seed, purpose, thread, t.high);
    WeaveNoise p;
    p.first = mix(weave_first(a), weave_first(b), t.part);
    p.second = mix(weave_second(a), weave_second(b), t.part);
    return p;
}

/* Returns noise number k of n along a thread, from -1 to 1. */
FN float weave_noise_of(float seed, int purpose, float thread, float k, float n, WeaveNodes t) {
    float strand = n * thread + k;
    return mix(weave_first(weave_key(seed, purpose, strand, t.low)),
               weave_first(weave_key(seed, purpose, strand, t.high)), t.part);
}
