/* stack_steps.h - a stack in C evaluated and sampled: the text of material_stack.c and of each kind */
#ifndef WEFT_SHADING_STACK_STEPS_H
#define WEFT_SHADING_STACK_STEPS_H

#include "shading/material_stack.h"

FN Dir from_coat(const Stack *s, Dir w) {
    return dir(w.x * s->coat_x.x + w.y * s->coat_y.x + w.z * s->coat_z.x,
               w.x * s->coat_x.y + w.y * s->coat_y.y + w.z * s->coat_z.y,
               w.x * s->coat_x.z + w.y * s->coat_y.z + w.z * s->coat_z.z);
}

/* Both above the horizon, whatever the coat's own normal may see. */
FN StackValue value_of(const Stack *stack, const StackView *view, Slots only, Dir i) {
    Angles a = angles_between(view->o, i), in_coat;
    const Angles *coat = &a;
    if (HAS_COAT(stack)) {
        in_coat = angles_between(view->coat_o, stack_to_coat(stack, i));
        coat = &in_coat;
    }
    return stack_value_of(stack, view, only, &a, coat);
}

FN void steps_eval(const Stack *stack, const StackView *view, const Dir *i, uint32_t seed,
                   StackValue *value) {
    *value = (StackValue){0};
    if (view->o.z <= 0.0f || i->z <= 0.0f) return;
    *value = value_of(stack, view, slots_all(), *i);
    if (stack->layer == LAYER_STOCHASTIC)
        value->f_cos = rgb_add(value->f_cos, layer_walk_bounces(stack, view, slots_all(), *i, seed));
}

#define TAKE_SLOT(name, NAME, Name, wo)                                                                      \
    if (view->select_p.name > 0.0f && (slot < 0 || *u >= at)) {                                              \
        slot = PLACE_##NAME;                                                                                 \
        begin = at;                                                                                          \
        width = view->select_p.name;                                                                         \
        at += width;                                                                                         \
    }
FN int steps_select(const StackView *view, float *u) {
    int slot = PLACE_NONE;
    float begin = 0.0f, at = 0.0f, width = 1.0f;
    SLOTS(TAKE_SLOT)
    *u = min(max((*u - begin) / max(width, 1e-12f), 0.0f), 0x1.fffffep-1f); /* the rest is as good as new */
    return slot;
}

#define SAMPLE_SLOT(name, NAME, Name, wo)                                                                    \
    case PLACE_##NAME:                                                                                       \
        if (view->wo.z > 0.0f) IN_SLOT(name, sample_at)                                                      \
        (stack->name.lobe.id, &stack->name##_prepared, &view->name##_view, &view->wo, u, v, i);              \
        break;
FN void steps_sample(const Stack *stack, const StackView *view, float u, float v, Dir *i) {
    *i = dir(0.0f, 0.0f, -1.0f);
    int slot = steps_select(view, &u);
    switch (slot) { SLOTS(SAMPLE_SLOT) }
    if (slot == PLACE_COAT && i->z > 0.0f) *i = from_coat(stack, *i);
}

#endif
