/* weave_noise.h - random courses along the threads of a woven cloth, by hashes of their numbers
 *
 * A thread's number is counted on through all repeats, so that the draft repeats and what varies does not; where a cloth
 * is to tile, all of it comes again after a cycle of threads. */
#ifndef WEFT_SHADING_WEAVE_NOISE_H
#define WEFT_SHADING_WEAVE_NOISE_H

#include "shading/lang.h"

/* x mod n of a whole number, n > 0. */
FN float weave_mod(float x, float n) {
    float m = x - n * floor(x / n);
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

/* A hash of another one and of a whole number, from -2^31 up to 2^31, in which it is not included: of a thread's and a purpose, for example. */
FN uint weave_key(uint key, float number) {
    return weave_hash(key + to_uint(to_int(number)) * 0x9e3779b9u); /* 2^32 by the golden ratio */
}

/* From -1 to 1: for a key; smooth along t, which comes again after n; smooth over a plane. */
FN float weave_random(uint key) { return to_float(to_int(key >> 8u)) / 8388608.0f - 1.0f; }
FN float weave_ease(float t) { return t * t * (3.0f - 2.0f * t); }
FN float weave_course(uint key, float t, float n) {
    float i = floor(t), a = weave_mod(i, n), b = a + 1.0f < n ? a + 1.0f : 0.0f;
    return mix(weave_random(weave_key(key, a)), weave_random(weave_key(key, b)), weave_ease(t - i));
}
FN float weave_plane(uint key, float t, float n, float u, float m) {
    float i = floor(u), a = weave_mod(i, m), b = a + 1.0f < m ? a + 1.0f : 0.0f;
    return mix(weave_course(weave_key(key, a), t, n), weave_course(weave_key(key, b), t, n),
               weave_ease(u - i));
}

/* A frequency in a crossing: about f > 0 times, and a whole number of times in a cycle; and how
 * often in that. Where there is no cycle, it is 2^24, from which on floats skip whole numbers. */
FN float weave_turns(float f, float cycle) {
    return cycle > 0.0f ? max(floor(f * cycle + 0.5f), 1.0f) : 16777216.0f;
}
FN float weave_pace(float f, float cycle) { return cycle > 0.0f ? weave_turns(f, cycle) / cycle : f; }

/* The points that a slanted lattice moves on in a crossing. They are about f, and a multiple of n in a cycle, since the
 * lattice comes again after n. */
FN float weave_lean(float f, float n, float cycle) {
    return cycle > 0.0f ? n * floor(f * cycle / n + 0.5f) / cycle : f;
}

/* A random course along a thread, of about f turns a crossing. */
FN float weave_along(uint key, float f, float v, float cycle) {
    float pace = weave_pace(f, cycle);
    return weave_course(key, pace * v, weave_turns(pace, cycle));
}

/* The key of a thread of either system in a cycle of them, by the cloth's seed, 0 to 288. */
FN uint weave_thread_key(float seed, bool weft, float thread, float cycle) {
    uint all = weave_key(weave_key(0u, seed), weft ? 1.0f : 0.0f);
    return weave_key(all, cycle > 0.0f ? weave_mod(thread, cycle) : thread);
}

#endif
