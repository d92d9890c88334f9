/* path_radiance.h - the light along one camera ray */
#ifndef WEFT_TRACE_PATH_RADIANCE_H
#define WEFT_TRACE_PATH_RADIANCE_H

#include "scene/material.h"
#include "shading/kind.h"
#include "trace/geometry.h"
#include "trace/lights.h"
#include "trace/sampler.h"
#include "weft/render.h"

/* The part of a material that is equal at all hits. */
typedef struct PathMaterial {
    Material material; /* the scene's, without textures that a path never looks at */
    Surface plain;     /* all its textures left out */
    Choices choices;
    bool textured;    /* has any */
    TableRef sheen_e; /* TABLE_NONE without a sheen */
    Stack stack;      /* of plain, where no point has one of its own */
    const StackKind *kind;
} PathMaterial;

typedef struct PathContext {
    const WeftScene *scene;
    const Geometry *geometry;
    const Lights *lights;
    const PathMaterial *materials; /* beside the scene's */
    int max_depth;
    WeftSampling sampling;
    bool roulette, shadows;
    bool sky_in_parts; /* true unless the sky's factors ambient and reflection are both 1 */
} PathContext;

/* Radiance that comes back along a camera ray whose nearest hit is known; counts rays traced. */
Rgb path_radiance(const PathContext *context, Ray ray, Hit hit, Sampler *sampler, long long *rays);

#endif
