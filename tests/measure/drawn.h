/* drawn.h - numbers that tests of fits draw, the same in every run */
#ifndef WEFT_TESTS_MEASURE_DRAWN_H
#define WEFT_TESTS_MEASURE_DRAWN_H

#include <stdint.h>

static uint32_t drawn_seed;

/* Returns the next number, in [0, 1), by the linear congruential generator of William H. Press et al., "Numerical Recipes in
 * C", 1992, section 7.1. */
static double drawn(void) {
    drawn_seed = drawn_seed * 1664525u + 1013904223u;
    return (double)(drawn_seed >> 8) * 0x1p-24;
}

#endif
