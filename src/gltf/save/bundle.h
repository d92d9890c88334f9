/* bundle.h - the files beside an asset, when it is written elsewhere: packed into it, or taken along */
#ifndef WEFT_GLTF_BUNDLE_H
#define WEFT_GLTF_BUNDLE_H

#include "gltf/asset/asset.h"
#include "gltf/save/saving.h"

/* The bytes behind a URI of the asset; none where it is an address on the network, and where its file cannot
 * be read, which *result then says. Release with free(data). */
FileBytes bundle_bytes(const Asset *asset, const char *uri, WeftResult *result, WeftError *error);

/* Puts the buffers and images that saving->root refers to, of the asset, into saving's bytes. What cannot be
 * packed stays as it is: addresses on the network, images of a kind that glTF has no name for, and all
 * buffers where the first has no bytes. */
void bundle_pack(Saving *saving, const Asset *asset);

/* Copies the files that saving->root still refers to from the asset's folder to that of saving->path, unless
 * they are one. A file that is not there is nobody's loss; one that is there already must be the same. */
void bundle_copy(Saving *saving, const Asset *asset);

#endif
