#include "shading/material_stack.h"

#define SLOT_PLACE(name, NAME, Name, wo) PLACE_##NAME,
enum { PLACE_NONE = -1, SLOTS(SLOT_PLACE) };

void stack_make(Stack *stack, const Surface *surface, const Choices *choices, TableRef e) {
    surface_stack(stack, surface, *choices, e);
}

void stack_see(const Stack *stack, Dir o, StackView *view) { stack_view(stack, o, view); }

void seen_make(SeenStack *seen, const Surface *surface, const Choices *choices, TableRef e, Dir o) {
    stack_make(&seen->stack, surface, choices, e);
    stack_see(&seen->stack, o, &seen->view);
}

void seen_settle(SeenStack *seen, Dir o) {
    stack_prepare_lobes(&seen->stack);
    stack_see(&seen->stack, o, &seen->view);
}

static Dir from_coat(const Stack *s, Dir w) {
    return dir(w.x * s->coat_x.x + w.y * s->coat_y.x + w.z * s->coat_z.x,
               w.x * s->coat_x.y + w.y * s->coat_y.y + w.z * s->coat_z.y,
               w.x * s->coat_x.z + w.y * s->coat_y.z + w.z * s->coat_z.z);
}

/* The same pair in the coat's frame, where there is one. */
static inline __attribute__((always_inline)) void coat_angles(const Stack *stack, const StackView *view,
                                                              Dir i, Angles *coat) {
    if (HAS_COAT(stack)) *coat = angles_between(view->coat_o, stack_to_coat(stack, i));
}

StackValue stack_eval_of(const Stack *stack, const StackView *view, Slots only, Dir i) {
    if (view->o.z <= 0.0f || i.z <= 0.0f) return (StackValue){0};
    Angles a = angles_between(view->o, i), coat = {0};
    coat_angles(stack, view, i, &coat);
    return stack_value_of(stack, view, only, &a, &coat);
}

StackValue stack_eval(const Stack *stack, const StackView *view, Dir i, uint32_t seed) {
    StackValue value = {0};
    if (view->o.z <= 0.0f || i.z <= 0.0f) return value; /* whatever the coat's own normal may see */
    Angles a = angles_between(view->o, i), coat = {0};
    coat_angles(stack, view, i, &coat);
    value = stack_value(stack, view, &a, &coat);
    if (stack->layer == LAYER_STOCHASTIC)
        value.f_cos = rgb_add(value.f_cos, sheet_bounces(stack, view, slots_all(), i, seed));
    return value;
}

#define TAKE_SLOT(name, NAME, Name, wo)                                                                      \
    if (view->pick.name > 0.0f && (slot < 0 || *u >= at)) {                                                  \
        slot = PLACE_##NAME;                                                                                 \
        begin = at;                                                                                          \
        width = view->pick.name;                                                                             \
        at += width;                                                                                         \
    }
int stack_pick(const StackView *view, float *u) {
    int slot = PLACE_NONE;
    float begin = 0.0f, at = 0.0f, width = 1.0f;
    SLOTS(TAKE_SLOT)
    *u = min(max((*u - begin) / max(width, 1e-12f), 0.0f), 0x1.fffffep-1f); /* the rest is as good as new */
    return slot;
}

#define SAMPLE_SLOT(name, NAME, Name, wo)                                                                    \
    case PLACE_##NAME:                                                                                       \
        if (view->wo.z > 0.0f)                                                                               \
            lobe_sample_at(stack->name.lobe.id, &stack->name##_prepared, &view->name##_seen, &view->wo, u,   \
                           v, &i);                                                                           \
        break;
Dir stack_sample(const Stack *stack, const StackView *view, float u, float v) {
    Dir i = dir(0.0f, 0.0f, -1.0f);
    int slot = stack_pick(view, &u);
    switch (slot) { SLOTS(SAMPLE_SLOT) }
    return slot == PLACE_COAT && i.z > 0.0f ? from_coat(stack, i) : i;
}
