/* gltf.h - reads glTF 2.0 files into scenes
 *
 * Specification: Khronos Group, "glTF 2.0 Specification", 2021 (ISO/IEC 12113:2022), and its extension registry. */
#pragma once

#include <stddef.h>

#include "gltf/asset/asset.h"

/* Reads the file at path or, if data is not NULL, size bytes of data; path then only names them in messages,
 * and files beside it are refused. Fills scene (made by scene_create) with everything that the default scene
 * of the file shows. After a failure the scene is incomplete and can only be freed. */
WeftResult gltf_read(const char *path, const void *data, size_t size, WeftScene *scene, const WeftLog *log,
                     WeftError *error);

/* Works as gltf_read at a moment of an animation (may be NULL: at rest) and reports progress (may be NULL), which can
 * stop it with WEFT_INTERRUPTED. */
WeftResult gltf_read_watched(const char *path, const void *data, size_t size, const WeftMoment *moment,
                             WeftScene *scene, WeftProgress progress, void *user, const WeftLog *log, WeftError *error);

/* Reads like gltf_read, in three steps, for callers that need more than the scene. The caller sets log, error, progress
 * and user, and scene before the second step; the rest of asset is 0. gltf_open sets root, text, bin and packed.
 * gltf_read_parts fills all records. gltf_close is due whatever failed, before the scene is freed. */
void gltf_open(Asset *asset, const char *path, const void *data, size_t size);
void gltf_read_parts(Asset *asset);
void gltf_close(Asset *asset);

/* Returns true if weft supports the extension, so that an asset may require it. */
bool gltf_supports(const char *extension);
