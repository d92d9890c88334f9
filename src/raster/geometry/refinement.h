/* refinement.h - the triangles of a scene, cut so small that the occlusion of vertices may be interpolated
 *
 * Rays find the occlusion at vertices (occlusion.h). A floor of two triangles has no vertex below what stands on it,
 * and would show no shadow. So an edge of a mesh is halved while it is longer than
 *
 *   max(distance from its middle to the box of another mesh / 2, diagonal of that box / 24)
 *
 * for any other of the scene's own meshes. A triangle is cut through those of its edges that are halved. An edge is
 * halved by its own ends alone, so triangles that share it agree, and also where a seam has its vertices twice. All
 * attributes of a new vertex are the means of its two ends, which is what the triangle had there.
 *
 * Then occlusion decides: an edge up to REFINEMENT_FINER times as short is halved too if its ends see different light,
 * as at the rim of a shadow.
 *
 * Departures: parts of one mesh do not refine each other. At a crease, which has its vertices twice, two meshes of one
 * edge may differ. */
#pragma once

#include "scene/record/scene.h"

/* The vertices of one mesh are first its own. Vertex k of those after them lies halfway between two before it. */
typedef struct RefinedMesh {
    uint32_t vertex_count, triangle_count;
    uint32_t (*ends)[2]; /* one entry for each vertex after the mesh's own */
    uint32_t *index;     /* 3 a triangle; NULL: the mesh stays as it is */
} RefinedMesh;

/* Holds a RefinedMesh for each of the scene's own meshes. Zero refines nothing. */
typedef struct Refinement {
    RefinedMesh *meshes;
    int count;
} Refinement;

/* Refines the scene's own meshes. Fails with WEFT_MESSAGE_MEMORY; `out` is then zero. */
WeftResult refinement_make(const WeftScene *scene, Refinement *out, WeftError *error);
void refinement_free(Refinement *refinement);

/* Copies a refinement. Returns false if memory is short; `out` is then zero. */
bool refinement_copy(const WeftScene *scene, const Refinement *from, Refinement *out);

#define REFINEMENT_FINER 4.0f

/* A test whether the ends a and b of an edge see different light. Callers set `mesh`. */
typedef struct EdgeTest {
    bool (*differ)(const void *user, int mesh, uint32_t a, uint32_t b);
    const void *user;
    int mesh;
} EdgeTest;

/* Copies a refinement and halves the edges that a test chooses once more. Returns false if there are none, or
 * for want of memory; `out` is then zero. */
bool refinement_halve(const WeftScene *scene, const Refinement *from, const EdgeTest *test, Refinement *out);

/* Returns mesh m; its arrays belong to the refinement. */
RefinedMesh refinement_mesh(const Refinement *refinement, const WeftScene *scene, int m);

/* Fills an attribute of a refined mesh, `width` numbers a vertex. own: that of the mesh's own vertices. */
void refined_fill(const RefinedMesh *refined, const Mesh *mesh, const float *own, size_t width, float *to);
