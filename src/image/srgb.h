/* srgb.h - the sRGB transfer function, both ways, on [0, 1] (IEC 61966-2-1:1999) */
#ifndef WEFT_IMAGE_SRGB_H
#define WEFT_IMAGE_SRGB_H

#include <math.h>

/* Display value of a linear one. */
static inline float srgb_encode(float linear) {
    return linear <= 0.0031308f ? 12.92f * linear : 1.055f * powf(linear, 1.0f / 2.4f) - 0.055f;
}

/* Linear value of a display one. */
static inline float srgb_decode(float display) {
    return display <= 0.04045f ? display / 12.92f : powf((display + 0.055f) / 1.055f, 2.4f);
}

#endif
