/* container.h - the outside of a glTF file: GLB chunks or plain JSON */
#ifndef WEFT_GLTF_CONTAINER_H
#define WEFT_GLTF_CONTAINER_H

#include "gltf/asset/asset.h"

/* Sets asset->root and ->text and, of a GLB, ->packed, ->bin and ->behind (which point into data). Sticky
 * failures: SCENE_KIND, GLTF_CONTAINER, GLTF_JSON, GLTF_VERSION (of the container), GLTF_TOO_LARGE. */
void container_read(Asset *asset, Span data);

/* The first bytes of a GLB: all before the bytes of its BIN chunk, of which there are bin (0: there is no
 * such chunk), a multiple of 4, before as many as `behind` of other chunks. NULL where memory is short.
 * Release with free(). */
unsigned char *container_head(Span text, size_t bin, size_t behind, size_t *size);

#endif
