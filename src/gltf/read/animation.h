/* animation.h - a moment of an animation, written to the JSON of the asset before its parts are read
 *
 * What an animation moves is a value of the JSON: of a node its translation, rotation, scale and weights, and by
 * KHR_animation_pointer any other number. So the readers of the parts meet the values of the moment where the file has
 * those at rest, and check them alike.
 *
 * Specification: Khronos Group, "glTF 2.0 Specification", 2021, section 3.11 and appendix C (interpolation); and the text
 * of KHR_animation_pointer in its extension registry. */
#pragma once

#include "gltf/asset/asset.h"

/* Puts asset->root to the moment asset->moment; without one, warns of animations. Needs the accessors. */
void animation_apply(Asset *asset);
