/* sampler.h - the points of shading/dialect/points.h: which pair of dimensions of a path is which */
#pragma once

#include "base/random.h"
#include "shading/dialect/points.h"

/* Pairs of dimensions of a path. */
enum {
    SAMPLER_PIXEL,                      /* the point in the pixel */
    SAMPLER_FLOOR,                      /* where it meets the floor: for each group of lights, and for the mirror */
    SAMPLER_VERTEX = SAMPLER_FLOOR + 4, /* at each depth: for each group of lights, and for the lobe */
    SAMPLER_PER_VERTEX = 4,
    SAMPLER_CLOTH = 1 << 16, /* at each depth: for the threads of a woven cloth */
};

/* Returns a random number in [0, 1) without stratification, which takes no dimension. */
static inline float sampler_random(uint32_t key, uint32_t index, uint32_t place) {
    return unit_float(hash32(key ^ hash32(index + 0x85ebca6bu * (place + 1))));
}
