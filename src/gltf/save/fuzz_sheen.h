/* fuzz_sheen.h - the sheen that readers without KHR_materials_fuzz show in the place of fuzz */
#pragma once

#include "scene/record/material.h"

/* Gives a material whose fuzz is shown, and whose sheen is black, the sheen that is nearest to the fuzz in glTF's own
 * renderer. A texture of the amount has no place in a sheen and is left out. */
void fuzz_sheen_put(Material *material);
