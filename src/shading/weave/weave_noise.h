/* weave_noise.h - random courses along the threads of a woven cloth, by hashes of their numbers
 *
 * A thread's number is counted on through all repeats, so that the draft repeats and what varies does not; where a cloth
 * is to tile, all of it comes again after a cycle of threads. */
#ifndef WEFT_SHADING_WEAVE_NOISE_H
#define WEFT_SHADING_WEAVE_NOISE_H

#include "shading/dialect/lang.h"

/* x mod n of a whole number, n > 0. x / n may be off by one where it is near a whole number. */
FN float weave_mod(float x, float n) {
    float over_n = 1.0f / n, m = x - n * floor(x * over_n);
    return m >= n ? m - n : m < 0.0f ? m + n : m;
}

/* A place on the cloth, in threads. A float that counts more than a million has few fractions left, and numbers of threads
 * are to fit into 32 bits: what lies further out, or nowhere, is at the first thread. */
FN float weave_bounded(float x) { return abs(x) < 1e6f ? x : 0.0f; }

/* A permutation of 32 bits, in which each bit of x turns about half of all: lowbias32 of Chris Wellons, "Prospecting for
 * Hash Functions", 2018. */
FN uint weave_hash(uint x) {
    uint y = (x ^ (x >> 16u)) * 0x7feb352du;
    y = (y ^ (y >> 15u)) * 0x846ca68bu;
    return y ^ (y >> 16u);
}

/* A hash of two whole numbers, from -2^31 up to 2^31, in which it is not included, of the cloth's seed, 0 to 288, and of a
 * purpose, 0 to 15. The factors are those of MurmurHash3's last step and 2^32 by the golden ratio: no two near pairs have the same
 * sum, and hardly any the sum 0, whose hash is 0. */
FN uint weave_key(float seed, int purpose, float i, float j) {
    uint cloth = to_uint(16 * to_int(seed) + purpose + 32) * 0x9e3779b9u;
    return weave_hash(cloth + to_uint(to_int(i)) * 0x85ebca6bu + to_uint(to_int(j)) * 0xc2b2ae35u);
}

/* A number from -1 to 1: so many bits of a hash from a place on; its upper and its lower half. */
FN float weave_bits(uint key, uint place, uint count) {
    uint all = (1u << count) - 1u;
    return to_float(to_int((key >> place) & all)) * (2.0f / to_float(to_int(all))) - 1.0f;
}
FN float weave_first(uint key) { return weave_bits(key, 16u, 16u); }
FN float weave_second(uint key) { return weave_bits(key, 0u, 16u); }
FN float weave_ease(float t) { return t * t * (3.0f - 2.0f * t); }

/* A whole number that comes again after n; 0: never. */
FN float weave_wrap(float x, float n) { return n > 0.0f ? weave_mod(x, n) : x; }

/* A place between two whole numbers that come again after n, and what part of the way it is. */
STRUCT(WeaveStep) { float low, high, part; };
FN WeaveStep weave_step(float t, float n) {
    float i = floor(t);
    WeaveStep s;
    s.low = weave_wrap(i, n);
    s.high = n > 0.0f && s.low + 1.0f >= n ? 0.0f : s.low + 1.0f;
    s.part = weave_ease(t - i);
    return s;
}

/* A frequency in a crossing: about f > 0 times, and a whole number of times in a cycle; and how
 * often in that. 0: there is no cycle. */
FN float weave_turns(float f, float cycle) {
    return cycle > 0.0f ? max(floor(f * cycle + 0.5f), 1.0f) : 0.0f;
}
FN float weave_pace(float f, float cycle) { return cycle > 0.0f ? weave_turns(f, cycle) / cycle : f; }

/* The points that a slanted lattice moves on in a crossing. They are about f, and a multiple of n in a cycle, since the
 * lattice comes again after n. */
FN float weave_lean(float f, float n, float cycle) {
    return cycle > 0.0f ? n * floor(f * cycle / n + 0.5f) / cycle : f;
}

/* Finds v between places along a thread that are about 1 / f crossings apart. */
FN WeaveStep weave_along(float f, float v, float cycle) {
    float pace = weave_pace(f, cycle);
    return weave_step(pace * v, weave_turns(pace, cycle));
}

/* Two random courses along a thread, at its place t. */
STRUCT(WeavePair) { float first, second; };
FN WeavePair weave_courses(float seed, int purpose, float thread, WeaveStep t) {
    uint a = weave_key(seed, purpose, thread, t.low), b = weave_key(seed, purpose, thread, t.high);
    WeavePair p;
    p.first = mix(weave_first(a), weave_first(b), t.part);
    p.second = mix(weave_second(a), weave_second(b), t.part);
    return p;
}

/* A random course along a thread of which places k of n across it have their own, at t. */
FN float weave_course(float seed, int purpose, float thread, float k, float n, WeaveStep t) {
    float place = n * thread + k;
    return mix(weave_first(weave_key(seed, purpose, place, t.low)),
               weave_first(weave_key(seed, purpose, place, t.high)), t.part);
}

#endif
