/* gltf_camera.h - cameras of glTF nodes */
#pragma once

#include "gltf/asset/asset.h"

/* Counts the cameras, before the nodes that refer to them are read. */
void cameras_count(Asset *asset);

/* Adds the cameras of the shown nodes to the scene, in the order of nodes. */
void cameras_read(Asset *asset);
