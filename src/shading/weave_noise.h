/* weave_noise.h - random courses along the threads of a woven cloth, by hashes of their numbers
 *
 * A thread's number is counted on through all repeats, so that the draft repeats and what varies does not; where a cloth
 * is to tile, all of it comes again after a cycle of threads. */
#ifndef WEFT_SHADING_WEAVE_NOISE_H
#define WEFT_SHADING_WEAVE_NOISE_H

#include "shading/dust.h"

/* x mod n of a whole number, n > 0. */
FN float weave_mod(float x, float n) {
    float m = x - n * floor(x / n);
    return m >= n ? m - n : m < 0.0f ? m + n : m;
}

/* A hash of a thread, 0 .. 288, and one of such a hash and a purpose. */
FN float weave_hash(float thread) {
    float low = weave_mod(thread, 289.0f), high = weave_mod(floor(thread / 289.0f), 289.0f);
    return dust_hash(dust_sum(dust_hash(high), low));
}
FN float weave_key(float hash, float purpose) { return dust_hash(dust_sum(hash, dust_mod(purpose))); }

/* From -1 to 1: for a key; smooth along t, which comes again after n; smooth over a plane. */
FN float weave_random(float key) { return dust_hash(key) / 144.0f - 1.0f; }
FN float weave_course(float key, float t, float n) {
    float i = floor(t), a = weave_mod(i, n), b = a + 1.0f < n ? a + 1.0f : 0.0f;
    return mix(weave_random(dust_sum(key, dust_mod(a))), weave_random(dust_sum(key, dust_mod(b))),
               dust_ease(t - i));
}
FN float weave_plane(float key, float t, float n, float u, float m) {
    float i = floor(u), a = weave_mod(i, m), b = a + 1.0f < m ? a + 1.0f : 0.0f;
    return mix(weave_course(dust_hash(dust_sum(key, dust_mod(a))), t, n),
               weave_course(dust_hash(dust_sum(key, dust_mod(b))), t, n), dust_ease(u - i));
}

/* A frequency in a crossing: about f > 0 times, and a whole number of times in a cycle; and how
 * often in that. Hashes repeat after 289, where there is no cycle. */
FN float weave_turns(float f, float cycle) {
    return cycle > 0.0f ? max(floor(f * cycle + 0.5f), 1.0f) : 289.0f;
}
FN float weave_pace(float f, float cycle) { return cycle > 0.0f ? weave_turns(f, cycle) / cycle : f; }

/* The points that a slanted lattice moves on in a crossing. They are about f, and a multiple of n in a cycle, since the
 * lattice comes again after n. */
FN float weave_lean(float f, float n, float cycle) {
    return cycle > 0.0f ? n * floor(f * cycle / n + 0.5f) / cycle : f;
}

/* A random course along a thread, of about f turns a crossing. */
FN float weave_along(float key, float f, float v, float cycle) {
    float pace = weave_pace(f, cycle);
    return weave_course(key, pace * v, weave_turns(pace, cycle));
}

/* The hash of a thread in a cycle of them. */
FN float weave_hash_of(float thread, float cycle) {
    return weave_hash(cycle > 0.0f ? weave_mod(thread, cycle) : thread);
}

#endif
