/* extent.h - memory of a decoded image, from its header alone */
#pragma once

#include "gltf/asset/asset.h"

/* Returns an upper bound of the bytes of the decoded pixels, exact but for the number of channels; with those of mip levels of
 * its own and the file that is kept for them, if there are any. For Radiance HDR and OpenEXR it is the most that the readers
 * decode of a file of this size. 0: the image certainly does not decode. */
size_t extent_bytes(Span image);
