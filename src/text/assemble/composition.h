/* composition.h - a material's composition as text that is specialised to its choices */
#ifndef WEFT_TEXT_COMPOSITION_H
#define WEFT_TEXT_COMPOSITION_H

#include "scene/record/material_at.h"
#include "text/assemble/dispatch.h"

/* A surface in which every lobe of a stack shows, but for the inputs that are zero; x is 0, 1/2 or 1 for what
 * a stack may make a choice of. */
Surface composition_surface(float x, const bool zero[INPUT_COUNT]);

/* The possible contents of a stack's slots: ids, and the first lobe of each with its parameters. */
typedef struct CompositionSlots {
    TextSlot slots[SLOT_COUNT];
    Lobe lobes[SLOT_COUNT];
    bool used;      /* no layer rule could do without a sheen */
    bool transmits; /* a base lets light through */
} CompositionSlots;

/* whole_sheen: input sheen is 1 everywhere. */
CompositionSlots composition_slots(const Choices *choices, const bool zero[INPUT_COUNT], bool whole_sheen);

/* The lobes of these slots, in place of what shading/stack/slots.h has, and what is known of them and of the
 * sheen's table in place of what shading/stack/stack.h and table.h ask. Call it before text_composition. */
void text_composition_lobes(Text *text, const CompositionSlots *slots, int table_kind, int table_tilts);

/* In place of shading/material/profile.h: the one composition, with the tables of its engine; and shading/material/stack_value.h
 * behind it. */
void text_composition(Text *text, const Choices *choices);

/* Choices material_choices(): these. */
void text_composition_choices(Text *text, const Choices *choices);

/* The call that makes its stack, "khronos_stack(m, s)". */
const char *composition_stack(const Choices *choices);

#endif
