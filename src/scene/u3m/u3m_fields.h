/* u3m_fields.h - the members of a visual part of a U3M file, and the inputs that show them
 *
 * Vizoo and Browzwear, "Unified 3D Material", schema 1.1, 2020, "visualisation": names, defaults and ranges. */
#pragma once

#include "scene/record/material.h"

typedef enum U3mKind { U3M_NUMBER, U3M_COLOR, U3M_NORMAL } U3mKind;

/* One member. An input's value is offset + scale times the member's; angles are in degrees. */
typedef struct U3mField {
    const char *name;
    U3mKind kind;
    int input;                /* an InputId; -1: no input shows it */
    float initial, low, high; /* of the member; a colour has the same in all channels */
    float scale, offset;
} U3mField;

/* Returns a row of the table by its index, NULL past the end. A member that two inputs show has two rows; the first is
 * the one that is written. */
const U3mField *u3m_field(int index);
