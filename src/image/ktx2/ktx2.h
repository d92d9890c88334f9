/* ktx2.h - a KTX 2 file in memory: its header, and each of its pictures
 *
 * Khronos, "KTX File Format Specification", version 2.0.4, 2024; "Khronos Data Format Specification", version 1.3.1,
 * 2020, for the descriptor and the packed formats. */
#pragma once

#include <stdbool.h>
#include <stdint.h>

#include "image/codec.h"

/* The texels of a file are coded in one of these ways. */
typedef enum Ktx2Coding {
    KTX2_BYTES,   /* 8 bits a channel */
    KTX2_WORDS,   /* 16 bits a channel */
    KTX2_HALVES,  /* floats of 16 bits */
    KTX2_SINGLES, /* floats of 32 bits */
    KTX2_B10G11R11,
    KTX2_E5B9G9R9,
    KTX2_UASTC,
    KTX2_ETC1S
} Ktx2Coding;

/* The supercompression of a file: BasisLZ is of ETC1S alone. */
typedef enum Ktx2Scheme { KTX2_NONE, KTX2_BASISLZ, KTX2_ZSTANDARD, KTX2_ZLIB, KTX2_SCHEMES } Ktx2Scheme;

/* Numbers of the data format descriptor: colour models of blocks, transfer functions, a flag. */
enum {
    KTX2_MODEL_ETC1S = 163,
    KTX2_MODEL_UASTC = 166,
    KTX2_TRANSFER_LINEAR = 1,
    KTX2_TRANSFER_SRGB = 2,
    KTX2_PREMULTIPLIED = 1
};

/* A channel of a picture is read from a channel that is decoded, or from nothing. */
enum { KTX2_NOTHING = -1 };

typedef struct Ktx2 {
    const ImageSource *source;
    uint32_t width, height, depth;  /* of level 0; depth is 1 where the file has 0 */
    uint32_t layers, faces, levels; /* at least 1 */
    uint32_t scheme;                /* supercompression, a Ktx2Scheme */
    Ktx2Coding coding;
    int stored;       /* channels that are decoded: 4 of blocks */
    int channels;     /* of a picture */
    int from[4];      /* of each channel of a picture: one that is decoded, or KTX2_NOTHING */
    bool linear;      /* integers are linear light, not sRGB */
    bool from_bottom; /* the first row is the lowest */
    bool from_right;  /* the first texel of a row is the last */
} Ktx2;

/* A run of bytes: of the file, or owned. */
typedef struct Ktx2Bytes {
    const unsigned char *data;
    size_t size;
    unsigned char *owned; /* release with free; may be NULL */
} Ktx2Bytes;

/* Returns true if the bytes begin as a KTX 2 file does. */
bool ktx2_starts(const unsigned char *data, size_t size);

/* Reads the header; source must outlive out. Warns of what is not applied, such as a swizzle. Fails with
 * WEFT_MESSAGE_IMAGE_DAMAGED, _IMAGE_SIZE or _IMAGE_UNSUPPORTED. */
WeftResult ktx2_open(const ImageSource *source, Ktx2 *out, WeftError *error);

/* Reads one face of a level, of the first layer and slice: U8, U16 or F32, 1, 3 or 4 channels; two stored channels get
 * a third of 0, since two would mean grey and alpha. Fails as ktx2_open does, or with WEFT_MESSAGE_MEMORY. */
WeftResult ktx2_picture(const Ktx2 *file, int level, int face, WeftImage *out, WeftError *error);

/* Returns the side of a level, where side is that of level 0. */
static inline uint32_t ktx2_side(uint32_t side, int level) { return side >> level ? side >> level : 1; }

/* Takes `size` bytes of a level after the first `skip`, unpacked. */
WeftResult ktx2_level_bytes(const Ktx2 *file, int level, size_t skip, size_t size, Ktx2Bytes *out, WeftError *error);

/* Writes 4 x 4 texels into a picture of bytes; those beyond its sides are dropped. */
void ktx2_block_put(const Ktx2 *file, uint8_t texels[16][4], uint32_t column, uint32_t row, WeftImage *out);

/* Decodes pictures of ETC1S blocks packed by BasisLZ. */
WeftResult ktx2_etc1s_picture(const Ktx2 *file, int level, int face, WeftImage *out, WeftError *error);
