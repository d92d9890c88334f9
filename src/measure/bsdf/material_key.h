/* material_key.h - the part of a material that a reflection depends on: numbers and choices, without
 * textures */
#pragma once

#include <stdbool.h>
#include <string.h>

#include "weft/material.h"

/* Materials with the same key reflect alike. */
typedef struct MaterialKey {
    float values[WEFT_INPUTS_MAX][3];
    int given[WEFT_INPUTS_MAX];
    int choices[WEFT_CHOICES_MAX];
} MaterialKey;

static inline MaterialKey material_key(const WeftMaterial *material) {
    MaterialKey key;
    for (int k = 0; k < WEFT_INPUTS_MAX; k++) {
        memcpy(key.values[k], material->inputs[k].value, sizeof key.values[k]);
        key.given[k] = material->inputs[k].given;
    }
    memcpy(key.choices, material->choices, sizeof key.choices);
    return key;
}

static inline bool material_key_same(const MaterialKey *a, const MaterialKey *b) {
    return memcmp((const char *)a, (const char *)b, sizeof *a) == 0;
}
