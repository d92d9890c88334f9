/* gltf_camera.h - cameras of glTF nodes */
#ifndef WEFT_GLTF_GLTF_CAMERA_H
#define WEFT_GLTF_GLTF_CAMERA_H

#include "gltf/asset/asset.h"

/* Counts the cameras, before the nodes that refer to them are read. */
void cameras_count(Asset *asset);

/* Adds the cameras of the shown nodes to the scene, in the order of nodes. */
void cameras_read(Asset *asset);

#endif
