/* gltf_material.h - glTF materials into the scene's table of inputs */
#ifndef WEFT_GLTF_GLTF_MATERIAL_H
#define WEFT_GLTF_GLTF_MATERIAL_H

#include "gltf/asset/asset.h"

/* Reads all materials, and one more for surfaces without (white, rough metal: the specification's defaults)
 * at index asset->material_count. Inputs hold indices of glTF textures until textures_resolve. */
void materials_read(Asset *asset);

#endif
