/* isa_choice.h - which set of instructions loops may run with on a processor */
#ifndef WEFT_SHADING_ISA_CHOICE_H
#define WEFT_SHADING_ISA_CHOICE_H

#include "shading/dialect/isa.h"
#include "weft/isa.h"

/* Returns the widest set that this processor runs and that loops were compiled for. */
Isa isa_widest(void);

/* Finds the set of that name, at most the widest; NULL names the widest. Fails as weft_isa_use does. */
WeftResult isa_choose(const char *name, Isa widest, Isa *chosen, WeftError *error);

#endif
