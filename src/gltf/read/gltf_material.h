/* gltf_material.h - reads glTF materials into the inputs of scene materials */
#pragma once

#include "gltf/asset/asset.h"

/* Reads all materials, and one more at index asset->material_count for surfaces without a material (white, rough metal:
 * the defaults of the specification). Inputs have indices of glTF textures until textures_resolve. */
void materials_read(Asset *asset);

/* Gives the scene the backs that its materials have, once textures are resolved. */
void backs_take(Asset *asset);
