/* families.h - families of materials that one program can draw: they differ in numbers and in which of their inputs
 * have maps, but not in their lobes */
#pragma once

#include "raster/material/materials.h"

/* Joins the keys of all used materials of a scene, so that those of a family are equal, and gives each map a slot: sets
 * slot and like of all inputs of their keys, and their groups. A slot that a material leaves empty has the texture of
 * another material of the family. Fails with WEFT_MESSAGE_MEMORY, or _GL_MEMORY if a material needs too many slots. */
WeftResult families_make(const WeftScene *scene, const GlTextures *textures, GlMaterial *all, WeftError *error);
