/* fuzz_sheen.h - the sheen that readers without KHR_materials_fuzz show in the place of fuzz */
#pragma once

#include "scene/record/material.h"

/* Gives a material whose fuzz is shown, and whose sheen is black, the sheen that is nearest to the fuzz in glTF's own
 * renderer. A texture of the amount has no place in a sheen and is left out. */
void fuzz_sheen_put(Material *material);

/* Gives a material whose sheen is shown the fuzz whose sheen is nearest to it, by the same table: OpenPBR has no other rim.
 * Fuzz is at most as bright as its table, so a stronger sheen gets a weight of 1. A texture of the amount is left out. */
void sheen_fuzz_put(Material *material);
