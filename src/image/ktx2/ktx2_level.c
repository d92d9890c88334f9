/* ktx2_level.c - the bytes of a level, and pictures of those that are numbers or UASTC */
#include <limits.h>
#include <stdlib.h>
#include <string.h>

#define ZLIB_CONST /* zlib does not write to its input */
#include <zlib.h>
#include <zstd.h>

#include "base/fail.h"
#include "base/little_endian.h"
#include "base/memory.h"
#include "image/half.h"
#include "image/ktx2/ktx2.h"
#include "image/ktx2/uastc.h"

/* The first bytes of a level while they are unpacked, and no more than those. */
typedef struct Unpacking {
    const unsigned char *data;
    size_t size; /* of data */
    unsigned char *to;
    size_t wanted, got;
    const char *why; /* what is wrong with the data; NULL: nothing, but there may be too few */
} Unpacking;

/* Unpacks a frame of Zstandard. Returns false if memory is short. */
static bool zstd_unpack(Unpacking *u) {
    ZSTD_DStream *stream = ZSTD_createDStream();
    ZSTD_inBuffer in = {.src = u->data, .size = u->size, .pos = 0};
    ZSTD_outBuffer out = {.dst = u->to, .size = u->wanted, .pos = 0};
    size_t left = 1;
    while (stream && !u->why && left && out.pos < u->wanted) {
        const size_t before = in.pos + out.pos;
        left = ZSTD_decompressStream(stream, &out, &in);
        if (ZSTD_isError(left))
            u->why = ZSTD_getErrorName(left);
        else if (in.pos + out.pos == before)
            left = 0; /* the frame wants more than there is */
    }
    ZSTD_freeDStream(stream);
    u->got = out.pos;
    return stream != NULL;
}

/* Unpacks a stream of zlib. Returns false if memory is short. */
static bool zlib_unpack(Unpacking *u) {
    const size_t most = UINT_MAX; /* of a call: what lies behind it is not read */
    z_stream stream = {.next_in = u->data,
                       .avail_in = (uInt)(u->size < most ? u->size : most),
                       .next_out = u->to,
                       .avail_out = (uInt)(u->wanted < most ? u->wanted : most)};
    if (inflateInit(&stream) != Z_OK) return false;
    const int end = inflate(&stream, Z_SYNC_FLUSH);
    u->got = stream.total_out;
    if (end != Z_OK && end != Z_STREAM_END && end != Z_BUF_ERROR) u->why = stream.msg ? stream.msg : "damaged data";
    inflateEnd(&stream);
    return end != Z_MEM_ERROR;
}

/* Unpacks the first wanted bytes of a level. */
static WeftResult unpack(const Ktx2 *file, const unsigned char *data, size_t size, size_t wanted, Ktx2Bytes *out,
                         WeftError *error) {
    const char *name = file->source->name;
    const bool zlib = file->scheme == KTX2_ZLIB;
    Unpacking u = {.data = data, .size = size, .to = alloc_array(wanted, 1), .wanted = wanted};
    WeftResult result = WEFT_OK;
    if (!u.to || !(zlib ? zlib_unpack(&u) : zstd_unpack(&u)))
        result = fail(error, WEFT_MESSAGE_MEMORY, name, NULL);
    else if (u.why)
        result = fail(error, WEFT_MESSAGE_IMAGE_DAMAGED, name, "KTX 2: %s: %s", zlib ? "zlib" : "Zstandard", u.why);
    else if (u.got < wanted)
        result =
            fail(error, WEFT_MESSAGE_IMAGE_DAMAGED, name, "KTX 2: a level unpacks to %zu bytes of %zu", u.got, wanted);
    if (result != WEFT_OK) {
        free(u.to);
        u.to = NULL;
    }
    *out = (Ktx2Bytes){.data = u.to, .size = u.to ? wanted : 0, .owned = u.to};
    return result;
}

WeftResult ktx2_level_bytes(const Ktx2 *file, int level, size_t skip, size_t size, Ktx2Bytes *out, WeftError *error) {
    const ImageSource *source = file->source;
    const unsigned char *entry = source->data + 80 + 24 * (size_t)level;
    const uint64_t at = little_endian(entry, 8), length = little_endian(entry + 8, 8), wanted = skip + size;
    *out = (Ktx2Bytes){0};
    if (at > source->size || length > source->size - at)
        return fail(error, WEFT_MESSAGE_IMAGE_SIZE, source->name, "KTX 2: level %d lies behind its end", level);
    if ((file->scheme != KTX2_NONE ? little_endian(entry + 16, 8) : length) < wanted)
        return fail(error, WEFT_MESSAGE_IMAGE_SIZE, source->name, "KTX 2: level %d has less than its %llu bytes", level,
                    (unsigned long long)wanted);
    if (file->scheme == KTX2_NONE) {
        *out = (Ktx2Bytes){.data = source->data + at + skip, .size = size, .owned = NULL};
        return WEFT_OK;
    }
    WeftResult result = unpack(file, source->data + at, (size_t)length, (size_t)wanted, out, error);
    if (result == WEFT_OK) {
        out->data += skip;
        out->size = size;
    }
    return result;
}

/* Returns the float of an unsigned one of so many bits, of which 5 are its exponent. */
static float small_float(uint32_t bits, int count) { return half_value(bits << (15 - count)); }

/* Fills the floats of a packed texel. */
static void packed_take(uint32_t word, Ktx2Coding coding, float color[3]) {
    if (coding == KTX2_B10G11R11) {
        color[0] = small_float(word & 0x7ff, 11);
        color[1] = small_float(word >> 11 & 0x7ff, 11);
        color[2] = small_float(word >> 22, 10);
        return;
    }
    for (int c = 0; c < 3; c++) color[c] = ldexpf((float)(word >> 9 * c & 0x1ff), (int)(word >> 27) - 24);
}

/* Converts one number of the file. */
static void number_put(const unsigned char *at, Ktx2Coding coding, size_t to, WeftImage *out) {
    switch (coding) {
    case KTX2_BYTES: ((uint8_t *)out->pixels)[to] = at[0]; break;
    case KTX2_WORDS: ((uint16_t *)out->pixels)[to] = (uint16_t)little_endian(at, 2); break;
    case KTX2_HALVES: ((float *)out->pixels)[to] = half_value((unsigned)little_endian(at, 2)); break;
    default: ((float *)out->pixels)[to] = little_endian_float(at); break;
    }
}

static void numbers_put(const Ktx2 *file, const unsigned char *at, size_t bytes, WeftImage *out) {
    const size_t stored = (size_t)file->stored, channels = (size_t)out->channels;
    const size_t count = (size_t)out->width * (size_t)out->height;
    const bool packed = file->coding >= KTX2_B10G11R11;
    for (size_t n = 0; n < count; n++, at += packed ? 4 : stored * bytes) {
        if (packed) packed_take((uint32_t)little_endian(at, 4), file->coding, (float *)out->pixels + 3 * n);
        for (size_t c = 0; c < channels && !packed; c++)
            if (file->from[c] != KTX2_NOTHING)
                number_put(at + (size_t)file->from[c] * bytes, file->coding, n * channels + c, out);
    }
}

void ktx2_block_put(const Ktx2 *file, uint8_t texels[16][4], uint32_t column, uint32_t row, WeftImage *out) {
    const size_t width = (size_t)out->width, height = (size_t)out->height, channels = (size_t)out->channels;
    uint8_t *pixels = out->pixels;
    for (size_t t = 0; t < 16; t++) {
        const size_t x = 4 * (size_t)column + t % 4, y = 4 * (size_t)row + t / 4;
        if (x >= width || y >= height) continue;
        for (size_t c = 0; c < channels; c++)
            if (file->from[c] != KTX2_NOTHING) pixels[(y * width + x) * channels + c] = texels[t][file->from[c]];
    }
}

static WeftResult uastc_put(const Ktx2 *file, const unsigned char *at, WeftImage *out, WeftError *error) {
    const uint32_t columns = (uint32_t)(out->width + 3) / 4, rows = (uint32_t)(out->height + 3) / 4;
    for (uint32_t y = 0; y < rows; y++)
        for (uint32_t x = 0; x < columns; x++, at += UASTC_BYTES) {
            uint8_t texels[UASTC_TEXELS][4];
            if (!uastc_decode(at, texels))
                return fail(
                    error, WEFT_MESSAGE_IMAGE_DAMAGED, file->source->name,
                    "KTX 2: the UASTC block %u to the right and %u down has a mode or pattern that does not exist",
                    (unsigned)x, (unsigned)y);
            ktx2_block_put(file, texels, x, y, out);
        }
    return WEFT_OK;
}

/* Turns a picture so that its first row is the top one, and the first texel of a row the left one. */
static void orient(const Ktx2 *file, WeftImage *image) {
    const size_t texel = (size_t)image->channels * (image->type == WEFT_PIXEL_F32   ? 4
                                                    : image->type == WEFT_PIXEL_U16 ? 2
                                                                                    : 1);
    const size_t width = (size_t)image->width, height = (size_t)image->height, count = width * height;
    unsigned char *pixels = image->pixels;
    for (size_t n = 0; n < count; n++) {
        const size_t x = n % width, y = n / width;
        const size_t other = (file->from_bottom ? height - 1 - y : y) * width + (file->from_right ? width - 1 - x : x);
        if (other <= n) continue;
        unsigned char kept[16];
        memcpy(kept, pixels + n * texel, texel);
        memcpy(pixels + n * texel, pixels + other * texel, texel);
        memcpy(pixels + other * texel, kept, texel);
    }
}

/* Reads a face of texels that are numbers or UASTC blocks. */
static WeftResult picture_read(const Ktx2 *file, int level, int face, WeftImage *out, WeftError *error) {
    static const size_t number_bytes[] = {1, 2, 2, 4, 4, 4, 0};
    const bool packed = file->coding == KTX2_B10G11R11 || file->coding == KTX2_E5B9G9R9;
    const size_t width = (size_t)out->width, height = (size_t)out->height, bytes = number_bytes[file->coding];
    const size_t slice = file->coding == KTX2_UASTC ? (width + 3) / 4 * ((height + 3) / 4) * UASTC_BYTES
                                                    : width * height * (packed ? 4 : bytes * (size_t)file->stored);
    Ktx2Bytes data;
    WeftResult result =
        ktx2_level_bytes(file, level, (size_t)face * ktx2_side(file->depth, level) * slice, slice, &data, error);
    if (!data.data) return result;
    if (file->coding == KTX2_UASTC)
        result = uastc_put(file, data.data, out, error);
    else
        numbers_put(file, data.data, bytes, out);
    free(data.owned);
    return result;
}

WeftResult ktx2_picture(const Ktx2 *file, int level, int face, WeftImage *out, WeftError *error) {
    static const WeftPixelType types[] = {WEFT_PIXEL_U8,  WEFT_PIXEL_U16, WEFT_PIXEL_F32, WEFT_PIXEL_F32,
                                          WEFT_PIXEL_F32, WEFT_PIXEL_F32, WEFT_PIXEL_U8,  WEFT_PIXEL_U8};
    const uint32_t width = ktx2_side(file->width, level), height = ktx2_side(file->height, level);
    WeftResult result = weft_image_create((int)width, (int)height, file->channels, types[file->coding], out, error);
    if (result != WEFT_OK) return result;
    result = file->coding == KTX2_ETC1S ? ktx2_etc1s_picture(file, level, face, out, error)
                                        : picture_read(file, level, face, out, error);
    if (result != WEFT_OK) {
        weft_image_free(out);
        return result;
    }
    if (file->from_bottom || file->from_right) orient(file, out);
    if (out->type == WEFT_PIXEL_F32) image_repair(file->source, out);
    return WEFT_OK;
}
