/* ktx2_write.c - a picture and its mip levels as KTX 2: UASTC packed by Zstandard, as KHR_texture_basisu takes it */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <zstd.h>

#include "base/fail.h"
#include "base/memory.h"
#include "base/stream_reason.h"
#include "base/thread.h"
#include "image/codec.h"
#include "image/halve.h"
#include "image/ktx2/uastc_encode.h"
#include "image/pixel.h"

enum { LEVELS_MOST = 17, HEADER = 80, LEVEL = 24, DESCRIPTOR = 44, EFFORT = 15 };

/* The keys of the file, each with its length before and zeros behind, so that 4 divides it: rows run down. */
static const char keys[] = "\x12\0\0\0KTXorientation\0rd\0\0\0\x0f\0\0\0KTXwriter\0weft\0";
enum { KEYS = sizeof keys };

/* A level while it is made. */
typedef struct MipLevel {
    int width, height;
    uint8_t *texels; /* of four channels */
    unsigned char *packed;
    size_t size, unpacked;
} MipLevel;

typedef struct Ktx2Job {
    const char *name;
    UastcEnds *ends;
    MipLevel levels[LEVELS_MOST];
    int level_count;
    bool alpha, data;
    /* of the level at hand */
    const MipLevel *level;
    unsigned char *blocks;
} Ktx2Job;

/* Returns the texels of an image with red, green, blue and alpha of 8 bits, or NULL. */
static uint8_t *texels_of(const WeftImage *image) {
    const size_t count = (size_t)image->width * (size_t)image->height, channels = (size_t)image->channels;
    uint8_t *texels = alloc_array(count, 4);
    for (size_t n = 0; texels && n < count; n++)
        for (size_t c = 0; c < 4; c++) {
            const bool is_alpha = c == 3, has_alpha = channels % 2 == 0;
            const size_t from = is_alpha ? channels - 1 : channels < 3 ? 0 : c;
            texels[4 * n + c] =
                is_alpha && !has_alpha ? 255 : (uint8_t)lround(pixel_value(image, n * channels + from) * 255.0);
        }
    return texels;
}

/* Encodes a row of blocks; those at the right and lower edge repeat its texels. */
static void row_encode(void *user, int row, int thread) {
    (void)thread;
    const Ktx2Job *job = user;
    const MipLevel *level = job->level;
    const int columns = (level->width + 3) / 4;
    for (int column = 0; column < columns; column++) {
        uint8_t texels[UASTC_TEXELS][4];
        for (int t = 0; t < UASTC_TEXELS; t++) {
            const int x = 4 * column + t % 4, y = 4 * row + t / 4;
            const size_t at = (size_t)(y < level->height ? y : level->height - 1) * (size_t)level->width +
                              (size_t)(x < level->width ? x : level->width - 1);
            memcpy(texels[t], level->texels + 4 * at, 4);
        }
        uastc_encode(job->ends, texels, job->blocks + ((size_t)row * (size_t)columns + (size_t)column) * UASTC_BYTES);
    }
}

static WeftResult level_pack(Ktx2Job *job, MipLevel *level, WeftError *error) {
    const int rows = (level->height + 3) / 4;
    level->unpacked = (size_t)((level->width + 3) / 4) * (size_t)rows * UASTC_BYTES;
    const size_t room = ZSTD_compressBound(level->unpacked);
    unsigned char *blocks = alloc_array(level->unpacked, 1);
    level->packed = alloc_array(room, 1);
    WeftResult result = blocks && level->packed ? WEFT_OK : fail(error, WEFT_MESSAGE_MEMORY, job->name, NULL);
    if (result == WEFT_OK) {
        job->level = level;
        job->blocks = blocks;
        parallel_for(0, rows, row_encode, job);
        level->size = ZSTD_compress(level->packed, room, blocks, level->unpacked, EFFORT);
        if (ZSTD_isError(level->size))
            result = fail(error, WEFT_MESSAGE_MEMORY, job->name, "Zstandard: %s", ZSTD_getErrorName(level->size));
    }
    free(blocks);
    return result;
}

/* Takes the texels of the levels that the caller has. */
static WeftResult levels_take(Ktx2Job *job, const WeftImage *image, const WeftImageWriting *how, WeftError *error) {
    for (int k = 0; k <= how->level_count; k++) {
        const WeftImage *from = k ? &how->levels[k - 1] : image;
        const int width = k ? halved(job->levels[k - 1].width) : image->width;
        const int height = k ? halved(job->levels[k - 1].height) : image->height;
        if (k == LEVELS_MOST || from->width != width || from->height != height || from->type == WEFT_PIXEL_F32)
            return fail(error, WEFT_MESSAGE_DESC, job->name,
                        "level %d is not half of the one before, of bytes or words", k);
        job->levels[k] = (MipLevel){.width = width, .height = height, .texels = texels_of(from)};
        job->level_count = k + 1;
        if (!job->levels[k].texels) return fail(error, WEFT_MESSAGE_MEMORY, job->name, NULL);
    }
    return WEFT_OK;
}

/* Adds levels down to a single texel, each the mean of the one before. */
static WeftResult levels_add(Ktx2Job *job, WeftError *error) {
    for (; job->level_count < LEVELS_MOST; job->level_count++) {
        const MipLevel *last = &job->levels[job->level_count - 1];
        if (last->width == 1 && last->height == 1) break;
        MipLevel *next = &job->levels[job->level_count];
        *next = (MipLevel){.width = halved(last->width), .height = halved(last->height)};
        next->texels = alloc_array((size_t)next->width * (size_t)next->height, 4);
        if (!next->texels) return fail(error, WEFT_MESSAGE_MEMORY, job->name, NULL);
        halve_u8(last->texels, last->width, last->height, !job->data, next->texels);
    }
    return WEFT_OK;
}

static void number_write(FILE *stream, uint64_t number, int size) {
    for (int k = 0; k < size; k++) fputc((int)(number >> 8 * k & 255), stream);
}

/* Writes the basic descriptor: UASTC blocks of 4 x 4, linear data or sRGB colours with the primaries of BT.709. */
static void descriptor_write(FILE *stream, const Ktx2Job *job) {
    const unsigned char model[] = {166, job->data ? 0 : 1, job->data ? 1 : 2, 0, 3, 3, 0, 0, UASTC_BYTES, 0, 0, 0};
    number_write(stream, DESCRIPTOR, 4);
    number_write(stream, 0, 4);
    number_write(stream, 2 | (DESCRIPTOR - 4) << 16, 4);
    fwrite(model, 1, sizeof model, stream);
    number_write(stream, 0, 4);
    number_write(stream, 127 << 16 | (job->alpha ? 3u : 0u) << 24, 4);
    number_write(stream, 0, 8);
    number_write(stream, 0xffffffff, 4);
}

/* Writes the header, and the levels from the smallest, as the format has them. */
static WeftResult file_write(FILE *stream, const Ktx2Job *job, WeftError *error) {
    const int count = job->level_count;
    const uint32_t start = (uint32_t)(HEADER + LEVEL * count);
    const uint32_t words[] = {0,
                              1,
                              (uint32_t)job->levels[0].width,
                              (uint32_t)job->levels[0].height,
                              0,
                              0,
                              1,
                              (uint32_t)count,
                              2,
                              start,
                              DESCRIPTOR,
                              start + DESCRIPTOR,
                              KEYS,
                              0,
                              0,
                              0,
                              0};
    uint64_t at = start + DESCRIPTOR + KEYS, ends[LEVELS_MOST];
    fwrite("\xabKTX 20\xbb\r\n\x1a\n", 1, 12, stream);
    for (size_t k = 0; k < sizeof words / sizeof *words; k++) number_write(stream, words[k], 4);
    for (int k = count; k-- > 0;) at = ends[k] = at + job->levels[k].size;
    for (int k = 0; k < count; k++) {
        number_write(stream, ends[k] - job->levels[k].size, 8);
        number_write(stream, job->levels[k].size, 8);
        number_write(stream, job->levels[k].unpacked, 8);
    }
    descriptor_write(stream, job);
    fwrite(keys, 1, KEYS, stream);
    for (int k = count; k-- > 0;) fwrite(job->levels[k].packed, 1, job->levels[k].size, stream);
    return ferror(stream) ? fail(error, WEFT_MESSAGE_FILE_WRITE, job->name, "%s", stream_reason(stream)) : WEFT_OK;
}

WeftResult image_write_ktx2(FILE *stream, const char *name, const WeftImage *image, const WeftImageWriting *how,
                            WeftError *error) {
    Ktx2Job job = {.name = name, .alpha = image->channels % 2 == 0, .data = how->data != 0};
    job.ends = alloc_array(1, sizeof *job.ends);
    WeftResult result = job.ends ? levels_take(&job, image, how, error) : fail(error, WEFT_MESSAGE_MEMORY, name, NULL);
    if (result == WEFT_OK && !how->level_count) result = levels_add(&job, error);
    if (result == WEFT_OK) uastc_ends_make(job.ends);
    for (int k = 0; k < job.level_count && result == WEFT_OK; k++) result = level_pack(&job, &job.levels[k], error);
    if (result == WEFT_OK) result = file_write(stream, &job, error);
    for (int k = 0; k < job.level_count; k++) {
        free(job.levels[k].texels);
        free(job.levels[k].packed);
    }
    free(job.ends);
    return result;
}
