/* pixel.h - sizes of pixels in memory */
#pragma once

#include <stddef.h>

#include "weft/image.h"

/* Returns the bytes of one channel. */
static inline size_t pixel_type_size(WeftPixelType type) {
    return type == WEFT_PIXEL_U8 ? 1 : type == WEFT_PIXEL_U16 ? 2 : 4;
}
