/* lang.h - the dialect: what a shading file may use, in C11 and in GLSL (3.30 core, ES 3.00)
 *
 * Shading text uses float, int, bool, records and the calls below; nothing else, but uint for hashes where no text
 * is exported. It has no vectors: a lobe reads a pair of directions through Angles (angles.h), so that one text
 * serves a pixel, a ray and an array of directions. Only this file depends on the language.
 *
 * Large records travel by reference: `const T *m` and `T *m` as parameters, `m->x` and `*m` to read and
 * write, `&x` to pass; text/source/reference.h translates them to GLSL. Pointers serve nothing else, and no two
 * references of one call name the same object. `?:` chooses between numbers, never between records, which
 * WebGL does not take. */
#pragma once

#if defined(GL_ES) || defined(GL_core_profile) /* predefined by every GLSL compiler */

#define FN
#define FN_NOINLINE
#define STRUCT(Name) struct Name
#define UNION(Name)  struct Name /* GLSL has no unions: all members, of which a shader reads one */

#define to_float(x) float(x)
#define to_int(x)   int(x)
#define to_uint(x)  uint(x)

#define ROUNDS(k, n)          for (int k = 0; k < n; k++)
#define ROUNDS_OF(k, n, most) for (int k = 0; k < most && k < n; k++)

/* Layer t of the one array texture that holds all tables. */
#define Table                               int
#define TABLE_OF_NOTHING                    0
#define table_texel(t, stride, row, column) texelFetch(weft_tables, ivec3(column, row, t), 0).r

#else

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

/* WEFT_OUTLINED is defined for code that has to compile fast rather than run fast. */
#ifdef WEFT_OUTLINED
#define FN static inline __attribute__((unused))
#else
#define FN static inline __attribute__((always_inline, unused))
#endif
/* A function that is not inlined: long text that runs for many pairs at a time, or has loops without ROUNDS, which
 * only lobes with TRAIT_REFERENCE may have. A file in which it runs for each pair defines this as FN. */
#ifndef FN_NOINLINE
#define FN_NOINLINE static __attribute__((noinline, unused))
#endif
#define STRUCT(Name)                                                                                                   \
    typedef struct Name Name;                                                                                          \
    struct Name
#define UNION(Name)                                                                                                    \
    typedef union Name Name;                                                                                           \
    union Name

/* A loop of n rounds, n a constant. C unrolls it, so that a loop over arrays around it is vectorised; a shader has
 * the loop, since drivers compile unrolled text slowly. */
#ifdef __clang__
#define ROUNDS(k, n) _Pragma("clang loop unroll(full)") for (int k = 0; k < n; k++)
#else
#define ROUNDS(k, n) _Pragma("GCC unroll 16") for (int k = 0; k < n; k++)
#endif

/* The first n of at most `most` rounds. A vectorised loop needs a constant n, or does them all, so rounds from n on
 * must add nothing; loops over arrays are compiled for several n (BY_COUNT in lobe_loop.h). */
#define ROUNDS_OF(k, n, most) ROUNDS(k, most) if (k < n)

/* Returns a b + c, rounded a single time if the processor has an instruction for it. Only the functions below use it,
 * which differ from GLSL's own in any case; everything that both languages compute alike rounds each product. */
FN float weft_fused(float a, float b, float c) {
#ifdef __FMA__
    return __builtin_fmaf(a, b, c);
#else
    return a * b + c;
#endif
}

/* log2 x of a normal x > 0, as the exponent and what it leaves, within a half of 0. The mantissa in
 * [sqrt(1/2), sqrt(2)) is 1 + t, and log2(1 + t) / t a degree-7 polynomial interpolated at Chebyshev nodes.
 * Written here because a library call stops a loop from vectorising, and summed in pairs because a scalar
 * waits for each step of Horner's rule. */
typedef struct WeftLog2 {
    float whole, rest;
} WeftLog2;

FN WeftLog2 weft_log2_parts(float x) {
    int32_t i;
    memcpy(&i, &x, 4);
    int32_t e = (i - 0x3f3504f3) >> 23; /* 0x3f3504f3 is sqrt(1/2) */
    i -= (int32_t)((uint32_t)e << 23);
    float m;
    memcpy(&m, &i, 4);
    float t = m - 1.0f, t2 = t * t;
    float p = weft_fused(weft_fused(-0.142759734f, t, 0.232652579f), t2, weft_fused(-0.249271822f, t, 0.287288882f));
    p = weft_fused(weft_fused(p, t, -0.360225182f), t2, weft_fused(0.480916708f, t, -0.721352931f));
    p = weft_fused(p, t, 1.44269499f);
    WeftLog2 l = {(float)e, p * t};
    return l;
}

/* Returns log2 x. The relative error is at most 3.1e-7, and 1.6e-7 of max(1, |log2 x|) (tests/shading/test_dialect). */
FN float weft_log2(float x) {
    WeftLog2 l = weft_log2_parts(x);
    return l.whole + l.rest;
}

/* x + WEFT_ROUND has no bits for the fraction of x, |x| < 2^22, and has the nearest whole number in its last bits:
 * it needs no call and is cheap in every set of instructions. */
#define WEFT_ROUND          12582912.0f /* 1.5 * 2^23 */

/* Returns 2^(k + t) for rounded = k + WEFT_ROUND and |t| <= 1/2: a polynomial of degree 6 for 2^t, with k added to its
 * exponent. */
FN float weft_exp2_parts(float rounded, float t) {
    float t2 = t * t, p = weft_fused(0.000154531629f, t2, weft_fused(0.00133908634f, t, 0.00961808256f));
    p = weft_fused(p, t2, weft_fused(0.0555035711f, t, 0.240226508f));
    p = weft_fused(weft_fused(p, t, 0.693147188f), t, 1.0f);
    uint32_t k, i;
    memcpy(&k, &rounded, 4);
    memcpy(&i, &p, 4);
    i += k << 23;
    memcpy(&p, &i, 4);
    return p;
}

/* Returns 2^x, clamped to the normal floats. The relative error is at most 1e-7. */
FN float weft_exp2(float x) {
    x = x < -126.0f ? -126.0f : x > 127.0f ? 127.0f : x;
    float rounded = x + WEFT_ROUND;
    return weft_exp2_parts(rounded, x - (rounded - WEFT_ROUND));
}

FN float weft_exp(float x) {
    x = x < -87.3f ? -87.3f : x > 88.0f ? 88.0f : x;
    float rounded = x * 1.44269504f + WEFT_ROUND;
    return weft_exp2_parts(rounded, x * 1.44269504f - (rounded - WEFT_ROUND));
}

/* Returns x^y of a normal x > 0, clamped to 2^-125.51 .. 2^127.51. The relative error is at most 1.3e-7 (1 + |y|): y
 * log2 x is never rounded as a whole, because the first 12 bits of y times the exponent of x, less the nearest whole
 * number, is exact. */
FN float weft_pow(float x, float y) {
    WeftLog2 l = weft_log2_parts(x);
    uint32_t i;
    float head;
    memcpy(&i, &y, 4);
    i &= 0xfffff000u;
    memcpy(&head, &i, 4);
    float w = y * (l.whole + l.rest);
    w = w < -125.0f ? -125.0f : w > 127.0f ? 127.0f : w;
    float rounded = w + WEFT_ROUND;
    float t = (head * l.whole - (rounded - WEFT_ROUND)) + weft_fused(y, l.rest, (y - head) * l.whole);
    t = t < -0.51f ? -0.51f : t > 0.51f ? 0.51f : t; /* beyond 1/2 by more than rounding: w was clamped */
    return weft_exp2_parts(rounded, t);
}

/* Returns the sine of x + quarters pi / 2 for |x| < 2^12: subtracts the nearest multiple of pi / 2 in three parts, then
 * evaluates a polynomial for the sine or the cosine of the rest. The absolute error is below 1e-7. Stephen L. Moshier,
 * Cephes Mathematical Library, sinf.c, 1992. */
FN float weft_sine(float x, uint32_t quarters) {
    float rounded = x * 0.636619772f + WEFT_ROUND, k = rounded - WEFT_ROUND;
    float r = weft_fused(k, -7.54978995e-8f, weft_fused(k, -4.83751297e-4f, weft_fused(k, -1.5703125f, x))), q = r * r;
    float s = weft_fused(weft_fused(weft_fused(-1.95152959e-4f, q, 8.33216087e-3f), q, -1.66666546e-1f), r * q, r);
    float c = weft_fused(weft_fused(weft_fused(2.44331571e-5f, q, -1.38873163e-3f), q, 4.16666457e-2f), q * q,
                         weft_fused(-0.5f, q, 1.0f));
    uint32_t n, bits;
    memcpy(&n, &rounded, 4);
    n += quarters;
    float y = (n & 1u) != 0u ? c : s;
    memcpy(&bits, &y, 4);
    bits ^= (n & 2u) << 30;
    memcpy(&y, &bits, 4);
    return y;
}

/* Returns the smaller number, as weft_max the greater, by one instruction. The C library's functions are calls, because
 * for a NaN and a number they return the number. */
FN float weft_min(float a, float b) { return a < b ? a : b; }
FN float weft_max(float a, float b) { return a > b ? a : b; }

FN float weft_mix(float a, float b, float t) { return a + (b - a) * t; }

/* Whole numbers of 32 bits, which wrap. */
typedef uint32_t uint;

/* A table's texels, row after row. */
typedef const float *Table;
#define TABLE_OF_NOTHING    NULL
FN float table_texel(Table t, int stride, int row, int column) { return t[row * stride + column]; }

/* The names below shadow <math.h>: include the dialect only where the catalogue is compiled. */
#define min(a, b)           weft_min(a, b)
#define max(a, b)           weft_max(a, b)
#define clamp(x, low, high) weft_min(weft_max(x, low), high)
#define abs(x)              fabsf(x)
#define floor(x)            floorf(x)
#define sqrt(x)             sqrtf(x)
#define mix(a, b, t)        weft_mix(a, b, t)
#ifdef WEFT_LIBM /* the C library's own: for pictures, and for bench/arrays.c to compare with */
#define sin(x)    sinf(x)
#define cos(x)    cosf(x)
#define log2(x)   log2f(x)
#define exp2(x)   exp2f(x)
#define exp(x)    expf(x)
#define pow(x, y) powf(x, y)
#else
#define sin(x)    weft_sine(x, 0u)
#define cos(x)    weft_sine(x, 1u)
#define log2(x)   weft_log2(x)
#define exp2(x)   weft_exp2(x)
#define exp(x)    weft_exp(x)
#define pow(x, y) weft_pow(x, y)
#endif
#define to_float(x) ((float)(x))
#define to_int(x)   ((int)(x))
#define to_uint(x)  ((uint)(x))

#endif

#define PI 3.14159265358979f

/* One line of a lobe's parameter table as a member of its record. */
#define FIELD(type, name, def, low, high, hard_low, hard_high, help) type name;
