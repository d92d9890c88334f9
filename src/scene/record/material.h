/* material.h - the material of a surface: each input of shading/stack/inputs.h as a number or a texture times a
 * number */
#pragma once

#include "scene/record/texture.h"
#include "shading/stack/input_ids.h"
#include "weft/material.h"

/* The material of the public header is the scene's own: its inputs are indexed by InputId, its choices by ChoiceId.
 * Past the last of either, and where an input has no number, all is zero, so that equal materials are equal bytes. */
typedef WeftMaterial Material;
typedef WeftInput Input;

_Static_assert((int)INPUT_COUNT <= (int)WEFT_INPUTS_MAX && (int)CHOICE_COUNT <= (int)WEFT_CHOICES_MAX,
               "weft/material.h has too few inputs or choices");

extern const WeftInputInfo input_infos[INPUT_COUNT];
extern const InputRole input_roles[INPUT_COUNT];
extern const WeftInputInfo hair_infos[WEFT_HAIR_NUMBERS];

/* Returns the index of a number of hair by its name, or -1. */
int hair_find(const char *name);

/* Returns the count of numbers in the value of an input: 3 for a colour, else 1. */
int input_value_count(InputId input);

/* Returns true if both inputs have the same texture, set of coordinates and placement. */
bool input_same_texels(const Input *a, const Input *b);

/* Returns a material with all defaults: no textures, identity transforms, opaque, single-sided, all choices
 * automatic. */
Material material_default(void);

/* Sets the colour of an input, linear. */
void material_set_color(Material *material, InputId input, float r, float g, float b);

/* Sets an input's number so that its texture alone counts: 1, the greatest angle, or 0 added to a direction. */
void input_set_map_factor(Input *input, InputId id);

/* Sets a choice. Inputs with other defaults in a workflow (disney, and profile disney-2012: specular 0.5, sheen 0;
 * specular and free: specular_color 0.03) change from default to default, unless they are given, have a texture or
 * another value. */
void material_choose(Material *material, ChoiceId choice, int value);
