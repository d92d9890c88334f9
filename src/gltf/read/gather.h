/* gather.h - meshes with their vertices picked and arranged anew */
#ifndef WEFT_GLTF_GATHER_H
#define WEFT_GLTF_GATHER_H

#include "gltf/asset/asset.h"

/* Gives the mesh, in the scene's arena, the vertices 0 to count - 1 of which each is what vertex source[i]
 * was. The index is the caller's. Sticky failures: MEMORY, GLTF_TOO_LARGE. */
void mesh_gather(Asset *asset, Mesh *mesh, const uint32_t *source, size_t count);

#endif
