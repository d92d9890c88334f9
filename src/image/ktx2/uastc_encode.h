/* uastc_encode.h - texels to blocks of UASTC LDR
 *
 * Every mode whose channels fit is tried: along the principal axis of each subset's colours (Simon Brown, "DXT Compression
 * Techniques", 2006, has the method for other blocks), refined by least squares, and kept if its squares of errors are the
 * fewest. */
#pragma once

#include "image/ktx2/uastc.h"

/* The endpoints that each mode has, by the nearest to each value. */
typedef struct UastcEnds {
    uint8_t digit[UASTC_MODES][256], bits[UASTC_MODES][256], value[UASTC_MODES][256];
} UastcEnds;

void uastc_ends_make(UastcEnds *out);

/* Encodes texels of red, green, blue and alpha, row by row. Every channel counts alike, where alpha is 255 throughout only
 * the colours. */
void uastc_encode(const UastcEnds *ends, uint8_t texels[UASTC_TEXELS][4], unsigned char block[UASTC_BYTES]);
