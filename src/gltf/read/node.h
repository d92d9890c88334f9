/* node.h - the scene graph: who is whose child, where everything stands, and what is shown */
#ifndef WEFT_GLTF_NODE_H
#define WEFT_GLTF_NODE_H

#include "gltf/asset/asset.h"

/* Counts of what nodes refer to must be known. Sets asset->nodes with world transforms and the marks of what
 * the default scene shows: "scene", else the first scene, else every root. */
void nodes_read(Asset *asset);

#endif
