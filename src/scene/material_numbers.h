/* material_numbers.h - a Material as the plain numbers of weft/material.h, and back */
#ifndef WEFT_SCENE_MATERIAL_NUMBERS_H
#define WEFT_SCENE_MATERIAL_NUMBERS_H

#include "scene/scene.h"
#include "weft/material.h"

/* Sanitises a caller's numbers: they become finite and are clamped to their hard range. Unknown choices
 * become auto, unknown modes opaque. The name becomes "". Textures are ignored. */
Material material_of_numbers(const WeftMaterial *numbers);

/* The numbers of a material: byte by byte equal for equal materials, since there is no padding and nothing
 * where an input has no number. */
void numbers_of_material(const Material *material, WeftMaterial *out);

/* Fails with WEFT_MESSAGE_PARAM_VALUE if a choice does not exist or a value is not finite. */
WeftResult numbers_sound(const WeftMaterial *numbers, WeftError *error);

/* A value clamped to the hard range of an input, angles in radians; NaN becomes its lower end. */
float input_clamped(InputId input, float value);

#endif
