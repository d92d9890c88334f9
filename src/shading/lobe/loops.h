/* loops.h - the loops of one lobe over arrays, behind pointers: of the catalogue (lobe_loop.h) or of a plugin (plugin.h) */
#pragma once

#include <stddef.h>

#include "shading/lobe/each.h"

/* n pairs of directions, as lobe_eval_n takes them. */
#define LOOP_PAIRS                                                                                                     \
    const float *restrict ox, const float *restrict oy, const float *restrict oz, const float *restrict ix,            \
        const float *restrict iy, const float *restrict iz
#define LOOP_NAMES ox, oy, oz, ix, iy, iz

typedef void LoopOne(const Lobe *m, size_t n, LOOP_PAIRS, float *restrict out);
typedef void LoopShares(const Lobe *m, size_t n, LOOP_PAIRS, float *restrict f, float *restrict s);
typedef void LoopTinted(const Lobe *m, const float c[3], size_t n, LOOP_PAIRS, float *restrict r, float *restrict g,
                        float *restrict b); /* of what has albedo c */
typedef void LoopEach(const Each *e, size_t n);

/* The loops in which each element has numbers of its own. */
typedef struct EachLoops {
    LoopEach *eval, *sample;
} EachLoops;

typedef struct LobeLoops {
    LoopOne *f, *pdf;
    LoopShares *shares; /* NULL: the lobe has one colour */
    LoopTinted *tinted; /* NULL: the lobe is not tinted */
    const EachLoops *each;
} LobeLoops;
