/* half.h - floats of 16 bits in files (IEEE 754, binary16) */
#pragma once

#include <math.h>
#include <stdint.h>
#include <string.h>

/* Returns the float of a half. Shifted to the place of a float's, its exponent and mantissa mean 2^(15 - 127) times the
 * value, also if it is subnormal. */
static inline float half_value(unsigned half) {
    if ((half & 0x7c00) == 0x7c00) return NAN; /* or infinite: no reader keeps either */
    const uint32_t bits = (uint32_t)(half & 0x7fff) << 13;
    float value;
    memcpy(&value, &bits, sizeof value);
    value *= 0x1p112f;
    return half & 0x8000 ? -value : value;
}

/* Returns the half nearest to x, as a float; |x| < 65504. */
static inline float half_near(double x) {
    int exponent;
    frexp(x, &exponent);
    double step = ldexp(1.0, (exponent > -13 ? exponent : -13) - 11);
    return (float)((rint)(x / step) * step);
}

/* Returns the half nearest to x, ties to even; larger values become the largest half, 65504. */
static inline uint16_t half_bits(float x) {
    uint32_t bits, sign;
    float value = fminf(fabsf(x), 65504.0f);
    memcpy(&sign, &x, sizeof sign);
    value *= 0x1p-112f; /* the exponent's low bits are now those of the half; subnormal if the half is */
    memcpy(&bits, &value, sizeof bits);
    bits += 0xfffu + (bits >> 13 & 1u);
    return (uint16_t)((sign >> 16 & 0x8000u) | bits >> 13);
}
