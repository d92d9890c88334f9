/* halton.h - points evenly distributed in a cube, however many: the sequence of John H. Halton, "On the
 * Efficiency of Certain Quasi-Random Sequences of Points in Evaluating Multi-Dimensional Integrals", 1960. */
#pragma once

/* Returns the digits of k >= 0 in a base, a prime for each axis, in reverse order, in [0, 1). */
static inline double halton(int k, int base) {
    double value = 0.0, digit = 1.0 / base;
    for (; k > 0; k /= base, digit /= base) value += (k % base) * digit;
    return value;
}
