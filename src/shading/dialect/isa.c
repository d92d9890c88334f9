/* isa.c is compiled for the least processor, so that it can report what a lesser one than that of the build lacks. */
#include "shading/dialect/isa_choice.h"

#include <stddef.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "base/fail.h"

Isa isa_used;

static const char *const names[ISA_COUNT] = {"sse2", "avx2", "avx512"};

const char *weft_isa_name(int isa) { return isa >= 0 && isa < ISA_COUNT ? names[isa] : NULL; }

const char *weft_isa(void) { return names[isa_used]; }

/* The sets that loops are compiled for (LOOP in loop.h). */
#if !defined(__x86_64__) || defined(WEFT_OUTLINED)
static const Isa least = ISA_SSE2, most = ISA_SSE2;
#elif defined(WEFT_ONE_ISA)
#define ONE_sse2    ISA_SSE2
#define ONE_avx2    ISA_AVX2
#define ONE_avx512  ISA_AVX512
#define ONE_OF(set) ONE_##set
#define ONE(set)    ONE_OF(set)
static const Isa least = ONE(WEFT_ONE_ISA), most = ONE(WEFT_ONE_ISA);
#else
static const Isa least = ISA_SSE2, most = ISA_AVX512;
#endif

/* The set that all else is compiled for (WEFT_ARCH), as far as CMakeLists.txt knows. */
#ifdef WEFT_NEEDS_AVX2
static const Isa elsewhere = ISA_AVX2;
#else
static const Isa elsewhere = ISA_SSE2;
#endif

Isa isa_of_processor(void) {
#ifdef __x86_64__
    __builtin_cpu_init();
    if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma") || !__builtin_cpu_supports("bmi") ||
        !__builtin_cpu_supports("bmi2"))
        return ISA_SSE2;
    if (!__builtin_cpu_supports("avx512f") || !__builtin_cpu_supports("avx512bw") ||
        !__builtin_cpu_supports("avx512cd") || !__builtin_cpu_supports("avx512dq") ||
        !__builtin_cpu_supports("avx512vl"))
        return ISA_AVX2;
    return ISA_AVX512;
#else
    return ISA_SSE2;
#endif
}

Isa isa_least(void) { return least; }

Isa isa_widest(void) {
    Isa widest = isa_of_processor();
    return widest < most ? widest : most;
}

WeftResult isa_choose(const char *name, Isa from, Isa widest, Isa *chosen, WeftError *error) {
    int isa = 0;
    while (name && isa < ISA_COUNT && strcmp(names[isa], name) != 0) isa++;
    if (isa == ISA_COUNT) return fail(error, WEFT_MESSAGE_ISA_NAME, name, "sse2, avx2 or avx512");
    if (name && isa < (int)from)
        return fail(error, WEFT_MESSAGE_ISA, name, "this build has %s alone; -DWEFT_ISA=all builds all", names[from]);
    if (isa > (int)widest)
        return fail(error, WEFT_MESSAGE_ISA, name, "this processor, or this build, has at most %s", names[widest]);
    *chosen = name ? (Isa)isa : widest;
    return WEFT_OK;
}

WeftResult weft_isa_use(const char *name, WeftError *error) {
    return isa_choose(name, isa_least(), isa_widest(), &isa_used, error);
}

const char *isa_lacking(Isa processor) {
    static const char *const words[ISA_COUNT] = {"SSE2", "AVX2 and FMA", "AVX-512"};
    Isa needed = least > elsewhere ? least : elsewhere;
    return processor < needed ? words[needed] : NULL;
}

/* Chooses the set before the first call of anything else. A build for a wider processor than this one says so and ends the
 * program, which would end by an instruction that is not there. */
__attribute__((constructor)) static void begin(void) {
    const char *lacking = isa_lacking(isa_of_processor());
    if (lacking) {
        fprintf(stderr,
                "weft: this build needs a processor with %s: build on this machine, or for any with "
                "-DWEFT_ARCH=none -DWEFT_ISA=all\n",
                lacking);
        _exit(WEFT_RESOURCES);
    }
    isa_used = isa_widest();
}
