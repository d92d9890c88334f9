/* srgb.h - the sRGB decoding curve, on [0, 1] (IEC 61966-2-1:1999); shading/dialect/tone.h has the encoding */
#pragma once

#include <math.h>

/* Returns the linear value of a display value. */
static inline float srgb_decode(float display) {
    return display <= 0.04045f ? display / 12.92f : powf((display + 0.055f) / 1.055f, 2.4f);
}
