/* meshes.h - a scene's triangles in the driver's memory: one buffer a kind of attribute, one of indices
 *
 * All calls are for the context that is current. */
#ifndef WEFT_RASTER_MESHES_H
#define WEFT_RASTER_MESHES_H

#include "raster/geometry/refinement.h"

/* Locations of the attributes in every vertex shader. */
enum {
    AT_POSITION,
    AT_NORMAL,
    AT_TANGENT,
    AT_TEXCOORD,
    AT_COLOR = AT_TEXCOORD + 2,
    AT_COUNT,
    AT_OCCLUSION = AT_COUNT, /* not of a file: meshes_occlusion */
    AT_OPEN,                 /* two */
    AT_LIGHTS = AT_OPEN + 2  /* two */
};

typedef struct GlMeshes {
    unsigned vertices; /* vertex array object */
    unsigned attributes[AT_COUNT], index;
    unsigned occlusion;               /* buffer, 0 until there is one */
    bool env_lights;                  /* true if values for the environment's lights are there */
    uint32_t vertex_count, own_count; /* own: of the scene's own meshes, which come first */
    int mesh_count, tangents;         /* tangents: of how many meshes they are uploaded */
    uint32_t *first;                  /* a mesh's first index; mesh_count + 1 entries, owned */
    const Refinement *refinement;     /* of the scene's own meshes */
} GlMeshes;

/* Uploads all meshes, its own as they are refined; the refinement must live as long. Zero on failure:
 * WEFT_MESSAGE_MEMORY, _GL_MEMORY, the latter beyond 2^31 corners too. */
WeftResult meshes_create(const WeftScene *scene, const Refinement *refinement, GlMeshes *out,
                         WeftError *error);
void meshes_destroy(GlMeshes *meshes);

/* Uploads all meshes once more, refined in another way; nothing is known of what vertices see. Fails as meshes_create
 * does; it is then as it was. */
WeftResult meshes_refine(GlMeshes *meshes, const WeftScene *scene, const Refinement *refinement,
                         WeftError *error);

/* Gives each vertex of the scene's own meshes what it sees of the sky and of lights, as occlusion_values has
 * it; others, and all until then, see all of the sky, and of lights nothing is known. */
WeftResult meshes_occlusion(GlMeshes *meshes, const float *values, WeftError *error);

/* From now on nothing is known of lights, which are others. */
void meshes_forget_lights(GlMeshes *meshes);

/* Uploads tangents, which setting a material may have given to meshes. Fails as meshes_create does; it is
 * then as it was. */
WeftResult meshes_update(GlMeshes *meshes, const WeftScene *scene, WeftError *error);

/* Takes other shapes of lights; what vertices see stays. Where there are as many vertices and triangles, only
 * the places of the lights' vertices are uploaded. Fails as meshes_create does; it is then as it was. */
WeftResult meshes_reshape(GlMeshes *meshes, const WeftScene *scene, WeftError *error);

/* Binds the vertex array, and sets the constants that stand for what is not in it. */
void meshes_bind(const GlMeshes *meshes);

/* Draws the triangles of one mesh; they must be bound. */
void meshes_draw(const GlMeshes *meshes, int mesh);

#endif
