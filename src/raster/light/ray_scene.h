/* ray_scene.h - the scene's triangles and emitters in a texture, for rays in shaders (glsl/rays.glsl)
 *
 * The texture has four floats a texel, and RAY_ROW texels a row. One after the other it has
 *
 *   nodes      two texels each: low, skip; high, first (ray_tree.h)
 *   triangles  three each, in the order of the tree: corner a and its surface; b and 1 + its emitter, or of a pane less
 *              than 0 its texel among the panes, or 0; c and 1 + its mask, or 0
 *   normals    three each: at the corners, 0 if the mesh has none; and for a bounce red, green and blue of what it sends
 *              back (ray_albedos.h)
 *   emitters      four each: a, until; ab, 1 if both sides emit; ac, area; radiance, probability (emitters.h)
 *   masks      three each: the numbers of ray_masks.h
 *   panes      two each: the numbers of ray_panes.h
 *
 * A surface is its opacity, plus 4 if it has only a front side. Departures: gaps of a woven cloth and alphas of vertex
 * colours count with their mean over a triangle without a map of opacity. Of hair of more than RAY_FIBRES_MOST fibres there
 * is one fibre in `hair_share`, as many times as wide, which hides as much of the light on the mean: Robert L. Cook, John
 * Halstead, Maxwell Planck, David Ryu, "Stochastic Simplification of Aggregate Detail", SIGGRAPH 2007.
 *
 * All calls are for the context that is current. */
#pragma once

#include <stdint.h>

#include "raster/light/ray_emitters.h"
#include "raster/light/ray_masks.h"
#include "scene/light/sheen_tables.h"

enum { RAY_ROW = 2048, RAY_FIBRES_MOST = 400000 };

typedef struct RayScene {
    unsigned shape_version; /* of the triangles, as in WeftScene */
    uint32_t nodes;         /* of the tree over them */
    uint32_t hair_share;    /* the tree has one fibre of so many */
    bool filled;            /* the texture has the scene as it is; set it to false when materials change */
    bool bounces;           /* the texture has what triangles send back */
    unsigned texture;       /* 0: none */
    int rows;               /* of the texture */
    int first[6];           /* texel of the first node, triangle, normal, emitter, mask and pane */
    int emitters;
    RayMasks masks;
} RayScene;

/* Makes what is missing. sheens: of the scene, NULL where nothing is to bounce. Fails with WEFT_MESSAGE_MEMORY, or
 * _GL_MEMORY if the scene is too large for a texture. */
WeftResult ray_scene_make(RayScene *self, const WeftScene *scene, const SheenTables *sheens, WeftError *error);
void ray_scene_destroy(RayScene *self);

/* Binds the triangles and the maps of opacity. */
void ray_scene_bind(const RayScene *self, int unit, int masks_unit);
