/* material_stack.h - the stack of stack_value.h in C: made, seen, evaluated, sampled */
#pragma once

#include "shading/catalogue/albedo.h"
#include "shading/material/stack_sample.h"

#define SLOT_NAME(name, NAME, Name, wo) #name,
#define SLOT_AT(name, NAME, Name, wo)   &m->name,

static inline const char *slot_name(int place) {
    static const char *const names[] = {SLOTS(SLOT_NAME)};
    return names[place];
}
static inline const Slot *stack_slot(const Stack *m, int place) {
    const Slot *const slots[] = {SLOTS(SLOT_AT)};
    return slots[place];
}

/* One copy of each: the catalogue's text in every caller would multiply the program's size. Records are passed by
 * reference: passing them by value would take longer than to compute them. */
#define ONE_COPY __attribute__((noinline))

/* Fills stack for a surface; it serves all directions. e: the table of the sheen's E that surface_stack needs, of kind
 * TABLE_NONE if it needs none or the sheen is black. */
ONE_COPY void stack_make(Stack *stack, const Surface *surface, const Choices *choices, TableRef e);

/* Fills view for wo (shading frame, z > 0); it serves all wi, for that stack only. */
ONE_COPY void stack_see(const Stack *stack, const Dir *o, StackView *view);

/* Computes f cos and pdf for wi; for wi below the horizon, those of the transmitted light. seed: of the random walk
 * that layer rule stochastic takes between sheen and base, where f is an unbiased estimate. pdf never depends on it. */
ONE_COPY void stack_eval(const Stack *stack, const StackView *view, const Dir *i, uint32_t seed, StackValue *value);

/* Works as stack_eval, for some of the slots, and without the walk of layer rule stochastic. */
ONE_COPY StackValue stack_eval_of(const Stack *stack, const StackView *view, Slots only, Dir i);

/* Returns f cos of the light that comes straight through thin glass from wi below the horizon: the part of stack_eval
 * there that is no diffuse light. */
ONE_COPY Rgb stack_clear_f_cos(const Stack *stack, const StackView *view, Dir i);

/* Returns what of light from straight behind smooth thin glass goes on towards wo (stack_glass_straight). */
ONE_COPY Rgb stack_straight(const Stack *stack, const StackView *view);

/* Computes a wi for (u, v) in [0, 1)^2. If there is no sample, wi is at the horizon, or below it if nothing is
 * transmitted. */
ONE_COPY void stack_sample(const Stack *stack, const StackView *view, float u, float v, Dir *i);

/* Returns the slot that u in [0, 1) selects, by its place in SLOTS, or -1 if there is none. Rescales u to [0, 1). */
int stack_select_slot(const StackView *view, float *u);

/* Returns, for layer rule stochastic, the light from wi that the slots in `last` reflected first and that then bounced
 * at least once between the base and the sheen's underside, times the cosine of wi; 0 for other rules. */
ONE_COPY Rgb layer_walk_bounces(const Stack *stack, const StackView *view, Slots last, Dir i, uint32_t seed);

/* A stack and its view from one direction. */
typedef struct SeenStack {
    Stack stack;
    StackView view;
} SeenStack;
void seen_make(SeenStack *seen, const Surface *surface, const Choices *choices, TableRef e, Dir o);
/* Puts a lobe with two colours in the place of the diffuse and the specular one. */
void stack_put_base(Stack *stack, const Lobe *lobe, Rgb f0, Rgb f90);
/* Prepares the view of a stack whose lobes were set by hand. */
void seen_prepare(SeenStack *seen, Dir o);
static inline StackValue seen_eval(const SeenStack *seen, Dir i, uint32_t seed) {
    StackValue value;
    stack_eval(&seen->stack, &seen->view, &i, seed, &value);
    return value;
}
static inline Dir seen_sample(const SeenStack *seen, float u, float v) {
    Dir i;
    stack_sample(&seen->stack, &seen->view, u, v, &i);
    return i;
}
