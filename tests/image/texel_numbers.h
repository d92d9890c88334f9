/* texel_numbers.h - numbers of texels that tests put into files of several formats, and what is read of them */
#pragma once

#include "image/fixture.h"

#include <stdbool.h>

static inline void put_single(Bytes *bytes, float value) {
    uint32_t word;
    memcpy(&word, &value, sizeof word);
    put_word(bytes, (int)(word & 0xffff));
    put_word(bytes, (int)(word >> 16));
}

static inline double value_at(const WeftImage *image, int k) {
    return image->type == WEFT_PIXEL_U8    ? (double)((const unsigned char *)image->pixels)[k] / 255.0
           : image->type == WEFT_PIXEL_U16 ? (double)((const uint16_t *)image->pixels)[k] / 65535.0
                                           : (double)((const float *)image->pixels)[k];
}

/* Puts numbers of which k is (k + 1) / 16. */
static inline void put_numbers(Bytes *bytes, int size, bool floats, int count) {
    static const int halves[] = {0x2c00, 0x3000, 0x3200, 0x3400, 0x3500, 0x3600, 0x3700, 0x3800};
    for (int k = 0; k < count; k++)
        if (size == 4)
            put_single(bytes, (float)(k + 1) / 16.0f);
        else if (size == 2)
            put_word(bytes, floats ? halves[k] : (k + 1) * 65535 / 16);
        else
            put_byte(bytes, (k + 1) * 255 / 16);
}
