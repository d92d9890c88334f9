/* isa.h - the instruction set of loops over arrays
 *
 * The library has its loops for SSE2, AVX2 and AVX-512, and uses the widest set that the processor supports. A library
 * that was built for one machine alone (WEFT_ISA in CMakeLists.txt) has the set of that machine only. Results
 * differ between sets in their last bits. Pin a set to reproduce an image of another processor, or compare speeds. */
#ifndef WEFT_ISA_H
#define WEFT_ISA_H

#include "weft/result.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Returns "sse2", "avx2" or "avx512", the widest last; NULL beyond. */
WEFT_API const char *weft_isa_name(int isa);

/* Returns the name of the set in use. */
WEFT_API const char *weft_isa(void);

/* Pins the set for the whole process; NULL: the widest. Must not run beside another call of the library; make existing
 * renders anew. Fails with WEFT_MESSAGE_ISA_NAME, or WEFT_MESSAGE_ISA where the processor or the
 * library lacks it. */
WEFT_API WeftResult weft_isa_use(const char *name, WeftError *error);

#ifdef __cplusplus
}
#endif

#endif
