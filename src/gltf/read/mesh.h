/* mesh.h - meshes of a glTF file, read into records and baked into the scene's world-space triangles */
#pragma once

#include "gltf/asset/field.h"

/* Reads the names of KHR_materials_variants. Call it before meshes_read. */
void variants_read(Asset *asset);

/* Reads the record of every mesh: attributes with their types and counts, materials, variants, morph targets. */
void meshes_read(Asset *asset);

/* Returns the accessor of an attribute: vectors of low to high components, as many as there are positions
 * (count 0: any number). Returns -1 if the attribute is absent or after a sticky failure. */
int attribute_read(const Field *attributes, const char *name, int low, int high, size_t count);

/* Adds every surface of every shown node to the scene. Sets asset->material_shown. */
void meshes_bake(Asset *asset);
