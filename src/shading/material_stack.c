#include "shading/material_stack.h"

void stack_make(Stack *stack, const Surface *surface, const Choices *choices, TableRef e, Dir o) {
    surface_stack(stack, surface, *choices, e, o);
}

static Dir from_coat(const Stack *s, Dir w) {
    return dir(w.x * s->coat_x.x + w.y * s->coat_y.x + w.z * s->coat_z.x,
               w.x * s->coat_x.y + w.y * s->coat_y.y + w.z * s->coat_z.y,
               w.x * s->coat_x.z + w.y * s->coat_y.z + w.z * s->coat_z.z);
}

static Angles coat_angles(const Stack *stack, Dir o, Dir i, Angles a) {
    return stack->coat.pick > 0.0f ? angles_between(stack_to_coat(stack, o), stack_to_coat(stack, i)) : a;
}

StackValue stack_eval_of(const Stack *stack, Slots only, Dir o, Dir i) {
    if (o.z <= 0.0f || i.z <= 0.0f) return (StackValue){0};
    Angles a = angles_between(o, i);
    return stack_value_of(stack, only, a, coat_angles(stack, o, i, a));
}

StackValue stack_eval(const Stack *stack, Dir o, Dir i, uint32_t seed) {
    StackValue value = {0};
    if (o.z <= 0.0f || i.z <= 0.0f) return value; /* whatever the coat's own normal may see */
    Angles a = angles_between(o, i);
    value = stack_value(stack, a, coat_angles(stack, o, i, a));
    Rgb more = sheet_bounces(stack, slots_all(), o, i, seed);
    value.f_cos = rgb_add(value.f_cos, more);
    return value;
}

const Slot *stack_pick(const Stack *stack, float *u) {
    const Slot *slots[] = {&stack->diffuse, &stack->specular, &stack->sheen, &stack->coat, &stack->dust},
               *slot = NULL;
    float begin = 0.0f, at = 0.0f;
    for (int k = 0; k < 5; k++) {
        if (!(slots[k]->pick > 0.0f)) continue;
        if (slot && *u < at) break;
        slot = slots[k];
        begin = at;
        at += slot->pick;
    }
    /* the rest of u is as good as new */
    if (slot) *u = min(max((*u - begin) / max(slot->pick, 1e-12f), 0.0f), 0x1.fffffep-1f);
    return slot;
}

Dir stack_sample(const Stack *stack, Dir o, float u, float v) {
    const Slot *slot = stack_pick(stack, &u);
    Dir none = dir(0.0f, 0.0f, -1.0f);
    if (!slot) return none;
    if (slot != &stack->coat) return lobe_sample(&slot->lobe, o, u, v);
    Dir oc = stack_to_coat(stack, o), ic = none;
    if (oc.z > 0.0f) ic = lobe_sample(&slot->lobe, oc, u, v);
    return ic.z > 0.0f ? from_coat(stack, ic) : none;
}
