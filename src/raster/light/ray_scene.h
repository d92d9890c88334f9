/* ray_scene.h - the scene's triangles and lamps in a texture, for rays in shaders (glsl/rays.glsl)
 *
 * The texture has four floats a texel, and RAY_ROW texels a row. One after the other it has
 *
 *   nodes      two texels each: low, skip; high, first (ray_tree.h)
 *   triangles  three each, in the order of the tree: corner a and its surface; b and 1 + its lamp, or 0; c
 *   normals    three each: at the corners, 0 if the mesh has none
 *   lamps      four each: a, until; ab, 1 if both sides emit; ac, area; radiance, probability (lamps.h)
 *
 * A surface is its opacity, plus 4 if it has only a front side. Departures: the opacity of masks and of what blends is
 * the mean over a triangle.
 *
 * All calls are for the context that is current. */
#pragma once

#include "raster/geometry/ray_tree.h"
#include "raster/light/lamps.h"

enum { RAY_ROW = 2048 };

typedef struct RayScene {
    RayTree tree;
    unsigned shape_version; /* of the tree, as in WeftScene */
    bool filled;            /* the texture has the scene as it is; set it to false when materials change */
    unsigned texture;       /* 0: none */
    int rows;               /* of the texture */
    int first[4];           /* texel of the first node, triangle, normal and lamp */
    int lamps;
} RayScene;

/* Makes what is missing. Fails with WEFT_MESSAGE_MEMORY, or _GL_MEMORY if the scene is too large for a texture. */
WeftResult ray_scene_make(RayScene *self, const WeftScene *scene, WeftError *error);
void ray_scene_destroy(RayScene *self);

void ray_scene_bind(const RayScene *self, int unit);
