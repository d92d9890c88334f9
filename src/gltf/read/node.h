/* node.h - the scene graph: parents and children, transforms, and what is shown */
#pragma once

#include "gltf/asset/asset.h"

/* Sets asset->nodes with world transforms and marks what the default scene shows: "scene", else the first
 * scene, else every root. What nodes refer to must have been counted before. */
void nodes_read(Asset *asset);
