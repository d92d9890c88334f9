/* weave_sum.h - the bases of a material: its own, or the warp and weft of a weave, whose sum is the base from afar
 *
 *   f = f(base 0, and what lies on it) + f(base 1)
 *
 * Sheen, coat and dust lie on the whole cloth: they are counted only with base 0. */
#pragma once

#include "shading/material/material_stack.h"
#include "weave/cloth_base.h"

typedef struct WeaveSum {
    int bases;              /* 1, of the material, or 2 */
    WeaveBase threads[2];   /* warp and weft, if there are 2 */
    WovenPrepared woven[2]; /* their prepared lobes */
} WeaveSum;

/* Returns the systems of a cloth; NULL: the base of the material. */
WeaveSum weave_sum_of(const WeftCloth *cloth);

/* Returns the sum of two lobes woven with their own parameters, unlike those of a cloth. */
WeaveSum weave_sum_of_lobes(const WeaveBase threads[2]);

/* Sees base number `base`, and what lies on it, from o. e: as in stack_make. */
void weave_sum_see(const WeaveSum *self, int base, const Surface *surface, const Choices *choices, TableRef e, Dir o,
                   SeenStack *seen);

/* Returns those of the slots that are counted with a base. */
Slots weave_sum_slots(int base, Slots slots);

/* Returns approximately the fraction of the light reflected by both systems that comes from the first. */
float weave_sum_first(const WeaveSum *self);
