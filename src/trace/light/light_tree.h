/* light_tree.h - choice of one of many emissive triangles in proportion to about what each contributes to a point
 *
 *   I = power max(cos_r, 0) max(cos_e, 0) / max(d^2, r^2)
 *
 * is the importance of a node. The node bounds its lights by a sphere of radius r, a cone of normals, and their power;
 * d is the distance to its centre. cos_e and cos_r are the greatest cosines at the light and at the receiver that any
 * of its points may have. From the root on a child is chosen in proportion to I, which is 0 only if no light arrives.
 * Alejandro Conty Estevez, Christopher Kulla, "Importance Sampling of Many Lights with Adaptive Tree Splitting", HPG
 * 2018, sections 4 and 5. */
#pragma once

#include "base/memory.h"
#include "shading/stack/surface_rows.h"
#include "trace/light/light_bounds.h"

typedef struct LightTree {
    int depth;    /* the most steps from the root, node 0, to a leaf */
    float *nodes; /* NODE_FLOATS numbers by node (light_tree.c); two children are neighbours */
    int *child;   /* by node: its first child, or ~ the light of a leaf */
    int *parent;  /* by node */
    int *leaf;    /* by light: its node; -1: it is not in the tree */
} LightTree;

/* Makes the tree of count >= 1 lights, some of which have power; its arrays come from arena. Returns false if memory is
 * short. */
bool light_tree_make(LightTree *tree, int count, const LightBounds *lights, Arena *arena);

/* Chooses a light for each of n <= ROW_MOST points with normals, n a multiple of ROW_LANES, with u in [0, 1), which
 * becomes its position within the light's interval, in [0, 1) again. Light from below the normal's plane does not
 * count; light from everywhere counts if the normal is 0. */
void light_tree_choose_rows(const LightTree *tree, int n, const float *const point[3], const float *const normal[3],
                            float *u, int *light, float *probability);

/* Returns the probability with which light_tree_choose_rows chooses that light. */
float light_tree_probability(const LightTree *tree, int light, Vec3 point, Vec3 normal);
