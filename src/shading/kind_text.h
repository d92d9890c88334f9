/* kind_text.h - the text of stacks once more, for what a file that cmake/kinds.cmake made says is known */
#ifndef WEFT_SHADING_KIND_TEXT_H
#define WEFT_SHADING_KIND_TEXT_H

#define HAS_LAYERED_SHEEN(m) (HAS_SHEEN(m) && (m)->color.r + (m)->color.g + (m)->color.b > 0.0f)
#include "shading/kind.h"
#include "shading/stack_steps.h"

static Choices known_choices(void) {
    Choices c = choices_unmade();
    c.profile = KIND_PROFILE;
    return c;
}

/* The compiler takes what this says for granted. */
FN bool is_known(const Stack *m) {
    return m->layer == KIND_LAYER && m->combine == LAYER_BY_MAX && m->base_fresnel == KIND_BASE_FRESNEL &&
           m->albedo == KIND_ALBEDO && m->view == VIEW_PLAIN;
}
#define KNOWN(m)                                                                                             \
    if (!is_known(m)) __builtin_unreachable()

#define HOLDS_NO_OTHER(name, NAME, Name, wo) &&(!(m->name.normal > 0.0f) || m->name.lobe.id == name##_lobe)
#define SAME_CHOICE(name, help)              &&c.name == known.name
static bool fits(const Stack *m, const Choices *choices) {
    const Choices known = known_choices();
    Choices c = *choices;
    if (c.profile == 0) c.profile = CHOICE_AUTO; /* the first of either list is what auto comes to */
    if (c.workflow == 0) c.workflow = CHOICE_AUTO;
    bool has_e = !HAS_SHEEN(m) || (m->table.kind == TABLE_ROOTS && m->table.tilts == 0);
    return has_e && is_known(m) SLOTS(HOLDS_NO_OTHER) SURFACE_CHOICES(SAME_CHOICE);
}

static void make(Stack *stack, const Surface *surface, const Choices *choices, TableRef e) {
    compose_stack(stack, surface, known_choices(), e);
}

static void see(const Stack *stack, const Dir *o, StackView *view) {
    KNOWN(stack);
    stack_view(stack, *o, view);
}

static void eval(const Stack *stack, const StackView *view, const Dir *i, uint32_t seed, StackValue *value) {
    KNOWN(stack);
    steps_eval(stack, view, i, seed, value);
}

static void sample(const Stack *stack, const StackView *view, float u, float v, Dir *i) {
    steps_sample(stack, view, u, v, i);
}

const StackKind KIND = {fits, make, see, eval, sample};

#endif
