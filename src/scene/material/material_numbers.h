/* material_numbers.h - checking the numbers of a caller's material */
#pragma once

#include "scene/record/scene.h"
#include "weft/material.h"

/* Returns a material that the library can use: finite numbers within their hard ranges, auto and opaque for choices and
 * modes that do not exist, and 0 past the last choice and input and where an input has no number. Textures are
 * not checked. */
Material material_sound(const WeftMaterial *numbers);

/* Fails with WEFT_MESSAGE_PARAM_VALUE unless all choices exist and all values are finite. */
WeftResult numbers_sound(const WeftMaterial *numbers, WeftError *error);

/* Returns a value clamped to the hard range of an input, angles in radians; NaN becomes the lower end. */
float input_clamped(InputId input, float value);
