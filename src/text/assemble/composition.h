/* composition.h - a material's composition as text that is specialised to its choices */
#pragma once

#include "scene/record/material_at.h"
#include "text/assemble/dispatch.h"

/* Returns a surface that shows every lobe of a stack, by the roles of the inputs (inputs.h). x: the value of those of
 * role MIX, 0, 1/2 or 1. zero: inputs that are 0. */
Surface composition_surface(float x, const bool zero[INPUT_COUNT]);

/* The possible contents of a stack's slots: ids, and the first lobe of each with its parameters. */
typedef struct CompositionSlots {
    TextSlot slots[SLOT_COUNT];
    Lobe lobes[SLOT_COUNT];
    TextSlot begun; /* highlights that choices of D, V and F then replace by one of the same alphas */
    bool used;      /* no layer rule may leave out a black sheen (IS_BELOW_F) */
    bool transmits; /* a base transmits light */
    bool glass;     /* a base transmits as glass does */
    bool retro;     /* a base turns light back */
    bool sampled;   /* set by the caller: the text draws directions by the lobes (stack_sample.h) */
} CompositionSlots;

/* Returns the possible contents of a stack's slots, for choices and the inputs that are zero. whole_sheen: input sheen
 * is 1 everywhere. */
CompositionSlots composition_slots(const Choices *choices, const bool zero[INPUT_COUNT], bool whole_sheen);

/* Writes the lobes of these slots in place of shading/stack/slots.h, and defines the constants about them and the
 * sheen's table that shading/stack/stack.h and table.h read. Call it before text_composition. */
void text_composition_lobes(Text *text, const CompositionSlots *slots, int table_kind, int table_tilts);

/* Writes the one composition in place of shading/material/profile.h, with the tables of its engine, and then
 * shading/material/stack_value.h. */
void text_composition(Text *text, const Choices *choices);

/* Writes the function Choices material_choices(), which returns these. */
void text_composition_choices(Text *text, const Choices *choices);

/* Returns the call that makes the stack of a composition, such as "khronos_stack(m, s)". */
const char *composition_stack(const Choices *choices);
