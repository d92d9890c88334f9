/* container.h - the container of a glTF file: GLB chunks or bare JSON */
#pragma once

#include "gltf/asset/asset.h"

/* Sets asset->root and ->text and, of a GLB, ->packed, ->bin and ->behind (which point into data). Sticky
 * failures: SCENE_KIND, GLTF_CONTAINER, GLTF_JSON, GLTF_VERSION (of the container), GLTF_TOO_LARGE. */
void container_read(Asset *asset, Span data);

/* Makes the head of a GLB: all before the data of its BIN chunk, which has `bin` bytes (a multiple of 4; 0: there is no
 * such chunk) and which `behind` bytes of other chunks follow. Returns NULL if memory is short. Release with free(). */
unsigned char *container_head(Span text, size_t bin, size_t behind, size_t *size);
