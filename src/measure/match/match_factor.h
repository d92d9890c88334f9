/* match_factor.h - the factors of a glTF material that a match changes, and how they are written */
#pragma once

#include <jansson.h>

#include "gltf/asset/material_fields.h"
#include "weft/material.h"

/* The inputs that a match may change. */
enum { FACTORS = 5 };
extern const InputId match_factors[FACTORS];

/* Locks every input but these. */
void factors_unlock(int locked[WEFT_INPUTS_MAX]);

/* Returns the object of that name in `object`; adds an empty one if there is none. */
json_t *factor_home(json_t *object, const char *name);

/* Writes a factor to the object of its field, rounded to 1e-6. The alpha of a colour stays. */
void factor_put(json_t *home, const MaterialField *field, const float *value);
