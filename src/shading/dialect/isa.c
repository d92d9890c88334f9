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

/* Returns the widest set of instructions that the processor has. LOOP_AVX2 and LOOP_AVX512 are the levels v3 and v4 of
 * x86-64. */
Isa isa_widest(void) {
#ifdef LOOP_AVX2
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
        return fail(error, WEFT_MESSAGE_ISA, name, "this build has %s alone; -DWEFT_ISA=all builds all",
                    names[from]);
    if (isa > (int)widest)
        return fail(error, WEFT_MESSAGE_ISA, name, "this processor, or this build, has at most %s",
                    names[widest]);
    *chosen = name ? (Isa)isa : widest;
    return WEFT_OK;
}

WeftResult weft_isa_use(const char *name, WeftError *error) {
    return isa_choose(name, isa_least(), isa_widest(), &isa_used, error);
}

/* Chooses the widest set before anything else is called. */
__attribute__((constructor)) static void begin(void) { isa_used = isa_widest(); }
