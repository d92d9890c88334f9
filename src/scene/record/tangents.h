/* tangents.h - a direction of growing u for meshes that came without, once a material asks for one
 *
 * A scene file's own needs are met when it is read. A material that is dressed or set later may be the first
 * to be brushed or to have a normal map. */
#ifndef WEFT_SCENE_TANGENTS_H
#define WEFT_SCENE_TANGENTS_H

#include "scene/record/scene.h"

/* The input whose map tangents of this material are for, or NULL where it needs none. */
const Input *tangents_input(const Material *material);

/* Returns true if the mesh has texture coordinates for the input from which the direction of u follows:
 * they must not all be equal. */
bool tangents_possible(const Mesh *mesh, const Input *input);

/* Gives every mesh that needs tangents, has texture coordinates and no tangents, some: at each vertex the sum
 * over its triangles, each weighted by its size. A map that is mirrored across an edge needs vertices of its
 * own on either side, as files have them. Fails with MEMORY. */
WeftResult tangents_complete(WeftScene *scene, WeftError *error);

#endif
