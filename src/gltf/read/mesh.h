/* mesh.h - meshes of a glTF file, read into records and baked into the scene's world-space triangles */
#ifndef WEFT_GLTF_MESH_H
#define WEFT_GLTF_MESH_H

#include "gltf/asset/asset.h"

/* The names of KHR_materials_variants. Call before meshes_read. */
void variants_read(Asset *asset);

/* The record of every mesh: attributes with their types and counts, materials, variants, morph targets. */
void meshes_read(Asset *asset);

/* Adds to the scene every surface of every shown node. Sets asset->material_shown. */
void meshes_bake(Asset *asset);

#endif
