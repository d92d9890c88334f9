/* tangent.h - tangents where a file brings none
 *
 * The frame in which a normal map is read: the tangent is the direction of growing u on the surface, made
 * smooth over the faces around a vertex, each weighted by its angle there; where the map is mirrored on one
 * side of a vertex the vertex is split. In the spirit of: Morten S. Mikkelsen, "Simulation of Wrinkled
 * Surfaces Revisited", University of Copenhagen, 2008. Unlike his library it does not distinguish fans of one
 * orientation that touch only at a vertex. */
#ifndef WEFT_GLTF_TANGENT_H
#define WEFT_GLTF_TANGENT_H

#include "gltf/asset/asset.h"

/* Gives the mesh tangents for maps placed like input (its UV set and transform), which must have texture
 * coordinates. A mesh without normals gets those of its faces, unshared. Sticky failures: MEMORY,
 * GLTF_TOO_LARGE. */
void tangents_make(Asset *asset, Mesh *mesh, const Input *input);

#endif
