/* mesh.h - meshes of a glTF file, read into records and baked into the scene's world-space triangles */
#pragma once

#include "gltf/asset/asset.h"

/* Reads the names of KHR_materials_variants. Call it before meshes_read. */
void variants_read(Asset *asset);

/* Reads the record of every mesh: attributes with their types and counts, materials, variants, morph targets. */
void meshes_read(Asset *asset);

/* Adds every surface of every shown node to the scene. Sets asset->material_shown. */
void meshes_bake(Asset *asset);
