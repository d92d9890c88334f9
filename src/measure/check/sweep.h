/* sweep.h - directions that are hard on formulas, and a count of bad results */
#pragma once

#include "measure/bsdf/bsdf.h"

/* Returns true if x is finite, by its bits: no compiler option can fold the test away. */
static inline bool sweep_finite(float x) {
    uint32_t bits;
    memcpy(&bits, &x, 4);
    return (bits & 0x7f800000u) != 0x7f800000u;
}

enum { SWEEP_DIRS = 72, SWEEP_PARTNERS = 96, SWEEP_PAIRS = SWEEP_DIRS * SWEEP_PARTNERS };

/* Returns direction k: cosines from 1e-30 to 1, at azimuths that are axes and others. */
Dir sweep_dir(int k);

/* Partners for o: every sweep_dir, o itself, its mirror image, nearly opposite ones, some random ones and,
 * with `below`, some that are not above the horizon. */
typedef struct Partners {
    int count;
    float x[SWEEP_PARTNERS], y[SWEEP_PARTNERS], z[SWEEP_PARTNERS];
} Partners;
void sweep_partners(Dir o, int k, bool below, Partners *partners);

typedef struct Sweep {
    long long count, infinite, negative, below;
} Sweep;

/* Evaluates all pairs, and samples, of one setting. */
Sweep sweep_setting(const Bsdf *bsdf, int setting);
