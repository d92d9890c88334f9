#include "image/ktx2/ktx2.h"

#include <stdlib.h>
#include <string.h>

#include "base/fail.h"
#include "base/little_endian.h"

enum {
    HEADER = 80,
    LEVEL = 24, /* bytes of an entry of the level index */
    LEVELS_MOST = 17
};

static const unsigned char signature[12] = {0xab, 'K', 'T', 'X', ' ', '2', '0', 0xbb, '\r', '\n', 0x1a, '\n'};

/* The formats of Vulkan that are numbers and not blocks. */
static const struct {
    uint32_t vulkan;
    int channels;
    Ktx2Coding coding;
    bool reversed, linear; /* reversed: blue comes first */
} formats[] = {
    {9, 1, KTX2_BYTES, false, true},       {15, 1, KTX2_BYTES, false, false},    {16, 2, KTX2_BYTES, false, true},
    {22, 2, KTX2_BYTES, false, false},     {23, 3, KTX2_BYTES, false, true},     {29, 3, KTX2_BYTES, false, false},
    {30, 3, KTX2_BYTES, true, true},       {36, 3, KTX2_BYTES, true, false},     {37, 4, KTX2_BYTES, false, true},
    {43, 4, KTX2_BYTES, false, false},     {44, 4, KTX2_BYTES, true, true},      {50, 4, KTX2_BYTES, true, false},
    {70, 1, KTX2_WORDS, false, true},      {77, 2, KTX2_WORDS, false, true},     {84, 3, KTX2_WORDS, false, true},
    {91, 4, KTX2_WORDS, false, true},      {76, 1, KTX2_HALVES, false, true},    {83, 2, KTX2_HALVES, false, true},
    {90, 3, KTX2_HALVES, false, true},     {97, 4, KTX2_HALVES, false, true},    {100, 1, KTX2_SINGLES, false, true},
    {103, 2, KTX2_SINGLES, false, true},   {106, 3, KTX2_SINGLES, false, true},  {109, 4, KTX2_SINGLES, false, true},
    {122, 3, KTX2_B10G11R11, false, true}, {123, 3, KTX2_E5B9G9R9, false, true},
};

/* Tells what the channels of blocks stand for: the numbers of the first sample in the descriptor and of the second, 0 where
 * there is none, and where the channels of a picture are. */
static const struct {
    int model, first, second, channels, from[4];
} contents[] = {
    {KTX2_MODEL_UASTC, 0, 0, 3, {0, 1, 2}},
    {KTX2_MODEL_UASTC, 3, 0, 4, {0, 1, 2, 3}},
    {KTX2_MODEL_UASTC, 4, 0, 1, {0}},
    {KTX2_MODEL_UASTC, 5, 0, 3, {0, 3, KTX2_NOTHING}},
    {KTX2_MODEL_UASTC, 6, 0, 3, {0, 1, KTX2_NOTHING}},
    {KTX2_MODEL_ETC1S, 0, 0, 3, {0, 1, 2}},
    {KTX2_MODEL_ETC1S, 0, 15, 4, {0, 1, 2, 3}},
    {KTX2_MODEL_ETC1S, 3, 0, 1, {0}},
    {KTX2_MODEL_ETC1S, 3, 4, 3, {0, 3, KTX2_NOTHING}},
};

static uint32_t word_at(const ImageSource *source, size_t at) { return (uint32_t)little_endian(source->data + at, 4); }

bool ktx2_starts(const unsigned char *data, size_t size) {
    return size >= sizeof signature && memcmp(data, signature, sizeof signature) == 0;
}

static WeftResult damaged(const ImageSource *source, const char *what, WeftError *error) {
    return fail(error, WEFT_MESSAGE_IMAGE_DAMAGED, source->name, "KTX 2: %s", what);
}

static WeftResult format_find(Ktx2 *file, uint32_t vulkan, WeftError *error) {
    for (size_t k = 0; k < sizeof formats / sizeof *formats; k++) {
        if (formats[k].vulkan != vulkan) continue;
        const int stored = formats[k].channels;
        file->coding = formats[k].coding;
        file->linear = formats[k].linear;
        file->stored = stored;
        file->channels = stored == 2 ? 3 : stored;
        for (int c = 0; c < 4; c++)
            file->from[c] = c >= stored ? KTX2_NOTHING : formats[k].reversed && c < 3 ? 2 - c : c;
        return WEFT_OK;
    }
    const char *kind = vulkan >= 131 && vulkan <= 146   ? " (BC)"
                       : vulkan >= 147 && vulkan <= 156 ? " (ETC2)"
                       : vulkan >= 157 && vulkan <= 184 ? " (ASTC)"
                                                        : "";
    return fail(error, WEFT_MESSAGE_IMAGE_UNSUPPORTED, file->source->name,
                "KTX 2: pixels of VkFormat %u%s; convert it to UASTC, or to .png or .exr", (unsigned)vulkan, kind);
}

/* Finds what blocks without a format of Vulkan are by the basic block of the descriptor, of size bytes. */
static WeftResult blocks_find(Ktx2 *file, const unsigned char *basic, size_t size, WeftError *error) {
    enum { BASIC = 24, SAMPLE = 16 };
    if (size < BASIC + SAMPLE) return damaged(file->source, "its data format descriptor is cut", error);
    const int model = basic[8], first = basic[BASIC + 3] & 15;
    const int second = size >= BASIC + 2 * SAMPLE ? basic[BASIC + SAMPLE + 3] & 15 : 0;
    if (model != KTX2_MODEL_ETC1S && model != KTX2_MODEL_UASTC)
        return fail(error, WEFT_MESSAGE_IMAGE_UNSUPPORTED, file->source->name,
                    "KTX 2: blocks of colour model %d, neither ETC1S nor UASTC LDR; convert it to one of these", model);
    if ((model == KTX2_MODEL_ETC1S) != (file->scheme == KTX2_BASISLZ))
        return damaged(file->source, "ETC1S without BasisLZ, or BasisLZ without ETC1S", error);
    for (size_t k = 0; k < sizeof contents / sizeof *contents; k++) {
        if (contents[k].model != model || contents[k].first != first || contents[k].second != second) continue;
        file->coding = model == KTX2_MODEL_ETC1S ? KTX2_ETC1S : KTX2_UASTC;
        file->linear = basic[10] == KTX2_TRANSFER_LINEAR;
        file->stored = 4;
        file->channels = contents[k].channels;
        memcpy(file->from, contents[k].from, sizeof file->from);
        return WEFT_OK;
    }
    return fail(error, WEFT_MESSAGE_IMAGE_UNSUPPORTED, file->source->name,
                "KTX 2: blocks whose channels are %d and %d of colour model %d", first, second, model);
}

static WeftResult descriptor_read(Ktx2 *file, WeftError *error) {
    const ImageSource *source = file->source;
    const uint64_t at = word_at(source, 48), size = word_at(source, 52);
    const uint32_t vulkan = word_at(source, 12);
    if (at + size > source->size) return damaged(source, "its data format descriptor lies behind its end", error);
    const bool whole = size >= 4 + 12;
    if (whole && source->data[at + 4 + 11] & KTX2_PREMULTIPLIED)
        warn(source->log, WEFT_MESSAGE_IMAGE_REPAIRED, source->name,
             "KTX 2: its colours are multiplied by alpha, and read as they are");
    if (vulkan) return format_find(file, vulkan, error);
    return blocks_find(file, source->data + at + 4, size < 4 ? 0 : (size_t)size - 4, error);
}

/* Takes the orientation and warns of a swizzle that changes something. */
static void key_read(Ktx2 *file, const char *key, const char *value, size_t size) {
    if (strcmp(key, "KTXorientation") == 0) {
        file->from_right = size > 0 && value[0] == 'l';
        file->from_bottom = size > 1 && value[1] == 'u';
    }
    if (strcmp(key, "KTXswizzle") == 0 && !(size >= 4 && memcmp(value, "rgba", 4) == 0) &&
        !(file->channels == 1 && size >= 4 && memcmp(value, "rrr1", 4) == 0))
        warn(file->source->log, WEFT_MESSAGE_IMAGE_REPAIRED, file->source->name,
             "KTX 2: its swizzle is not applied; channels are read as they lie");
}

static WeftResult keys_read(Ktx2 *file, WeftError *error) {
    const ImageSource *source = file->source;
    uint64_t at = word_at(source, 56);
    const uint64_t end = at + word_at(source, 60);
    if (end > source->size) return damaged(source, "its keys lie behind its end", error);
    while (at + 4 <= end) {
        const uint64_t size = word_at(source, (size_t)at);
        const char *key = (const char *)source->data + at + 4;
        if (size > end - at - 4) return damaged(source, "a key is longer than all keys", error);
        const char *zero = memchr(key, 0, (size_t)size);
        if (!zero) return damaged(source, "a key has no end", error);
        key_read(file, key, zero + 1, (size_t)(key + size - zero - 1));
        at += 4 + (size + 3) / 4 * 4;
    }
    return WEFT_OK;
}

/* Says that there are more pictures than the first one that is read. */
static void rest_say(const Ktx2 *file) {
    const char *kind = file->depth > 1 ? "slice of its volume" : file->layers > 1 ? "picture of its array" : NULL;
    if (kind)
        warn(file->source->log, WEFT_MESSAGE_IMAGE_REPAIRED, file->source->name, "KTX 2: it shows the first %s", kind);
}

static WeftResult shape_read(Ktx2 *file, WeftError *error) {
    const ImageSource *source = file->source;
    const uint32_t layers = word_at(source, 32), depth = word_at(source, 28), levels = word_at(source, 40);
    file->width = word_at(source, 20);
    file->height = word_at(source, 24);
    file->depth = depth ? depth : 1;
    file->layers = layers ? layers : 1;
    file->faces = word_at(source, 36);
    file->levels = levels ? levels : 1;
    file->scheme = word_at(source, 44);
    if (!file->height) return fail(error, WEFT_MESSAGE_IMAGE_UNSUPPORTED, source->name, "KTX 2: it has one dimension");
    if (file->faces != 1 && (file->faces != 6 || file->width != file->height))
        return damaged(source, "its faces are neither one nor six that are square", error);
    if (file->faces == 6 && file->depth > 1) return damaged(source, "its cube has slices", error);
    if (file->levels > LEVELS_MOST || source->size < HEADER + (size_t)file->levels * LEVEL)
        return damaged(source, "its level index is cut", error);
    if (file->layers > IMAGE_SIDE_MAX || file->depth > IMAGE_SIDE_MAX)
        return damaged(source, "it has more layers or slices than there are", error);
    if (file->scheme >= KTX2_SCHEMES)
        return fail(error, WEFT_MESSAGE_IMAGE_UNSUPPORTED, source->name,
                    "KTX 2: supercompression %u; repack it with Zstandard or without", (unsigned)file->scheme);
    return WEFT_OK;
}

/* Refuses a picture that so few bytes cannot hold. Zstandard repeats a byte 131072 times in 4, Deflate 258 times in 2 bits;
 * what BasisLZ packs best is counted as 65536 texels a byte, so that a small file cannot ask for much. */
static WeftResult size_check(const Ktx2 *file, WeftError *error) {
    static const int64_t bytes[] = {1, 2, 4, 4, 4, 4, 1, 1}, fewest[] = {1, 2, 2, 4, 4, 4, 1, 1};
    WeftResult result = image_check_header(file->source, file->width, file->height,
                                           bytes[file->coding] * file->channels * file->faces, error);
    if (result != WEFT_OK) return result;
    const int64_t texels = (int64_t)file->width * file->height;
    const bool packed = file->coding >= KTX2_B10G11R11;
    int64_t least = texels * (packed ? 1 : file->stored) * fewest[file->coding];
    if (file->coding == KTX2_UASTC) least = (int64_t)((file->width + 3) / 4) * ((file->height + 3) / 4) * 16;
    least *= file->faces;
    if (file->scheme == KTX2_ZSTANDARD) least /= 32768;
    if (file->scheme == KTX2_ZLIB) least /= 1032;
    if (file->scheme == KTX2_BASISLZ) least = texels / 65536;
    return image_reachable(file->source, HEADER + LEVEL * (int64_t)file->levels + least, error);
}

WeftResult ktx2_open(const ImageSource *source, Ktx2 *out, WeftError *error) {
    *out = (Ktx2){.source = source};
    if (source->size < HEADER + LEVEL || !ktx2_starts(source->data, source->size))
        return damaged(source, "its header is cut", error);
    WeftResult result = shape_read(out, error);
    if (result == WEFT_OK) result = descriptor_read(out, error);
    if (result == WEFT_OK && (out->scheme == KTX2_BASISLZ) != (out->coding == KTX2_ETC1S))
        result = damaged(source, "BasisLZ without ETC1S", error);
    if (result == WEFT_OK) result = size_check(out, error);
    if (result == WEFT_OK) result = keys_read(out, error);
    if (result == WEFT_OK) rest_say(out);
    return result;
}

WeftResult image_read_ktx2(const ImageSource *source, WeftImage *out, WeftError *error) {
    Ktx2 file;
    WeftResult result = ktx2_open(source, &file, error);
    if (result != WEFT_OK) return result;
    if (file.faces == 6)
        warn(source->log, WEFT_MESSAGE_IMAGE_REPAIRED, source->name, "KTX 2: it shows the first face of its cube");
    return ktx2_picture(&file, 0, 0, out, error);
}
