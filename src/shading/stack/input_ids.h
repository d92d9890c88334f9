/* input_ids.h - the inputs and choices of inputs.h by number, for those that keep them in arrays */
#pragma once

#include "shading/stack/inputs.h"

typedef enum InputId {
#define INPUT_ENUM(kind, name, label, initial, low, high, hard_low, hard_high, role, help) INPUT_##name,
    SURFACE_INPUTS(INPUT_ENUM)
#undef INPUT_ENUM
        INPUT_COUNT
} InputId;

/* Roles of inputs: see inputs.h. */
typedef enum InputRole { ROLE_NONE, ROLE_SHAPE, ROLE_HALF, ROLE_MIX, ROLE_WHOLE } InputRole;

typedef enum ChoiceId {
#define CHOICE_ENUM(name, help) CHOICE_##name,
    SURFACE_CHOICES(CHOICE_ENUM)
#undef CHOICE_ENUM
        CHOICE_COUNT
} ChoiceId;
