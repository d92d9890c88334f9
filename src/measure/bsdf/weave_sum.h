/* weave_sum.h - the bases of a material: its own, or warp and weft of a weave in its place, whose sum it is from afar
 *
 *   f = f(base 0, and what lies on it) + f(base 1)
 *
 * Sheen, coat and dust lie on the cloth as a whole: they count once, with base 0. */
#ifndef WEFT_MEASURE_WEAVE_SUM_H
#define WEFT_MEASURE_WEAVE_SUM_H

#include "shading/material/material_stack.h"
#include "weave/cloth_base.h"

typedef struct WeaveSum {
    int bases;              /* 1, the material's own, or 2 */
    WeaveBase threads[2];   /* of 2: warp and weft */
    WovenPrepared woven[2]; /* and their lobes, prepared */
} WeaveSum;

/* The systems of a cloth; NULL: the material's own base. */
WeaveSum weave_sum_of(const WeftCloth *cloth);

/* The sum of two lobes woven as their numbers alone say them, unlike those of a cloth. */
WeaveSum weave_sum_of_lobes(const WeaveBase threads[2]);

/* Sees base number so, and what lies on it, from o. e: as stack_make has it. */
void weave_sum_see(const WeaveSum *self, int base, const Surface *surface, const Choices *choices, TableRef e,
                   Dir o, SeenStack *seen);

/* Returns those of the slots that count with a base. */
Slots weave_sum_slots(int base, Slots slots);

/* Returns about what part of what both systems send back comes from the first. */
float weave_sum_first(const WeaveSum *self);

#endif
