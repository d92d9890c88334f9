#include "shading/material/stack_steps.h"

void stack_make(Stack *stack, const Surface *surface, const Choices *choices, TableRef e) {
    Choices converted;
    Surface own;
    if (convert_wanted(*choices) || compose_evens(*choices)) {
        own = convert_surface(*surface, *choices);
        converted = convert_choices(*choices);
        compose_surface(&own, converted);
        surface = &own;
        choices = &converted;
    }
    compose_stack(stack, surface, *choices, e);
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

StackValue stack_eval_of(const Stack *stack, const StackView *view, Slots only, Dir i) {
    if (view->o.z <= 0.0f) return (StackValue){0};
    return value_of(stack, view, only, i);
}

void stack_eval(const Stack *stack, const StackView *view, const Dir *i, uint32_t seed, StackValue *value) {
    steps_eval(stack, view, i, seed, value);
}

int stack_select_slot(const StackView *view, float *u) { return steps_select(view, u); }

void stack_sample(const Stack *stack, const StackView *view, float u, float v, Dir *i) {
    steps_sample(stack, view, u, v, i);
}
