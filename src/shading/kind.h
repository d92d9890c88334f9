/* kind.h - the stack in C for a material: its text with the structure known, or that of any lobes
 *
 * A kind is a row of kinds.list: which lobe a slot may hold, the layer rule, what dims the diffuse lobe,
 * where E comes from. The text of a stack is one; a kind is that text compiled with these as constants. Its
 * stacks and views are those of material_stack.h, whose functions take them too. */
#ifndef WEFT_SHADING_KIND_H
#define WEFT_SHADING_KIND_H

#include "shading/material_stack.h"

/* The functions of material_stack.h, for what fits alone. */
typedef struct StackKind {
    bool (*fits)(const Stack *plain, const Choices *choices);
    void (*make)(Stack *stack, const Surface *surface, const Choices *choices, TableRef e);
    void (*see)(const Stack *stack, const Dir *o, StackView *view);
    void (*eval)(const Stack *stack, const StackView *view, const Dir *i, uint32_t seed, StackValue *value);
    void (*sample)(const Stack *stack, const StackView *view, float u, float v, Dir *i);
} StackKind;

/* The kind of a material, the one of any lobes if no other fits. plain: its stack where all its textures are
 * 1, which is their most; NULL: that one anyway. */
const StackKind *stack_kind(const Stack *plain, const Choices *choices);

#endif
