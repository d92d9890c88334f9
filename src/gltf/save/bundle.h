/* bundle.h - the files beside an asset when it is written elsewhere: packed into it, or copied */
#pragma once

#include "gltf/asset/asset.h"
#include "gltf/save/saving.h"

/* Returns the bytes of a URI of the asset. There are none if it is an address on the network or if its file
 * cannot be read, which sets *result. Release with free(data). */
FileBytes bundle_bytes(const Asset *asset, const char *uri, WeftResult *result, WeftError *error);

/* Packs the buffers and images to which saving->root refers, in the asset, into the bytes of saving. These
 * stay as they are: addresses on the network, images of a kind that glTF has no name for, and all buffers if
 * the first has no bytes. */
void bundle_pack(Saving *saving, const Asset *asset);

/* Copies the files to which saving->root still refers from the asset's folder to that of saving->path, unless the
 * folders are the same. A missing file is no error; a file that is already there must have the same bytes. */
void bundle_copy(Saving *saving, const Asset *asset);
