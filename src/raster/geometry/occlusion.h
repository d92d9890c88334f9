/* occlusion.h - visibility of the sky and of each environment light from a vertex, found by rays in the
 * background */
#ifndef WEFT_RASTER_OCCLUSION_H
#define WEFT_RASTER_OCCLUSION_H

#include "raster/geometry/refinement.h"
#include "scene/light/env_split.h"

typedef struct Occlusion Occlusion;

/* Numbers of a vertex: the part of the cosine-weighted sky that its front sees, and its back; of front and of
 * back four numbers c by which the part of direction w that is seen is near c_0 + c_1 w.x + c_2 w.y +
 * c_3 w.z, w in the world, nearest where the environment is bright; then of each light. */
enum {
    OCCLUSION_OPEN = 2,
    OCCLUSION_LIGHT = OCCLUSION_OPEN + 2 * 4,
    OCCLUSION_LIGHTS = AMBIENT_LIGHTS,
    OCCLUSION_VALUES = OCCLUSION_LIGHT + OCCLUSION_LIGHTS,
    OCCLUSION_RAYS_MAX = 4096
};

/* Options of the search. */
typedef struct OcclusionHow {
    int rays; /* directions a side and a light, up to OCCLUSION_RAYS_MAX; of a light a quarter where they agree */
    int threads;   /* beside the caller; 0: one a processor */
    bool no_cache; /* neither reads what an earlier run found from the user's cache, nor writes it there */
    const EnvLight *env_lights; /* in the world; copied */
    int env_light_count;        /* those beyond OCCLUSION_LIGHTS are not looked for */
    const EnvPoint *env_points; /* the parts of the lights, sorted by light; copied */
    int env_point_count;        /* 0: each light is about its direction */
    const AmbientRest *rest; /* of the environment, turned by `rotation`; copied; NULL: as if it were even */
    float rotation;
} OcclusionHow;

/* Starts to look from every vertex of the scene's own meshes as they are refined, and then as they are refined further
 * where neighbours see different things; those of its lights, which move, neither hide anything nor are looked from.
 * Where a mesh has no normals a vertex looks along that of its triangles, or, if they do not lie in one plane, sees all.
 * The scene must outlive it; the calls of weft/scene.h may change it meanwhile. The refinement is copied. Fails with
 * WEFT_MESSAGE_MEMORY or _RENDER_DEVICE; what is wrong with a file of the cache is a warning. */
WeftResult occlusion_start(const WeftScene *scene, const Refinement *refinement, const OcclusionHow *how,
                           Occlusion **out, const WeftLog *log, WeftError *error);

/* The numbers of a vertex before which there is nothing, and that knows of no light. */
void occlusion_nothing(float values[OCCLUSION_VALUES]);

/* OCCLUSION_VALUES a vertex, its own meshes one after the other: of the sky 1 is all; of a light the part that
 * is above the horizon of the front, or of whichever side faces it where both are seen; below 0 where nothing is known. NULL until it is done,
 * unless it is waited for. Lives until occlusion_free. */
const float *occlusion_values(Occlusion *occlusion, bool wait);

/* The refinement whose vertices these are: the one given, finer where a shadow has its rim. It is the caller's from
 * then on; to be asked for once, when there are values. */
Refinement occlusion_take_refinement(Occlusion *occlusion);

/* Stops early where it is not done; occlusion may be NULL. */
void occlusion_free(Occlusion *occlusion);

#endif
