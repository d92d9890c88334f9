/* arrays_clone.c - the loops over pairs of all lobes for one set of instructions, and the fastest loops that it can run
 *
 * Compiled once for each column of arrays.c: CLONE is its name there. The loops stand in a section of that
 * name, where arrays.c counts their instructions. */
#define PASTE(a, b)                       a##_##b
#define NAMED(a, clone)                   PASTE(a, clone)
#define TEXT(name)                        #name
#define SECTION(clone)                    TEXT(arrays_##clone)
#define ALONE(clone)                      __attribute__((noinline, section(SECTION(clone))))
#define LOOP(name, parameters, arguments) ALONE(CLONE) static void name parameters

#define lobe_eval_n         NAMED(lobe_eval_n, CLONE)
#define lobe_pdf_n          NAMED(lobe_pdf_n, CLONE)
#define lobe_tinted_n       NAMED(lobe_tinted_n, CLONE)
#define cook_torrance_loops NAMED(cook_torrance_loops, CLONE)
#define each_eval           NAMED(each_eval, CLONE)
#define each_sample         NAMED(each_sample, CLONE)
#include "shading/catalogue/arrays_terms.c"
#include "shading/loops.gen.h"
#define LOOPS_HERE(name, Name, NAME, kind)                                                                             \
    PAIR_LOOPS_##kind(name, Name) static const LobeLoops name##_loops = {PAIR_PLACES_##kind(name), NULL};
CATALOGUE_LOOPS(LOOPS_HERE)
#include "shading/catalogue/arrays.c"

#ifdef __FMA__
#ifdef __AVX512F__
enum { WIDTH = 64 };
#else
enum { WIDTH = 32 };
#endif
typedef float Floats __attribute__((vector_size(WIDTH)));
typedef int32_t Ints __attribute__((vector_size(WIDTH)));

/* Twelve chains keep every port busy; the empty assembly keeps the compiler from shortening them. */
#define CHAINS(F) F(0) F(1) F(2) F(3) F(4) F(5) F(6) F(7) F(8) F(9) F(10) F(11)
#define HALF(F)   F(0) F(1) F(2) F(3) F(4) F(5)
#define OPEN(k)   __asm__("" : "+x"(v##k));
#define OPEN_I(k) __asm__("" : "+x"(i##k));
#define START(k)  Floats v##k = {0};
#define START_I(k)                                                                                                     \
    Ints i##k = {0};                                                                                                   \
    OPEN_I(k)
#define FMA(k)                                                                                                         \
    v##k = v##k * m + c;                                                                                               \
    OPEN(k)
#define DIVIDE(k)                                                                                                      \
    v##k = c / v##k;                                                                                                   \
    OPEN(k)
#define COUNT(k)                                                                                                       \
    i##k += one;                                                                                                       \
    OPEN_I(k)
#define SUM(k)   +v##k[0]
#define SUM_I(k) +(float)i##k[0]

float NAMED(peak_fma, CLONE)(size_t n);
float NAMED(peak_any, CLONE)(size_t n);
float NAMED(peak_divide, CLONE)(size_t n);

/* n times twelve multiply-adds */
float NAMED(peak_fma, CLONE)(size_t n) {
    Floats m = {0}, c = {0};
    m += 0.5f, c += 1.0f;
    CHAINS(START)
    for (size_t k = 0; k < n; k++) {
        CHAINS(FMA)
    }
    return 0.0f CHAINS(SUM);
}

/* n times six multiply-adds and six integer additions, which have ports of their own */
float NAMED(peak_any, CLONE)(size_t n) {
    Floats m = {0}, c = {0};
    Ints one = {0};
    m += 0.5f, c += 1.0f, one += 1;
    HALF(START)
    HALF(START_I)
    for (size_t k = 0; k < n; k++) {
        HALF(FMA) HALF(COUNT)
    }
    return 0.0f HALF(SUM) HALF(SUM_I);
}

/* n times twelve divisions */
float NAMED(peak_divide, CLONE)(size_t n) {
    Floats c = {0};
    c += 1.5f;
    CHAINS(START)
#define ONE(k) v##k += 1.0f;
    CHAINS(ONE)
    for (size_t k = 0; k < n; k++) {
        CHAINS(DIVIDE)
    }
    return 0.0f CHAINS(SUM);
}
#endif
