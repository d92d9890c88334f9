/* container.h - the outside of a glTF file: GLB chunks or plain JSON */
#ifndef WEFT_GLTF_CONTAINER_H
#define WEFT_GLTF_CONTAINER_H

#include "gltf/asset.h"

/* Sets asset->root and, for a GLB with one, asset->bin (which points into data). Sticky failures:
 * SCENE_KIND, GLTF_CONTAINER, GLTF_JSON, GLTF_VERSION (of the container), GLTF_TOO_LARGE. */
void container_read(Asset *asset, Span data);

#endif
