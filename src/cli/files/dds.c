/* Microsoft, "DDS_HEADER structure", "DDS_HEADER_DXT10 structure" and "DXGI_FORMAT enumeration", Windows
 * documentation, 2022. No library that Debian keeps writes these headers with float formats. */
#include "cli/files/dds.h"

enum {
    FLAGS = 0x1 | 0x2 | 0x4 | 0x8 | 0x1000, /* caps, height, width, pitch, pixel format */
    FOURCC = 0x4,
    CAPS_TEXTURE = 0x1000,
    R32G32B32A32_FLOAT = 2,
    R32G32_FLOAT = 16,
    R32_FLOAT = 41,
    TEXTURE2D = 3,
    WORDS = 32 /* of the magic and the first header; five more follow */
};

static void put_word(FILE *stream, uint32_t word) {
    for (int shift = 0; shift < 32; shift += 8) fputc((int)(word >> shift & 0xff), stream);
}

static uint32_t code(const char letters[4]) {
    return (uint32_t)letters[0] | (uint32_t)letters[1] << 8 | (uint32_t)letters[2] << 16 | (uint32_t)letters[3] << 24;
}

void dds_write(FILE *stream, const WeftImage *image) {
    static const uint32_t formats[] = {0, R32_FLOAT, R32G32_FLOAT, 0, R32G32B32A32_FLOAT};
    const uint32_t words[WORDS] = {
        [0] = code("DDS "),
        [1] = 124, /* bytes of the header */
        [2] = FLAGS,
        [3] = (uint32_t)image->height,
        [4] = (uint32_t)image->width,
        [5] = (uint32_t)(4 * image->width * image->channels),
        [19] = 32, /* bytes of the pixel format */
        [20] = FOURCC,
        [21] = code("DX10"),
        [27] = CAPS_TEXTURE,
    };
    for (int k = 0; k < WORDS; k++) put_word(stream, words[k]);
    const uint32_t more[] = {formats[image->channels], TEXTURE2D, 0, 1, 0};
    for (int k = 0; k < 5; k++) put_word(stream, more[k]);
    const size_t count = (size_t)image->width * (size_t)image->height * (size_t)image->channels;
    for (size_t k = 0; k < count; k++) {
        union {
            float value;
            uint32_t word;
        } texel = {.value = ((const float *)image->pixels)[k]};
        put_word(stream, texel.word);
    }
}
