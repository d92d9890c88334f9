/* isa.h - the set of instructions that loops over arrays run with
 *
 * Loops (loop.h) are compiled once for each set, or for one alone (WEFT_ISA in cmake/isa.cmake), and a call runs the one in
 * use: the widest that the processor has, unless weft_isa_use pinned another. */
#pragma once

/* Each includes those before it. */
typedef enum Isa { ISA_SSE2 = 0, ISA_AVX2, ISA_AVX512, ISA_COUNT } Isa;

#ifdef PLUGIN_LOOPS /* a lobe from outside reads that of the library that loaded it (plugin.h) */
#define isa_used (*plugin_isa)
#else
extern Isa isa_used;
#endif
