/* tangents.h - tangents, in the direction of growing u, for meshes without, once a material needs them
 *
 * Reading a file makes the tangents that its materials need. A material that is assigned or set later may be the first
 * to have anisotropy or a normal map. */
#pragma once

#include "scene/record/scene.h"

/* Returns the input for whose map a material needs tangents, or NULL if it needs none. */
const Input *tangents_input(const Material *material);

/* Returns true if the mesh has texture coordinates for the input that give a direction of u, which are not all
 * equal. */
bool tangents_possible(const Mesh *mesh, const Input *input);

/* Makes the tangents of every mesh that needs them, has texture coordinates, and has no tangents: at each vertex the
 * sum over its triangles, weighted by size. A map that is mirrored across an edge needs separate vertices on either
 * side, as files have them. Fails with WEFT_MESSAGE_MEMORY. */
WeftResult tangents_complete(WeftScene *scene, WeftError *error);
