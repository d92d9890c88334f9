/* Specifications: W3C, "Portable Network Graphics (PNG) Specification", 2003, section 11.2.2; ITU-T T.81,
 * 1992, annex B (JPEG); Google, "WebP Container Specification", 2010; Khronos, "KTX File Format Specification", version
 * 2.0.4, 2024, section 2.1 (KTX 2). */
#include "gltf/asset/extent.h"

#include <string.h>

#include "base/little_endian.h"

static size_t big16(const unsigned char *p) { return (size_t)p[0] << 8 | p[1]; }

static size_t png_bytes(Span image) {
    enum { HEADER = 26, COLOR = 2 };
    if (image.size < HEADER) return 0;
    const unsigned char *p = image.data + 16;
    size_t width = big16(p) << 16 | big16(p + 2), height = big16(p + 4) << 16 | big16(p + 6);
    size_t channels = p[9] & COLOR ? 4 : 2, depth = p[8] == 16 ? 2 : 1;
    return width < 1 << 17 && height < 1 << 17 ? width * height * channels * depth : 0;
}

/* Reads the first frame header and skips the segments before it, whose lengths are given. */
static size_t jpeg_bytes(Span image) {
    enum { TEM = 0x01, DHT = 0xc4, JPG = 0xc8, DAC = 0xcc, SOF0 = 0xc0, SOF15 = 0xcf, RST0 = 0xd0, SOI = 0xd8 };
    const unsigned char *p = image.data;
    size_t at = 0;
    while (at + 10 < image.size) {
        unsigned char marker = p[at + 1];
        if (p[at] != 0xff || marker == 0xff || marker == 0)
            at++; /* filling, or bytes out of place, which decoders skip */
        else if (marker == TEM || (marker >= RST0 && marker <= SOI))
            at += 2;
        else if (marker < SOF0 || marker > SOF15 || marker == DHT || marker == JPG || marker == DAC)
            at += 2 + big16(p + at + 2);
        else
            return big16(p + at + 5) * big16(p + at + 7) * (p[at + 9] < 4 ? p[at + 9] : 4);
    }
    return 0;
}

/* Reads the first chunk, of one of three kinds, which has the size of the picture. Counts an alpha. */
static size_t webp_bytes(Span image) {
    enum { HEADER = 30, SIDE = 0x3fff };
    const unsigned char *p = image.data + 12;
    if (image.size < HEADER) return 0;
    size_t width = (p[14] | (size_t)p[15] << 8) & SIDE, height = (p[16] | (size_t)p[17] << 8) & SIDE; /* "VP8 " */
    if (p[3] == 'L') {
        width = ((p[9] | (size_t)p[10] << 8) & SIDE) + 1;
        height = ((size_t)p[10] >> 6 | (size_t)p[11] << 2 | ((size_t)p[12] & 15) << 10) + 1;
    } else if (p[3] == 'X') {
        width = (p[12] | (size_t)p[13] << 8 | (size_t)p[14] << 16) + 1;
        height = (p[15] | (size_t)p[16] << 8 | (size_t)p[17] << 16) + 1;
    }
    return width * height * 4;
}

/* Counts four bytes a pixel, because a colour map has at most four bytes an entry. */
static size_t tga_bytes(Span image) {
    enum { HEADER = 18, RUNS = 8 };
    if (image.size < HEADER) return 0;
    const unsigned char *p = image.data;
    int kind = p[2] & ~RUNS;
    if (kind < 1 || kind > 3) return 0;
    return (p[12] | (size_t)p[13] << 8) * (p[14] | (size_t)p[15] << 8) * 4;
}

/* Counts four bytes a pixel of bytes and blocks, sixteen of words and floats, whose formats have numbers from 70 on. Levels
 * of its own add a third, and the file, which is kept with them. */
static size_t ktx2_bytes(Span image) {
    enum { HEADER = 44, FIRST_WORD = 70 };
    if (image.size < HEADER) return 0;
    const size_t format = (size_t)little_endian(image.data + 12, 4), width = (size_t)little_endian(image.data + 20, 4),
                 height = (size_t)little_endian(image.data + 24, 4), levels = (size_t)little_endian(image.data + 40, 4);
    if (width >= 1 << 17 || height >= 1 << 17) return 0;
    const size_t first = width * height * (format < FIRST_WORD ? 4 : 16);
    return levels > 1 ? first + first / 3 + image.size : first;
}

/* Returns the most pixel bytes that the image readers accept for a file of this size. */
static size_t header_bytes(Span image) {
    const size_t always = (size_t)512 << 20;
    return image.size > always / 16 ? image.size * 16 : always;
}

static bool starts(Span image, const char *signature, size_t size) {
    return image.size >= size && memcmp(image.data, signature, size) == 0;
}

size_t extent_bytes(Span image) {
    if (starts(image, "\x89PNG", 4)) return png_bytes(image);
    if (starts(image, "\xff\xd8\xff", 3)) return jpeg_bytes(image);
    if (starts(image, "RIFF", 4) && image.size >= 12 && memcmp(image.data + 8, "WEBP", 4) == 0)
        return webp_bytes(image);
    if (starts(image, "\xabKTX 20\xbb", 8)) return ktx2_bytes(image);
    static const char *const others[] = {"\x76\x2f\x31\x01", "DDS ", "II*", "II+", "MM"}; /* EXR, DDS, TIFF */
    if (starts(image, "#?", 2)) return header_bytes(image);
    for (size_t k = 0; k < sizeof others / sizeof *others; k++)
        if (starts(image, others[k], strlen(others[k]))) return header_bytes(image);
    return tga_bytes(image);
}
