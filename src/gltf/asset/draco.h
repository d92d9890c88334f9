/* draco.h - the meshes of KHR_draco_mesh_compression, decoded by libdraco
 *
 * Specification: Google, "Draco Bitstream Specification", version 2.2, which the extension prescribes. */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* One decoded mesh. */
typedef struct DracoMesh DracoMesh;

typedef enum DracoResult { DRACO_READ = 0, DRACO_VERSION, DRACO_DAMAGED, DRACO_LARGE, DRACO_MEMORY } DracoResult;

/* Decodes a mesh that takes at most `limit` bytes while it is decoded. The numbers in its headers are looked at before
 * memory is allocated for them. Returns DRACO_READ with the mesh in *out, which draco_close releases; *out is else NULL. */
DracoResult draco_open(const unsigned char *data, size_t size, size_t limit, DracoMesh **out);

void draco_close(DracoMesh *mesh); /* may be NULL */

size_t draco_point_count(const DracoMesh *mesh);
size_t draco_triangle_count(const DracoMesh *mesh);

/* Copies `rows` components of the attribute with this unique id for each point to out, without padding: floats, or
 * integers of this size in bytes and sign. Returns false if there is no such attribute, or fewer components of it, or if
 * its values are not there. */
typedef struct DracoType {
    bool is_float, is_signed;
    int size; /* 1, 2 or 4 */
} DracoType;
bool draco_attribute(const DracoMesh *mesh, uint32_t id, DracoType type, int rows, void *out);

/* Copies three indices for each triangle. Returns false if one is not below the number of points. */
bool draco_indices(const DracoMesh *mesh, uint32_t *out);

#ifdef __cplusplus
}
#endif
