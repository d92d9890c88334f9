/* node.h - the scene graph: parents and children, transforms, and what is shown */
#pragma once

#include "gltf/asset/asset.h"

/* Returns the transform of a translation, a rotation (a quaternion x, y, z, w of any length; the identity if that is 0 or
 * not finite) and a scale. */
Transform node_transform(const double t[3], const double q[4], const double s[3]);

/* Sets asset->nodes with world transforms and marks what the default scene shows: "scene", else the first
 * scene, else every root; and what KHR_node_visibility hides. What nodes refer to must have been counted before. */
void nodes_read(Asset *asset);
