/* light_tree.h - choosing one of many emissive triangles by about the light that each sends to a point
 *
 *   I = power max(cos_r, 0) max(cos_e, 0) / max(d^2, r^2)
 *
 * A node bounds its lights by a sphere of radius r, a cone of normals, and their power; d is the distance to its
 * centre, cos_e and cos_r are the greatest cosines that any of its points may have at the light and at the
 * receiver. From the root on a child is chosen by I; where I is 0 no light arrives. Alejandro Conty Estevez,
 * Christopher Kulla, "Importance Sampling of Many Lights with Adaptive Tree Splitting", HPG 2018, sections 4
 * and 5. */
#ifndef WEFT_TRACE_LIGHT_TREE_H
#define WEFT_TRACE_LIGHT_TREE_H

#include "base/memory.h"
#include "shading/stack/surface_rows.h"
#include "trace/light_bounds.h"

typedef struct LightTree {
    int depth;    /* the most steps from the root, node 0, to a leaf */
    float *nodes; /* light_tree.c says what of a node; two children are neighbours */
    int *child;   /* the first child of a node; of a leaf ~ its light */
    int *parent;  /* of a node */
    int *leaf;    /* of a light; -1: it is not in the tree */
} LightTree;

/* Makes the tree of count >= 1 lights, some of which have power; its arrays come from arena. false when memory
 * is short. */
bool light_tree_make(LightTree *tree, int count, const LightBounds *lights, Arena *arena);

/* Chooses a light for each of n <= ROW_MOST points with normals, n a multiple of ROW_LANES, by u in [0, 1),
 * which becomes what is left of it. Light that arrives from below the normal does not count; all counts where the
 * normal is 0. */
void light_tree_choose_rows(const LightTree *tree, int n, const float *const point[3],
                            const float *const normal[3], float *u, int *light, float *probability);

/* The probability with which that chooses a light. */
float light_tree_probability(const LightTree *tree, int light, Vec3 point, Vec3 normal);

#endif
