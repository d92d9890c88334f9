/* stack_sample.h - directions of light drawn by the lobes of a stack */
#pragma once

#include "shading/dialect/warp.h"
#include "shading/material/stack_value.h"

/* The slots by number, in the order of SLOTS. */
#define PLACE_NONE                       (-1)
#define SLOT_PLACE(name, NAME, Name, wo) PLACE_##NAME,
enum { SLOTS(SLOT_PLACE) SLOT_COUNT };

/* Transforms a direction from the coat's frame into the shading frame, the inverse of stack_to_coat. */
FN Dir stack_from_coat(const Stack *s, Dir w) {
    return dir(w.x * s->coat_x.x + w.y * s->coat_y.x + w.z * s->coat_z.x,
               w.x * s->coat_x.y + w.y * s->coat_y.y + w.z * s->coat_z.y,
               w.x * s->coat_x.z + w.y * s->coat_y.z + w.z * s->coat_z.z);
}

/* Returns true for a share p of samples. Rescales u to [0, 1). */
FN bool stack_takes(float p, float *u) {
    float x = *u;
    bool through = x < p;
    *u = min(max((through ? x : x - p) / max(through ? p : 1.0f - p, 1e-12f), 0.0f), 0.99999994f);
    return through;
}

/* Returns true for the share of the diffuse slot's samples that is transmitted. Rescales u to [0, 1). */
FN bool stack_takes_transmitted(const Stack *stack, float *u) { return stack_takes(stack->transmitted_p, u); }

#define TAKE_SLOT(name, NAME, Name, wo)                                                                                \
    if (view->select_p.name > 0.0f && (slot < 0 || *u >= at)) {                                                        \
        slot = PLACE_##NAME;                                                                                           \
        begin = at;                                                                                                    \
        width = view->select_p.name;                                                                                   \
        at = at + width;                                                                                               \
    }
/* Returns the slot that u in [0, 1) selects, by its place in SLOTS, or PLACE_NONE. Rescales u to [0, 1). */
FN int stack_slot_of(const StackView *view, float *u) {
    int slot = PLACE_NONE;
    float begin = 0.0f, at = 0.0f, width = 1.0f;
    SLOTS(TAKE_SLOT)
    *u = min(max((*u - begin) / max(width, 1e-12f), 0.0f), 0.99999994f); /* the rest is as good as new */
    return slot;
}

#define SAMPLE_SLOT(name, NAME, Name, wo)                                                                              \
    if (HAS_##NAME(stack) && slot == PLACE_##NAME && view->wo.z > 0.0f)                                                \
        IN_SLOT(name, sample_at)(stack->name.lobe.id, &stack->name##_prepared, &view->name##_view, &view->wo, u, v, i);

/* Draws the mirror image above the surface of a direction from which light comes through thin glass. */
FN void stack_draw_glass(const Stack *stack, const StackView *view, float u, float v, Dir *i) {
    bool evenly = stack_takes(stack_glass_lost(stack, view->o.z), &u);
    IN_SLOT(specular, sample_at)
    (stack->specular.lobe.id, &stack->specular_prepared, &view->specular_view, &view->o, u, v, i);
    if (evenly) *i = warp_cosine(u, v);
}

/* Works as stack_sample of material_stack.h. */
FN void stack_draw_direction(const Stack *stack, const StackView *view, float u, float v, Dir *i) {
    int slot = stack_slot_of(view, &u);
    bool through = false, clear = false;
    *i = dir(0.0f, 0.0f, -1.0f);
    if (HAS_TRANSMITTED(stack) && slot == PLACE_DIFFUSE) through = stack_takes_transmitted(stack, &u);
    if (through) {
        Dir above = warp_cosine(u, v);
        *i = dir(above.x, above.y, -above.z);
        return;
    }
    if (HAS_GLASS(stack) && slot == PLACE_DIFFUSE)
        clear = stack_takes(stack->glass_p / max(1.0f - stack->transmitted_p, 1e-12f), &u);
    if (HAS_GLASS(stack) && clear) {
        Dir above = *i;
        stack_draw_glass(stack, view, u, v, &above);
        *i = dir(above.x, above.y, -max(above.z, 0.0f));
        return;
    }
    bool of_base = slot == PLACE_DIFFUSE || slot == PLACE_SPECULAR, opposite = false;
    if (HAS_RETRO(stack) && of_base) opposite = stack_takes(stack->retro, &u);
    SLOTS(SAMPLE_SLOT)
    if (HAS_RETRO(stack) && opposite) *i = dir_opposite(*i);
    if (HAS_COAT(stack) && slot == PLACE_COAT && i->z > 0.0f) *i = stack_from_coat(stack, *i);
    if (HAS_TRANSMITTED(stack)) i->z = max(i->z, 0.0f); /* what a lobe draws below is no sample */
}
