/* sweep.h - directions that are hard on formulas, and what comes of them */
#ifndef WEFT_MEASURE_SWEEP_H
#define WEFT_MEASURE_SWEEP_H

#include "measure/bsdf/bsdf.h"

/* By its bits: no compiler option can fold the question away. */
static inline bool sweep_finite(float x) {
    uint32_t bits;
    memcpy(&bits, &x, 4);
    return (bits & 0x7f800000u) != 0x7f800000u;
}

enum { SWEEP_DIRS = 72, SWEEP_PARTNERS = 96, SWEEP_PAIRS = SWEEP_DIRS * SWEEP_PARTNERS };

/* Direction k: from cosine 1e-30 to 1, at azimuths that are axes and that are not. */
Dir sweep_dir(int k);

/* Partners for o: every sweep_dir, o itself, its mirror image, what is nearly opposite, some that are random,
 * and, where `below`, some that are not above the horizon. */
typedef struct Partners {
    int count;
    float x[SWEEP_PARTNERS], y[SWEEP_PARTNERS], z[SWEEP_PARTNERS];
} Partners;
void sweep_partners(Dir o, int k, bool below, Partners *partners);

typedef struct Sweep {
    long long count, infinite, negative, below;
} Sweep;

/* All pairs, and samples, of one setting. */
Sweep sweep_setting(const Bsdf *bsdf, int setting);

#endif
