/* extent.h - memory of a decoded image, from its header alone */
#ifndef WEFT_GLTF_EXTENT_H
#define WEFT_GLTF_EXTENT_H

#include "gltf/asset/asset.h"

/* An upper bound of the bytes of its pixels once decoded, exact but for the channels; for Radiance HDR and
 * OpenEXR the most that is decoded of a file of this size. 0 where it certainly does not decode. */
size_t extent_bytes(Span image);

#endif
