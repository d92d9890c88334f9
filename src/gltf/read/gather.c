#include "gltf/read/gather.h"

#include <string.h>

/* Copies the values of the vertices in source. Returns NULL if values is NULL or after a sticky failure. */
static float *gather(Asset *asset, const float *values, size_t width, const uint32_t *source, size_t count) {
    if (!values) return NULL;
    float *out = asset_array(asset, &asset->scene->arena, count, width * sizeof *out);
    for (size_t i = 0; i < count && out; i++) memcpy(out + i * width, values + source[i] * width, width * sizeof *out);
    return out;
}

void mesh_gather(Asset *asset, Mesh *mesh, const uint32_t *source, size_t count) {
    if (count > UINT32_MAX) {
        asset_fail(asset, WEFT_MESSAGE_GLTF_TOO_LARGE, "more than 2^32 vertices in a mesh");
        return;
    }
    mesh->position = gather(asset, mesh->position, 3, source, count);
    mesh->normal = gather(asset, mesh->normal, 3, source, count);
    mesh->tangent = gather(asset, mesh->tangent, 4, source, count);
    mesh->texcoord[0] = gather(asset, mesh->texcoord[0], 2, source, count);
    mesh->texcoord[1] = gather(asset, mesh->texcoord[1], 2, source, count);
    mesh->color = gather(asset, mesh->color, 4, source, count);
    mesh->vertex_count = (uint32_t)count;
}
