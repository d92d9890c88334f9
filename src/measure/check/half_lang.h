/* half_lang.h - lang.h for the copies of the shading texts in which every number is a half float
 *
 * cmake/generate.cmake makes the copies: their literals end in f16, and they include this file instead of
 * lang.h. Every value and every operation is rounded to 16 bits, as a shader of mediump does on hardware that
 * has them; powers, exponentials and roots are computed in single precision and rounded. Tables store single
 * floats and are rounded when read. half_text.c includes it with those copies. */
#pragma once

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#define FN          static inline __attribute__((unused))
#define FN_NOINLINE FN
#define STRUCT(Name)                                                                                                   \
    typedef struct Name Name;                                                                                          \
    struct Name
#define UNION(Name)                                                                                                    \
    typedef union Name Name;                                                                                           \
    union Name

typedef float Single;
typedef _Float16 Half;

FN Half half_min(Half a, Half b) { return a < b ? a : b; }
FN Half half_max(Half a, Half b) { return a > b ? a : b; }
FN Half half_mix(Half a, Half b, Half t) { return a + (b - a) * t; }
FN Half half_abs(Half x) { return x < 0 ? -x : x; }

#define HALF_OF(name, call)                                                                                            \
    FN Half half_##name(Half x) { return (Half)call((Single)x); }
HALF_OF(floor, floorf)
HALF_OF(sqrt, sqrtf)
HALF_OF(sin, sinf)
HALF_OF(cos, cosf)
HALF_OF(log2, log2f)
HALF_OF(exp2, exp2f)
HALF_OF(exp, expf)
FN Half half_pow(Half x, Half y) { return (Half)powf((Single)x, (Single)y); }

typedef const Single *Table;
#define TABLE_OF_NOTHING NULL
FN Half table_texel(Table t, int stride, int row, int column) { return (Half)t[row * stride + column]; }

#define float _Float16
#define min(a, b)             half_min(a, b)
#define max(a, b)             half_max(a, b)
#define clamp(x, low, high)   half_min(half_max(x, low), high)
#define abs(x)                half_abs(x)
#define floor(x)              half_floor(x)
#define sqrt(x)               half_sqrt(x)
#define sin(x)                half_sin(x)
#define cos(x)                half_cos(x)
#define log2(x)               half_log2(x)
#define exp2(x)               half_exp2(x)
#define exp(x)                half_exp(x)
#define pow(x, y)             half_pow(x, y)
#define mix(a, b, t)          half_mix(a, b, t)
#define to_float(x)           ((Half)(x))
#define to_int(x)             ((int)(x))
#define ROUNDS(k, n)          for (int k = 0; k < (n); k++)
#define ROUNDS_OF(k, n, most) for (int k = 0; k < (most) && k < (n); k++)

#define PI                                                           3.14159265358979f16
#define FIELD(type, name, def, low, high, hard_low, hard_high, help) type name;
