/* meshopt.h - KHR_meshopt_compression and EXT_meshopt_compression, decoded by libmeshoptimizer
 *
 * Specification: Arseny Kapoulkine et al., "EXT_meshopt_compression" and "KHR_meshopt_compression", Khronos
 * glTF extension registry. */
#pragma once

#include "gltf/asset/asset.h"

/* Returns how a compressed view of `size` decoded bytes breaks the specification, or NULL if it does not. The
 * decoder asserts these rules: do not call meshopt_decode unless this is NULL. */
const char *meshopt_reason(const Compression *compression, size_t size);

/* Decodes count * stride bytes into out and applies the filter. Returns why not, or NULL. */
const char *meshopt_decode(const Compression *compression, unsigned char *out);
