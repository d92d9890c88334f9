/* lookout.h - search for what hides an environment from a scene's own meshes: in the background, uploaded when it is
 * done, and started once more when lights or surfaces have changed */
#ifndef WEFT_RASTER_LOOKOUT_H
#define WEFT_RASTER_LOOKOUT_H

#include "raster/geometry/meshes.h"
#include "raster/geometry/occlusion.h"
#include "raster/light/gl_environment.h"

typedef struct Lookout {
    const WeftScene *scene;
    int rays, threads;     /* as in OcclusionHow; 0 rays: nobody looks */
    Refinement refinement; /* of the scene's own meshes, before anybody has looked; nothing without rays */
    Refinement finer;      /* where shadows have rims, once they are found: that of the meshes then */
    Occlusion *occlusion;  /* NULL where none is wanted, or once it is uploaded */
    EnvLight lights[AMBIENT_LIGHTS_MAX]; /* whose visibility was or is being found */
    int light_count;
    EnvPoint points[AMBIENT_POINTS_MAX]; /* the parts of these lights */
    int point_count;
    AmbientRest rest; /* the environment without them */
    float rotation;
    bool again; /* when what is looked for now is found */
} Lookout;

/* Refines the meshes. The lookout may be freed whether or not it was created, if it was zero before. */
WeftResult lookout_create(Lookout *self, const WeftScene *scene, int rays, int threads, WeftError *error);
void lookout_free(Lookout *self);

/* Starts for the first time, for the lights of an environment, or for none where it is NULL. */
WeftResult lookout_start(Lookout *self, const GlEnvironment *environment, bool no_cache, const WeftLog *log,
                         WeftError *error);

/* Looks again where `again` is set or lights have moved, at once or when what is running is done. Until it is known
 * what hides them, other lights are hidden as the sky is; whoever is looking may finish: of what is found then, the sky
 * serves. Where the environment is NULL lights keep their places. */
WeftResult lookout_update(Lookout *self, const GlEnvironment *environment, GlMeshes *meshes,
                          const WeftLog *log, WeftError *error);

/* Uploads what was found, if it was, or is waited for, with the meshes as they were refined meanwhile; and looks again
 * if that is due. */
WeftResult lookout_take(Lookout *self, GlMeshes *meshes, bool wait, WeftError *error);

#endif
