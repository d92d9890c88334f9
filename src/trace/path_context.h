/* path_context.h - the scene as paths of light see it */
#ifndef WEFT_TRACE_PATH_CONTEXT_H
#define WEFT_TRACE_PATH_CONTEXT_H

#include "brdf/measured.h"
#include "scene/record/material.h"
#include "shading/kinds/kind.h"
#include "trace/geometry.h"
#include "trace/lights.h"
#include "weft/render.h"

/* A material prepared for all its hits. */
typedef struct PathMaterial {
    Material material; /* the scene's, without textures that a path never looks at */
    Surface plain;     /* all its textures left out */
    Choices choices;
    bool textured;            /* has any, or a mesh that wears it has colours */
    bool colored;             /* a mesh that wears it has colors */
    bool texcoords[2];        /* the sets of texture coordinates that its textures use */
    bool shines;              /* may send out light */
    bool bent;                /* a normal map or anisotropy turns the shading frame */
    bool transmits;           /* light goes through, and comes from all sides */
    const WeftCloth *cloth;   /* of which the base is woven; NULL: of none */
    const Measured *measured; /* what light is reflected by in place of the stack; NULL: the stack */
    TableRef sheen_e;         /* TABLE_NONE without a sheen */
    Stack stack;              /* of plain, where no point has one of its own */
    const StackKind *kind;    /* NULL: shaded one vertex at a time */
} PathMaterial;

typedef struct PathContext {
    const WeftScene *scene;
    const Geometry *geometry;
    const Lights *lights;
    const PathMaterial *materials; /* beside the scene's */
    int max_depth;
    WeftSampling sampling;
    bool roulette, shadows;
    bool lift;         /* light and rays meet the smooth surface of a mesh, not its triangles */
    bool stages;       /* their time is taken */
    bool sky_in_parts; /* the factors ambient and reflection are not both 1 */
    bool first_hits;   /* they are kept, */
    float forward[3];  /* with depths along this axis, the camera's */
    float pixel[2];    /* width of a pixel at the eye, and how much wider it becomes with depth */
} PathContext;

/* Which random numbers a path takes (sampler.h). */
typedef struct PathKey {
    uint32_t pixel, sample;
} PathKey;

#endif
