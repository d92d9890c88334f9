/* path.h - the light along one camera ray */
#ifndef WEFT_TRACE_PATH_H
#define WEFT_TRACE_PATH_H

#include "shading/surface.h"
#include "trace/geometry.h"
#include "trace/lights.h"
#include "trace/sampler.h"
#include "weft/render.h"

typedef struct PathContext {
    const WeftScene *scene;
    const Geometry *geometry;
    const Lights *lights;
    const Surface *surfaces;           /* of each material, its textures left out */
    const AlbedoTable *const *sheen_e; /* a table for each material that has a sheen, else NULL */
    int max_depth;
    WeftSampling sampling;
    bool roulette;
} PathContext;

/* Radiance that comes back along a camera ray whose nearest hit is known; counts rays traced. */
Rgb path_radiance(const PathContext *context, Ray ray, Hit hit, Sampler *sampler, long long *rays);

#endif
