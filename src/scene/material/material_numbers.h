/* material_numbers.h - checking a material that a caller hands over */
#ifndef WEFT_SCENE_MATERIAL_NUMBERS_H
#define WEFT_SCENE_MATERIAL_NUMBERS_H

#include "scene/record/scene.h"
#include "weft/material.h"

/* Returns a material as the library may use it: numbers are finite and within their hard ranges, choices and modes
 * that do not exist are auto and opaque. Textures are not looked at. */
Material material_sound(const WeftMaterial *numbers);

/* Fails with WEFT_MESSAGE_PARAM_VALUE unless all choices exist and all values are finite. */
WeftResult numbers_sound(const WeftMaterial *numbers, WeftError *error);

/* Returns a value clamped to the hard range of an input, angles in radians; NaN becomes the lower end. */
float input_clamped(InputId input, float value);

#endif
