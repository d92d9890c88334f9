/* tangent.h - tangents for meshes whose file has none
 *
 * A normal map is read in a frame whose tangent is the direction of growing u on the surface. The direction
 * is averaged over the faces around a vertex, each weighted by its angle there. Where the map is mirrored on
 * one side of a vertex, the vertex is split. The method follows Morten S. Mikkelsen, "Simulation of Wrinkled
 * Surfaces Revisited", University of Copenhagen, 2008. Unlike his library it does not distinguish fans of one
 * orientation that touch only at a vertex. */
#pragma once

#include "gltf/asset/asset.h"

/* Gives the mesh tangents for maps placed like input (its UV set and transform); the mesh must have those
 * texture coordinates. A mesh without normals gets the normals of its faces, on vertices that are not shared.
 * Sticky failures: MEMORY, GLTF_TOO_LARGE. */
void tangents_make(Asset *asset, Mesh *mesh, const Input *input);
