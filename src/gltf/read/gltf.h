/* gltf.h - glTF 2.0 files into scenes
 *
 * Specification: Khronos Group, "glTF 2.0 Specification", 2021 (ISO/IEC 12113:2022), and its extension
 * registry. */
#ifndef WEFT_GLTF_GLTF_H
#define WEFT_GLTF_GLTF_H

#include <stddef.h>

#include "gltf/asset/asset.h"

/* Reads the file at path, or, where data is not NULL, size bytes of it; path then only names it in messages
 * and files beside it are refused. Fills scene (made by scene_create) with everything the file's default
 * scene shows. On failure the scene holds whatever was read so far and can only be freed. */
WeftResult gltf_read(const char *path, const void *data, size_t size, WeftScene *scene, const WeftLog *log,
                     WeftError *error);

/* Works as gltf_read, with progress (may be NULL), which can stop it: WEFT_INTERRUPTED. */
WeftResult gltf_read_watched(const char *path, const void *data, size_t size, WeftScene *scene,
                             WeftProgress progress, void *user, const WeftLog *log, WeftError *error);

/* Works as gltf_read, in three steps, for callers that need more than the scene. The caller sets what is to be
 * known of log, error, progress, user and, before the second step, scene; the rest is 0. Opening leaves root,
 * text, bin and packed; reading, all records; closing is due however either ended, before the scene is
 * freed. */
void gltf_open(Asset *asset, const char *path, const void *data, size_t size);
void gltf_read_parts(Asset *asset);
void gltf_close(Asset *asset);

/* Returns true if weft supports the extension, so that an asset may require it. */
bool gltf_supports(const char *extension);

#endif
