/* fuzz_draco - the meshes of KHR_draco_mesh_compression: both methods, false numbers, damaged data
 *
 * Any input must be decoded or refused, within the memory that was allowed. What was decoded has all indices below its
 * points, and its attributes are copied whole. */
#include <stdlib.h>

#include "gltf/asset/draco.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    static const DracoType types[] = {{true, true, 4}, {false, false, 1}, {false, true, 1}, {false, false, 2}};
    const size_t limit = (size_t)64 << 20;
    DracoMesh *mesh;
    if (draco_open(data, size, limit, &mesh) != DRACO_READ) {
        if (mesh) abort();
        return 0;
    }
    const size_t points = draco_point_count(mesh), triangles = draco_triangle_count(mesh);
    if (points > limit || triangles > limit / 12) abort();
    float *values = calloc(4 * points + 1, sizeof *values);
    uint32_t *indices = calloc(3 * triangles + 1, sizeof *indices);
    if (!values || !indices) abort();
    if (draco_indices(mesh, indices))
        for (size_t k = 0; k < 3 * triangles; k++)
            if (indices[k] >= points) abort();
    for (uint32_t id = 0; id < 4; id++)
        for (size_t k = 0; k < sizeof types / sizeof *types; k++)
            draco_attribute(mesh, id, types[k], 1 + (int)id, values);
    free(values);
    free(indices);
    draco_close(mesh);
    return 0;
}
