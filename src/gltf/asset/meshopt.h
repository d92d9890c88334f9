/* meshopt.h - EXT_meshopt_compression, decoded by libmeshoptimizer
 *
 * Specification: Arseny Kapoulkine et al., "EXT_meshopt_compression", Khronos glTF extension registry. */
#ifndef WEFT_GLTF_MESHOPT_H
#define WEFT_GLTF_MESHOPT_H

#include "gltf/asset/asset.h"

/* Why a compressed view of `size` decoded bytes breaks the specification, or NULL. The decoder asserts these,
 * so that meshopt_decode must not be called where this is not NULL. */
const char *meshopt_reason(const Compression *compression, size_t size);

/* Decodes count * stride bytes into out and applies the filter; false where the data are damaged. */
bool meshopt_decode(const Compression *compression, unsigned char *out);

#endif
