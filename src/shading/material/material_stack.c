#include "shading/material/material_stack.h"

void stack_make(Stack *stack, const Surface *surface, const Choices *choices, TableRef e) {
    surface_stack(stack, surface, *choices, e);
}

void stack_put_base(Stack *stack, const Lobe *lobe, Rgb f0, Rgb f90) { compose_base(stack, *lobe, f0, f90); }

void stack_see(const Stack *stack, const Dir *o, StackView *view) { stack_view(stack, *o, view); }

void seen_make(SeenStack *seen, const Surface *surface, const Choices *choices, TableRef e, Dir o) {
    stack_make(&seen->stack, surface, choices, e);
    stack_see(&seen->stack, &o, &seen->view);
}

void seen_prepare(SeenStack *seen, Dir o) {
    stack_prepare(&seen->stack);
    stack_see(&seen->stack, &o, &seen->view);
}

/* Returns f cos and pdf for i. wo is above the horizon of the surface; it may be below that of the coat's own
 * normal. */
FN StackValue value_of(const Stack *stack, const StackView *view, Slots only, Dir i) {
    if (i.z <= 0.0f && !(i.z < 0.0f && only.diffuse && HAS_TRANSMITTED(stack))) return (StackValue){0};
    Angles a = angles_between(view->o, dir(i.x, i.y, abs(i.z))), in_coat;
    if (i.z < 0.0f) return stack_transmitted(stack, view, &a);
    const Angles *coat = &a;
    if (HAS_COAT(stack)) {
        in_coat = angles_between(view->coat_o, stack_to_coat(stack, i));
        coat = &in_coat;
    }
    return stack_value_of(stack, view, only, &a, coat);
}

StackValue stack_eval_of(const Stack *stack, const StackView *view, Slots only, Dir i) {
    if (view->o.z <= 0.0f) return (StackValue){0};
    return value_of(stack, view, only, i);
}

Rgb stack_clear_f_cos(const Stack *stack, const StackView *view, Dir i) {
    if (!HAS_GLASS(stack) || view->o.z <= 0.0f || i.z >= 0.0f) return rgb_grey(0.0f);
    const Angles a = angles_between(view->o, dir(i.x, i.y, -i.z));
    return stack_through_glass(stack, view, &a).f_cos;
}

Rgb stack_straight(const Stack *stack, const StackView *view) { return stack_glass_straight(stack, view); }

void stack_eval(const Stack *stack, const StackView *view, const Dir *i, uint32_t seed, StackValue *value) {
    *value = (StackValue){0};
    if (view->o.z <= 0.0f) return;
    *value = value_of(stack, view, slots_all(), *i);
    if (stack->layer == LAYER_STOCHASTIC && i->z > 0.0f)
        value->f_cos = rgb_add(value->f_cos, layer_walk_bounces(stack, view, slots_all(), *i, seed));
}

int stack_select_slot(const StackView *view, float *u) { return stack_slot_of(view, u); }

void stack_sample(const Stack *stack, const StackView *view, float u, float v, Dir *i) {
    stack_draw_direction(stack, view, u, v, i);
}
