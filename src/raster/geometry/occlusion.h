/* occlusion.h - visibility of the sky and of each environment light from a vertex, found by rays in the
 * background */
#pragma once

#include "raster/geometry/refinement.h"
#include "scene/light/env_split.h"

typedef struct Occlusion Occlusion;

/* Values of a vertex: the fraction of the cosine-weighted sky that its front sees, and its back; for front and back
 * four numbers c of a ramp, so that the visibility of direction w, in the world, is near c_0 + c_1 w.x + c_2 w.y + c_3
 * w.z, nearest where the environment is bright; then the visible fraction of each light. */
enum {
    OCCLUSION_OPEN = 2,
    OCCLUSION_LIGHT = OCCLUSION_OPEN + 2 * 4,
    OCCLUSION_LIGHTS = AMBIENT_LIGHTS,
    OCCLUSION_VALUES = OCCLUSION_LIGHT + OCCLUSION_LIGHTS,
    OCCLUSION_RAYS_MAX = 4096
};

/* Options of the search. */
typedef struct OcclusionHow {
    int rays;    /* directions a side and a light, up to OCCLUSION_RAYS_MAX; only a quarter to a light if these agree */
    int threads; /* beside the caller; 0: one a processor */
    bool no_cache;              /* neither reads what an earlier run found from the user's cache, nor writes it there */
    const EnvLight *env_lights; /* in the world; copied */
    int env_light_count;        /* those beyond OCCLUSION_LIGHTS are left out */
    const EnvPoint *env_points; /* the parts of the lights, sorted by light; copied */
    int env_point_count;        /* 0: each light is one point in its direction */
    const AmbientRest *rest;    /* the environment without its lights; copied; NULL: uniform */
    float rotation;             /* of the environment, radians */
} OcclusionHow;

/* Starts the search from every vertex of the scene's own meshes as they are refined, and then as they are refined
 * further where neighbours see different light. Meshes of lights, which move, neither hide anything nor are searched
 * from. Without normals in the mesh a vertex has that of its triangles, or sees everything if these do not lie in one
 * plane. The scene must outlive the search; the calls of weft/scene.h may change it meanwhile. The refinement is
 * copied. Fails with WEFT_MESSAGE_MEMORY or _RENDER_DEVICE; a bad file of the cache is a warning. */
WeftResult occlusion_start(const WeftScene *scene, const Refinement *refinement, const OcclusionHow *how,
                           Occlusion **out, const WeftLog *log, WeftError *error);

/* Returns OCCLUSION_VALUES a vertex, for the scene's own meshes one after the other, or NULL if the search is not done
 * and not waited for. Sky: 1 is all of it. Light: visible fraction of its part above the horizon of the front, or of
 * the side that faces it if the material has two; below 0 if it was not searched for. Lives until occlusion_free. */
const float *occlusion_values(Occlusion *occlusion, bool wait);

/* Returns the refinement of these vertices: the given one, finer at the rims of shadows. It is the caller's from then
 * on. May be called once, when there are values. */
Refinement occlusion_take_refinement(Occlusion *occlusion);

/* Stops the search, if it is not done, and frees it; occlusion may be NULL. */
void occlusion_free(Occlusion *occlusion);
