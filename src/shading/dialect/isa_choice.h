/* isa_choice.h - which set of instructions loops may run with on a processor */
#pragma once

#include "shading/dialect/isa.h"
#include "weft/isa.h"

/* Returns the least set that loops were compiled for. */
Isa isa_least(void);

/* Returns the widest set of this processor; avx2 and avx512 name the levels v3 and v4 of x86-64. */
Isa isa_of_processor(void);

/* Returns the widest set that this processor runs and that loops were compiled for. */
Isa isa_widest(void);

/* Finds the set of that name, from the least to the widest; NULL names the widest. Fails as weft_isa_use does. */
WeftResult isa_choose(const char *name, Isa least, Isa widest, Isa *chosen, WeftError *error);

/* Returns what a processor with that set lacks of what this build needs, such as "AVX-512"; NULL if nothing. */
const char *isa_lacking(Isa processor);
