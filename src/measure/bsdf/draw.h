/* draw.h - numbers in [0, 1) by seed and index, the same in every run and on every thread */
#pragma once

#include "base/random.h"

typedef struct Draw {
    uint32_t seed, next;
} Draw;

static inline Draw draw_start(uint32_t a, uint32_t b) { return (Draw){hash_combine(hash32(a + 1u), b), 0}; }

static inline float draw_unit(Draw *draw) { return unit_float(hash_combine(draw->seed, draw->next++)); }
