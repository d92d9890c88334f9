/* uastc_etc1.h - hints of a block of UASTC for who makes a block of ETC1 or ETC2 of it, where a GPU has nothing else */
#pragma once

#include <stdint.h>

#include "image/ktx2/uastc.h"

/* Tells how the texels are cut in two, how the base colours are kept, and the row of intensities of either half. */
typedef struct UastcEtc1 {
    unsigned flip, differential; /* 1: an upper and a lower half; 1: 5 bits and a difference, 0: 4 bits each */
    unsigned intensity[2];
} UastcEtc1;

/* Returns the hint whose block of ETC1 is nearest to the texels. */
UastcEtc1 uastc_etc1_find(uint8_t texels[UASTC_TEXELS][4]);

/* Returns the hint for the alpha of a block of ETC2: the number of a row of modifiers, and above it, from bit 4, the
 * multiplier, for the values between the least and the greatest alpha. */
unsigned uastc_etc2_alpha(uint8_t texels[UASTC_TEXELS][4]);

/* A block of one colour in ETC1: its base of 5 bits, or 4, and the intensity and selector of all its texels. */
typedef struct UastcEtc1Solid {
    unsigned differential, intensity, selector, base[3];
} UastcEtc1Solid;

UastcEtc1Solid uastc_etc1_solid(const uint8_t color[4]);
