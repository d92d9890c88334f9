/* lookout.h - the search for occlusion in the background, uploaded when it is done, and repeated when lights or
 * surfaces have changed */
#pragma once

#include "raster/geometry/meshes.h"
#include "raster/geometry/occlusion.h"
#include "raster/light/gl_environment.h"

typedef struct Lookout {
    const WeftScene *scene;
    int rays, threads;                   /* as in OcclusionHow; 0 rays: no search */
    Refinement refinement;               /* of the scene's own meshes before the search; nothing without rays */
    Refinement finer;                    /* of the uploaded meshes after a search: finer at the rims of shadows */
    Occlusion *occlusion;                /* the running search; NULL without one */
    EnvLight lights[AMBIENT_LIGHTS_MAX]; /* of the last search */
    int light_count;
    EnvPoint points[AMBIENT_POINTS_MAX]; /* the parts of these lights */
    int point_count;
    AmbientRest rest; /* the environment without these lights, mean 1 */
    float rotation;   /* of the environment, radians */
    bool again;       /* search again when the running search is done */
} Lookout;

/* Refines the meshes. A lookout that was zero before may be freed even if this fails, with WEFT_MESSAGE_MEMORY. */
WeftResult lookout_create(Lookout *self, const WeftScene *scene, int rays, int threads, WeftError *error);
void lookout_free(Lookout *self);

/* Starts the first search, for the lights of an environment, or for none if it is NULL. Fails as occlusion_start
 * does. */
WeftResult lookout_start(Lookout *self, const GlEnvironment *environment, bool no_cache, const WeftLog *log,
                         WeftError *error);

/* Starts another search if `again` is set or lights have moved, now or when the running one is done, whose values of
 * the sky are still used. Until a light has values it is dimmed as the sky is. Lights stay as they are if the
 * environment is NULL. Fails as occlusion_start does. */
WeftResult lookout_update(Lookout *self, const GlEnvironment *environment, GlMeshes *meshes, const WeftLog *log,
                          WeftError *error);

/* Uploads the result of the search, and the meshes as it has refined them, if it is done or waited for; then starts
 * another search if `again` is set. Fails as meshes_refine and occlusion_start do. */
WeftResult lookout_take(Lookout *self, GlMeshes *meshes, bool wait, WeftError *error);
