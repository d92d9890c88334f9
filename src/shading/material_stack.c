#include "shading/stack_steps.h"

void stack_make(Stack *stack, const Surface *surface, const Choices *choices, TableRef e) {
    Choices settled = *choices;
    Surface own;
    if (convert_wanted(settled) || compose_evens(settled)) {
        own = convert_surface(*surface, settled);
        settled = convert_choices(settled);
        compose_surface(&own, settled);
        surface = &own;
    }
    compose_stack(stack, surface, settled, e);
}

void stack_see(const Stack *stack, const Dir *o, StackView *view) { stack_view(stack, *o, view); }

void seen_make(SeenStack *seen, const Surface *surface, const Choices *choices, TableRef e, Dir o) {
    stack_make(&seen->stack, surface, choices, e);
    stack_see(&seen->stack, &o, &seen->view);
}

void seen_settle(SeenStack *seen, Dir o) {
    stack_prepare(&seen->stack);
    stack_see(&seen->stack, &o, &seen->view);
}

StackValue stack_eval_of(const Stack *stack, const StackView *view, Slots only, Dir i) {
    if (view->o.z <= 0.0f || i.z <= 0.0f) return (StackValue){0};
    return value_of(stack, view, only, i);
}

void stack_eval(const Stack *stack, const StackView *view, const Dir *i, uint32_t seed, StackValue *value) {
    steps_eval(stack, view, i, seed, value);
}

int stack_pick(const StackView *view, float *u) { return steps_pick(view, u); }

void stack_sample(const Stack *stack, const StackView *view, float u, float v, Dir *i) {
    steps_sample(stack, view, u, v, i);
}
