/* ray_tree.h - a tree of boxes over a scene's triangles, for rays in shaders
 *
 * Nodes stand in depth-first order, the children of a node one after the other: a ray that hits
 * the box of an inner node goes on to the next node, one that misses it to `skip`, so no stack is needed. Brian Smits,
 * "Efficiency Issues for Ray Tracing", Journal of Graphics Tools 3(2), 1998. Nodes are split by the surface area
 * heuristic at one of 16 bins of each axis: Ingo Wald, "On fast Construction of SAH-based Bounding Volume Hierarchies",
 * IEEE Symposium on Interactive Ray Tracing, 2007. */
#pragma once

#include <stdbool.h>
#include <stdint.h>

#include "base/vec3.h"

typedef struct RayBox {
    Vec3 low, high;
} RayBox;

/* The numbers are floats, as the texture has them; whole ones are exact up to RAY_NUMBER_MOST. */
typedef struct RayNode {
    float low[3];
    float skip; /* inner node: the node after its descendants; leaf: its number of triangles */
    float high[3];
    float first; /* leaf: its first triangle, in the tree's order; inner node: -1 */
} RayNode;

#define RAY_NUMBER_MOST (1u << 24)
enum { RAY_LEAF_MOST = 8 };

typedef struct RayTree {
    RayNode *nodes;
    uint32_t node_count;
    uint32_t *order; /* the triangles of the leaves, one leaf after the other */
    uint32_t count;  /* triangles */
} RayTree;

/* Makes the tree of count <= RAY_NUMBER_MOST / 2 boxes, of which no coordinate is NaN. Release with ray_tree_free.
 * Returns false if memory is short; *tree is then zero. */
bool ray_tree_make(RayTree *tree, const RayBox *boxes, uint32_t count);
void ray_tree_free(RayTree *tree);
