/* families.h - the materials of a scene that one program can draw: those that differ in numbers and in which
 * of their inputs have maps, not in what their light is made from */
#ifndef WEFT_RASTER_FAMILIES_H
#define WEFT_RASTER_FAMILIES_H

#include "raster/material/materials.h"

/* Joins the keys of all materials of a scene that are used, so that those of a family are equal, and gives
 * each map a slot: sets slot and like of all inputs of their keys, and their groups. A slot that a material
 * leaves empty holds what another of the family has there. Fails with WEFT_MESSAGE_MEMORY. */
WeftResult families_make(const WeftScene *scene, const GlTextures *textures, GlMaterial *all,
                         WeftError *error);

#endif
