/* gather.h - copies of chosen vertices of a mesh */
#pragma once

#include "gltf/asset/asset.h"

/* Replaces the vertices of the mesh, in the scene's arena: vertex i, of 0 to count - 1, becomes the old
 * vertex source[i]. The caller updates the index. Sticky failures: MEMORY, GLTF_TOO_LARGE. */
void mesh_gather(Asset *asset, Mesh *mesh, const uint32_t *source, size_t count);
