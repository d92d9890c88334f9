/* coordinates.h - the sets of texture coordinates of a file, TEXCOORD_0 and up, as the two that a mesh of a scene has
 *
 * A file may have any number of sets. The textures of a material are read by two of them at most: these become sets 0
 * and 1 of the meshes that have the material. */
#pragma once

#include "gltf/asset/field.h"

/* Begins a material, whose textures name sets from here on, as do those of its back. */
void coordinates_begin(Asset *asset, size_t material);

/* Returns which of the two sets, 0 or 1, has the coordinates that the material calls TEXCOORD_n; -1 if it reads two
 * others already. Sets 0 and 1 stay what they are where they can. */
int coordinates_choose(Asset *asset, int n);

/* Reads the two sets of a primitive whose materials are known: accessors of `count` elements (0: any number), -1 where
 * it lacks them. Warns of a material of a variant that reads others. */
void coordinates_read(const Field *attributes, size_t count, Primitive *p);
