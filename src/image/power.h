/* power.h - powers for loops over pixels: a call of the C library would stop them from vectorising */
#pragma once

#include <stdint.h>
#include <string.h>

/* Returns log2(x) of a normal x > 0. With m in [sqrt(1/2), sqrt(2)) and s = (m - 1) / (m + 1)
 *
 *   log2(2^e m) = e + 2 / ln 2 (s + s^3 / 3 + s^5 / 5 + s^7 / 7 + s^9 / 9 + ...)
 *
 * whose next term is below 1e-8. */
static inline float power_log2(float x) {
    int32_t bits;
    memcpy(&bits, &x, 4);
    const int32_t e = (bits - 0x3f3504f3) >> 23; /* 0x3f3504f3 is sqrt(1/2) */
    bits -= (int32_t)((uint32_t)e << 23);
    float m;
    memcpy(&m, &bits, 4);
    const float s = (m - 1.0f) / (m + 1.0f), q = s * s;
    return (float)e + 2.88539008f * s * (1.0f + q * (1 / 3.0f + q * (1 / 5.0f + q * (1 / 7.0f + q * (1 / 9.0f)))));
}

/* Returns 2^x, with x clamped to [-126, 127], as 2^k 2^t with an integer k and |t| <= 1/2, and
 * 2^t = 1 + u + u^2 / 2! + u^3 / 3! + ..., u = t ln 2, whose next term is below 1e-8. */
static inline float power_exp2(float x) {
    const float ends = x < -126.0f ? -126.0f : x > 127.0f ? 127.0f : x;
    const int32_t k = (int32_t)(ends + 128.5f) - 128;
    const float u = (ends - (float)k) * 0.693147181f;
    float t = 1.0f + u * (1 / 7.0f);
    for (int n = 6; n > 0; n--) t = 1.0f + u * (1.0f / (float)n) * t;
    const int32_t bits = (k + 127) << 23;
    float scale;
    memcpy(&scale, &bits, 4);
    return t * scale;
}

/* Returns x^y, or 0 if x is 1e-30 or less. For |y log2 x| < 100 the relative error is below 2e-7 (1 + |y log2 x|)
 * (tests/image/test_difference). */
static inline float power(float x, float y) {
    const float least = x > 1e-30f ? x : 1e-30f;
    const float value = power_exp2(y * power_log2(least));
    return x > 1e-30f ? value : 0.0f;
}
