/* path_context.h - the scene as paths of light need it */
#pragma once

#include "brdf/measured.h"
#include "scene/record/material.h"
#include "shading/kinds/kind.h"
#include "trace/geometry/geometry.h"
#include "trace/light/lights.h"
#include "trace/path/solid.h"
#include "weft/render.h"

/* A material prepared for all its hits. */
typedef struct PathMaterial {
    Material material;  /* the scene's, without the textures that paths do not read */
    Surface untextured; /* inputs without textures */
    Choices choices;
    bool textured;            /* inputs vary: by a texture, by colours of a mesh, or as it is woven */
    bool colored;             /* a mesh with this material has vertex colours */
    bool texcoords[2];        /* the sets of texture coordinates that it uses */
    bool leveled[2];          /* the sets by which textures with levels of their own are looked up */
    bool emits;               /* may emit light */
    bool needs_tangents;      /* the shading frame depends on a normal map, a cloth or anisotropy */
    bool transmits;           /* transmits light: samples from both sides count */
    bool pane;                /* light goes straight on there (panes.c) */
    const WeftCloth *cloth;   /* the base is woven of this; NULL: not woven */
    const Measured *measured; /* reflects in place of the stack; NULL: the stack does */
    bool solid;               /* of solid glass, which was taken out of `stack` */
    SolidGlass glass;         /* of the same material, if solid */
    SolidTable table;         /* of all its roughnesses, if solid */
    Rgb absorption;           /* inside, 1/m, if solid */
    TableRef sheen_e;         /* directional albedo of the sheen; TABLE_NONE without one */
    Stack stack;              /* of `untextured`; points without an own stack share it */
    const StackKind *kind;    /* NULL: shaded one vertex at a time */
} PathMaterial;

/* The scene, the camera and the settings of a render, as paths read them. The pointers are borrowed. */
typedef struct PathContext {
    const WeftScene *scene;
    const Geometry *geometry;
    const Lights *lights;
    const PathMaterial *materials; /* in the order of the scene's */
    int max_depth;
    WeftSampling sampling;
    bool roulette;        /* Russian roulette ends paths of little throughput */
    bool shadows;         /* shadow rays are traced */
    bool lift;            /* rays leave from the smooth surface of a mesh, not from its triangles */
    bool stages;          /* stages are timed */
    bool sky_in_parts;    /* the environment's factors `ambient` and `reflection` are not both 1 */
    bool solids;          /* a material is of solid glass */
    bool panes;           /* a mesh is a pane, and shadow rays are traced */
    int eye_inside;       /* the solid in which the camera is, by its material, from 1; 0: none */
    bool first_hits;      /* first hits are recorded */
    bool places;          /* where they are, and on which meshes, too */
    bool slots;           /* light is divided by the slots that reflect it there */
    float forward[3];     /* the camera's axis, along which their depth is measured */
    float pixel_width[2]; /* at the eye, and how much wider it becomes with depth */
} PathContext;

/* Returns in which solid a camera is at `eye`, as eye_inside has it: a ray from there first meets that one from within
 * (inside.c). materials: how many the context has. */
int path_eye_inside(const PathContext *context, int materials, Vec3 eye);

/* Which random numbers a path takes (sampler.h). */
typedef struct PathKey {
    uint32_t pixel, sample;
} PathKey;
