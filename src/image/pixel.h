/* pixel.h - sizes and values of pixels in memory */
#pragma once

#include <math.h>
#include <stddef.h>
#include <stdint.h>

#include "weft/image.h"

/* Returns the bytes of one channel. */
static inline size_t pixel_type_size(WeftPixelType type) {
    return type == WEFT_PIXEL_U8 ? 1 : type == WEFT_PIXEL_U16 ? 2 : 4;
}

/* Returns number k of an image, counted over channels and pixels: integers as a share of the largest, 0 to 1. */
static inline double pixel_value(const WeftImage *image, size_t k) {
    switch (image->type) {
    case WEFT_PIXEL_U8: return ((const uint8_t *)image->pixels)[k] / 255.0;
    case WEFT_PIXEL_U16: return ((const uint16_t *)image->pixels)[k] / 65535.0;
    default: return (double)((const float *)image->pixels)[k];
    }
}

/* Returns the byte of a share of the largest; what is below 0 or above 1 is taken as that. */
static inline unsigned char pixel_byte(float x) { return (unsigned char)lrintf(255.0f * fminf(fmaxf(x, 0.0f), 1.0f)); }
