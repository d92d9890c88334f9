/* fuzz_png - the PNG reader: libpng as we set it up, every colour type, interlace, damaged and cut files
 *
 * Any input must be read or refused with one line; sanitizers watch the rest. The check sums of the chunks
 * are put right first: a mutation would otherwise never get beyond them. */
#include "image_input.h"

#include <zlib.h>

static uint32_t big_endian(const uint8_t *at) {
    return (uint32_t)at[0] << 24 | (uint32_t)at[1] << 16 | (uint32_t)at[2] << 8 | at[3];
}

static void checksums_repair(uint8_t *data, size_t size) {
    for (size_t at = 8; at < size && size - at >= 12;) {
        const uint32_t length = big_endian(data + at);
        if (length > size - at - 12) return;
        const uLong sum = crc32(0, data + at + 4, length + 4);
        for (int i = 0; i < 4; i++) data[at + 8 + length + (size_t)i] = (uint8_t)(sum >> (24 - 8 * i));
        at += 12 + (size_t)length;
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    uint8_t *copy = malloc(size ? size : 1);
    if (!copy) return 0;
    if (size) memcpy(copy, data, size);
    checksums_repair(copy, size);
    image_input(image_read_png, copy, size);
    free(copy);
    return 0;
}
