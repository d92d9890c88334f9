/* meshes.h - a scene's triangles in the driver's memory: one buffer a kind of attribute, one of indices
 *
 * All calls are for the context that is current. */
#pragma once

#include "raster/geometry/refinement.h"

/* Locations of the attributes in every vertex shader. */
enum {
    AT_POSITION,
    AT_NORMAL,
    AT_TANGENT,
    AT_TEXCOORD,
    AT_COLOR = AT_TEXCOORD + 2,
    AT_COUNT,
    AT_OCCLUSION = AT_COUNT,   /* not of a file: meshes_occlusion */
    AT_OPEN,                   /* two */
    AT_LIGHTS = AT_OPEN + 2,   /* two */
    AT_ACROSS = AT_LIGHTS + 2, /* of hair, as the next */
    AT_ROOT
};

typedef struct GlMeshes {
    unsigned vertices; /* vertex array object */
    unsigned attributes[AT_COUNT], index;
    unsigned across;                  /* buffer for the vertices of all meshes, 0 without hair */
    unsigned occlusion;               /* buffer for the vertices of own meshes, 0 until there is one */
    bool env_lights;                  /* true if values for the environment's lights are there */
    uint32_t vertex_count, own_count; /* own: of the scene's own meshes, which come first */
    int mesh_count, own_meshes;
    int tangents;                 /* of how many meshes they are uploaded */
    unsigned hair_version;        /* of the uploaded hair, as in WeftScene */
    uint32_t *first;              /* a mesh's first index; mesh_count + 1 entries, owned */
    const Refinement *refinement; /* of the scene's own meshes */
} GlMeshes;

/* Uploads all meshes, the scene's own as they are refined; the refinement must live as long. Fails with
 * WEFT_MESSAGE_MEMORY, or _GL_MEMORY, also beyond 2^31 corners; *out is then zero. */
WeftResult meshes_create(const WeftScene *scene, const Refinement *refinement, GlMeshes *out, WeftError *error);
void meshes_destroy(GlMeshes *meshes);

/* Uploads all meshes again with another refinement. Vertices have no occlusion until it is set again. Fails as
 * meshes_create does; the meshes are then as they were. */
WeftResult meshes_refine(GlMeshes *meshes, const WeftScene *scene, const Refinement *refinement, WeftError *error);

/* Sets the occlusion of each vertex of the scene's own meshes to that of occlusion_values. Other vertices, and all
 * until then, see the whole sky, and have no values for lights. */
WeftResult meshes_occlusion(GlMeshes *meshes, const float *values, WeftError *error);

/* Drops the vertices' values for lights, after these have changed. */
void meshes_forget_lights(GlMeshes *meshes);

/* Uploads the tangents of meshes, which setting a material may have made. Fails as meshes_create does; the meshes are
 * then as they were. */
WeftResult meshes_update(GlMeshes *meshes, const WeftScene *scene, WeftError *error);

/* Uploads changed shapes of lights and hair, and keeps the vertices' occlusion. If there is no new hair, and numbers of
 * vertices and triangles are unchanged, only the positions of the lights' vertices are uploaded. Fails as meshes_create does; the meshes are then
 * as they were. */
WeftResult meshes_reshape(GlMeshes *meshes, const WeftScene *scene, WeftError *error);

/* Binds the vertex array, and sets constants for the attributes that are not in it. */
void meshes_bind(const GlMeshes *meshes);

/* Draws the triangles of one mesh; the vertex array must be bound. */
void meshes_draw(const GlMeshes *meshes, int mesh);
