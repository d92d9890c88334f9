/* loop.h - loops over arrays that are compiled once for each set of instructions
 *
 * Files with these loops, and a few others, are compiled with -ffinite-math-only (CMakeLists.txt): under it a
 * NaN test is folded away, and NaN has to be found by its bits. */
#pragma once

#include <stddef.h>

#include "shading/dialect/angles.h"
#include "shading/dialect/isa.h"

/* LOOP(name, (parameters), (arguments)) { ... } is a function without a result whose text is compiled once for each
 * set of instructions; a call runs the one in use. What its file is compiled for is the least set (CMakeLists.txt).
 * Where the build has one set alone (WEFT_ISA), WEFT_ONE_ISA is sse2, avx2 or avx512. */
#if defined(LOOP) /* bench/ makes each by itself */
#elif defined(__x86_64__) && !defined(WEFT_OUTLINED)
#define LOOP_sse2   __attribute__((noinline))
#define LOOP_avx2   __attribute__((noinline, target("arch=x86-64-v3")))
#define LOOP_avx512 __attribute__((noinline, target("arch=x86-64-v4")))
#define LOOP_SET(set, name, parameters, arguments)                                                                     \
    LOOP_##set static void name##_##set parameters { name##_text arguments; }
#ifdef WEFT_ONE_ISA
#define LOOP_IN(set, name, parameters, arguments)                                                                      \
    LOOP_SET(set, name, parameters, arguments)                                                                         \
    static void name parameters { name##_##set arguments; }
#define LOOP_ONE(set, ...) LOOP_IN(set, __VA_ARGS__)
#define LOOP(name, parameters, arguments)                                                                              \
    FN void name##_text parameters;                                                                                    \
    LOOP_ONE(WEFT_ONE_ISA, name, parameters, arguments)                                                                \
    FN void name##_text parameters
#else
#define LOOP(name, parameters, arguments)                                                                              \
    FN void name##_text parameters;                                                                                    \
    LOOP_SET(sse2, name, parameters, arguments)                                                                        \
    LOOP_SET(avx2, name, parameters, arguments)                                                                        \
    LOOP_SET(avx512, name, parameters, arguments)                                                                      \
    static void name parameters {                                                                                      \
        if (isa_used == ISA_AVX512)                                                                                    \
            name##_avx512 arguments;                                                                                   \
        else if (isa_used == ISA_AVX2)                                                                                 \
            name##_avx2 arguments;                                                                                     \
        else                                                                                                           \
            name##_sse2 arguments;                                                                                     \
    }                                                                                                                  \
    FN void name##_text parameters
#endif
#else
#define LOOP(name, parameters, arguments) static void name parameters
#endif

/* Returns true if both directions are above the horizon and all of their components are finite; their sum
 * would show any that is not. */
FN bool pair_counts(Dir o, Dir i) {
    float sum = (o.x + i.x) + (o.y + i.y) + (o.z + i.z);
    uint32_t bits;
    memcpy(&bits, &sum, 4);
    return ((int32_t)(bits & 0x7fffffffu) < 0x7f800000) & (o.z > 0.0f) & (i.z > 0.0f);
}

/* Takes a pair of directions. One that does not count is replaced by the normal twice, for which every formula is
 * finite. */
#define TAKE_PAIR(o, i, counts)                                                                                        \
    Dir o = {ox[k], oy[k], oz[k]}, i = {ix[k], iy[k], iz[k]};                                                          \
    bool counts = pair_counts(o, i);                                                                                   \
    o = (Dir){counts ? o.x : 0.0f, counts ? o.y : 0.0f, counts ? o.z : 1.0f};                                          \
    i = (Dir) { counts ? i.x : 0.0f, counts ? i.y : 0.0f, counts ? i.z : 1.0f }

/* A loop whose elements are independent. `omp simd` would make an array over lanes of every record which travels by
 * reference. */
#ifdef __clang__
#define EACH(k, n) _Pragma("clang loop vectorize(assume_safety)") for (size_t k = 0; k < n; k++)
#else
#define EACH(k, n) _Pragma("GCC ivdep") for (size_t k = 0; k < n; k++)
#endif
