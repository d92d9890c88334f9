/* white_cloth.h - what a cloth whose fibres are all white reflects from afar
 *
 * Include it after shading/cases.h. */
#ifndef WEFT_TESTS_WHITE_CLOTH_H
#define WEFT_TESTS_WHITE_CLOTH_H

#include "base/pi.h"
#include "shading/cases.h"
#include "weave/weft_cloth.h"

/* Returns f of one system. Fails where its lobe is not a lobe's: not finite, or below 0. */
static inline float white_system(const WeftCloth *cloth, int system, Dir o, Dir i) {
    const WovenPrepared *p = &cloth->far.woven[system];
    const WeaveFar *far = system == WEFT_WEFT ? &cloth->weave.weft_far : &cloth->weave.warp_far;
    WovenView w;
    woven_view(p, o, &w);
    const LobeValue v = woven_value(p, &w, angles_between(o, i));
    assert_true(v.f >= 0.0f && v.f < 1e8f && v.s >= 0.0f && v.s <= 1.0f && v.pdf >= 0.0f);
    return v.f * (far->single * (1.0f - v.s) + far->multiple * v.s);
}

/* Returns f of both systems. */
static inline float white_of(const WeftCloth *cloth, Dir o, Dir i) {
    return white_system(cloth, WEFT_WARP, o, i) + white_system(cloth, WEFT_WEFT, o, i);
}

/* Returns the part of the light from o that the cloth sends back. */
static inline double white_albedo(const WeftCloth *cloth, Dir o) {
    enum { ROWS = 24, COLUMNS = 48 };
    double sum = 0.0;
    for (int k = 0; k < ROWS * COLUMNS; k++) {
        const Dir i = warp_cosine(((float)(k / COLUMNS) + 0.5f) / ROWS, ((float)(k % COLUMNS) + 0.5f) / COLUMNS);
        sum += PI_DOUBLE * (double)white_of(cloth, o, i) / (ROWS * COLUMNS);
    }
    return sum;
}

#endif
