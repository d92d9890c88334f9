/* etc1s.c - pictures of ETC1S blocks, which BasisLZ packs: two code books for all pictures of a file, and for each
 * picture a slice of references to them
 *
 * Khronos, "KTX File Format Specification", version 2.0.4, 2024, annexes "BasisLZ Global Data" and "BasisLZ/ETC1S
 * Bitstream Specification"; "Khronos Data Format Specification", version 1.3.1, 2020, section 21.1, for the colours of
 * a block. */
#include <stdlib.h>
#include <string.h>

#include "base/fail.h"
#include "base/little_endian.h"
#include "base/memory.h"
#include "image/ktx2/huffman.h"
#include "image/ktx2/ktx2.h"

enum {
    GLOBAL = 20,      /* bytes of the header of the global data */
    IMAGE = 20,       /* of the description of a picture */
    REPEAT = 256,     /* the symbol of predictors that repeats the last one */
    REPEAT_LEAST = 3, /* and how often it does at least */
    RUN_LEAST = 3,
    RUN_LONG = 63, /* a run whose length follows by itself */
    RECENT_MOST = 64,
    P_FRAME = 2
};

/* A base colour of 5 bits a channel, and the number of its row of intensities. */
typedef struct Endpoint {
    uint8_t color[3], intensity;
} Endpoint;

/* Both code books, and the tables by which slices refer to them. */
typedef struct Codebooks {
    int endpoint_count, selector_count;
    Endpoint *endpoints;
    uint8_t (*selectors)[4]; /* a row of four in each byte, the left one lowest */
    int recent_count;        /* selectors that are remembered */
    Huffman predictors, deltas, selections, runs;
} Codebooks;

/* A slice while it is read. */
typedef struct Slice {
    Bits bits;
    const Codebooks *books;
    uint16_t *above, *row;     /* numbers of endpoints of the blocks above, and of this row */
    uint8_t *below;            /* predictors of the row that follows, of two blocks in a byte */
    unsigned predictors, last; /* of the blocks at hand, 2 bits each; the last symbol */
    uint32_t repeats;          /* of the last symbol that are left */
    uint32_t run;              /* blocks that take the latest selector */
    int endpoint;              /* of the block before */
    uint16_t recent[RECENT_MOST];
    int rover; /* where the next selector is remembered */
} Slice;

/* Reads a number in chunks of so many bits, each of which says whether one follows. */
static uint32_t chunks_take(Bits *bits, int size) {
    uint64_t value = 0;
    for (int shift = 0; shift < 32; shift += size) {
        const uint32_t chunk = bits_take(bits, size + 1);
        value |= (uint64_t)(chunk & ((1u << size) - 1u)) << shift;
        if (!(chunk >> size)) break;
    }
    return (uint32_t)value;
}

static bool endpoints_read(Bits bits, Codebooks *books, Huffman colors[3], Huffman *intensities) {
    Endpoint last = {{16, 16, 16}, 0};
    for (int k = 0; k < 3; k++)
        if (!huffman_read(&bits, &colors[k])) return false;
    if (!huffman_read(&bits, intensities)) return false;
    const bool grey = bits_take(&bits, 1);
    for (int k = 0; k < books->endpoint_count; k++) {
        const int step = huffman_take(&bits, intensities);
        if (step == HUFFMAN_NONE) return false;
        last.intensity = (uint8_t)((last.intensity + step) & 7);
        for (int c = 0; c < (grey ? 1 : 3); c++) {
            const int delta = huffman_take(&bits, &colors[last.color[c] < 10 ? 0 : last.color[c] < 22 ? 1 : 2]);
            if (delta == HUFFMAN_NONE) return false;
            last.color[c] = (uint8_t)((last.color[c] + delta) & 31);
        }
        if (grey) last.color[1] = last.color[2] = last.color[0];
        books->endpoints[k] = last;
    }
    return !bits_overrun(&bits);
}

static bool selectors_read(Bits bits, Codebooks *books, Huffman *steps) {
    if (bits_take(&bits, 2)) return false;
    const bool plain = bits_take(&bits, 1);
    if (!plain && !huffman_read(&bits, steps)) return false;
    for (int k = 0; k < books->selector_count; k++)
        for (int j = 0; j < 4; j++) {
            const int step = plain || !k ? (int)bits_take(&bits, 8) : huffman_take(&bits, steps);
            if (step == HUFFMAN_NONE) return false;
            books->selectors[k][j] = (uint8_t)(plain || !k ? step : step ^ books->selectors[k - 1][j]);
        }
    return !bits_overrun(&bits);
}

static bool tables_read(Bits bits, Codebooks *books) {
    if (!huffman_read(&bits, &books->predictors) || !huffman_read(&bits, &books->deltas) ||
        !huffman_read(&bits, &books->selections) || !huffman_read(&bits, &books->runs))
        return false;
    books->recent_count = (int)bits_take(&bits, 13);
    return books->recent_count <= RECENT_MOST && !bits_overrun(&bits);
}

static void books_free(Codebooks *books) {
    if (!books) return;
    free(books->endpoints);
    free(books->selectors);
    free(books);
}

/* Returns the part of the global data that begins at *at, and moves *at behind it. */
static Bits part_of(const unsigned char *data, uint64_t *at, uint64_t size) {
    const Bits part = {.data = data + *at, .size = (size_t)size, .at = 0};
    *at += size;
    return part;
}

/* Reads the code books from the global data, of size bytes. */
static WeftResult books_read(const Ktx2 *file, const unsigned char *data, uint64_t size, uint64_t images,
                             Codebooks **out, WeftError *error) {
    const char *name = file->source->name;
    const uint64_t endpoints = little_endian(data + 4, 4), selectors = little_endian(data + 8, 4),
                   tables = little_endian(data + 12, 4);
    uint64_t at = GLOBAL + IMAGE * images;
    if (at + endpoints + selectors + tables > size)
        return fail(error, WEFT_MESSAGE_IMAGE_DAMAGED, name,
                    "KTX 2: the parts of its BasisLZ data are longer than these");
    Codebooks *books = alloc_array(1, sizeof *books);
    Huffman *work = alloc_array(4, sizeof *work);
    if (books) {
        books->endpoint_count = (int)little_endian(data, 2);
        books->selector_count = (int)little_endian(data + 2, 2);
        books->endpoints = alloc_array((size_t)books->endpoint_count, sizeof(Endpoint));
        books->selectors = alloc_array((size_t)books->selector_count, sizeof *books->selectors);
    }
    WeftResult result = WEFT_OK;
    if (!books || !work || !books->endpoints || !books->selectors)
        result = fail(error, WEFT_MESSAGE_MEMORY, name, NULL);
    else if (!endpoints_read(part_of(data, &at, endpoints), books, work, &work[3]) ||
             !selectors_read(part_of(data, &at, selectors), books, work) ||
             !tables_read(part_of(data, &at, tables), books))
        result = fail(error, WEFT_MESSAGE_IMAGE_DAMAGED, name, "KTX 2: its BasisLZ code books do not decode");
    free(work);
    *out = books;
    if (result == WEFT_OK) return WEFT_OK;
    books_free(books);
    *out = NULL;
    return result;
}

/* Takes the predictors of 2 x 2 blocks, of which a row of two is used at once and the other kept. */
static bool predictors_take(Slice *slice, uint32_t x, uint32_t y) {
    if (y & 1) {
        slice->predictors = slice->below[x / 2];
        return true;
    }
    if (slice->repeats) {
        slice->repeats--;
    } else {
        const int symbol = huffman_take(&slice->bits, &slice->books->predictors);
        if (symbol == HUFFMAN_NONE || symbol > REPEAT) return false;
        if (symbol == REPEAT)
            slice->repeats = chunks_take(&slice->bits, 4) + REPEAT_LEAST - 1;
        else
            slice->last = (unsigned)symbol;
    }
    slice->predictors = slice->last;
    slice->below[x / 2] = (uint8_t)(slice->last >> 4);
    return true;
}

/* Takes the number of a block's endpoint: that of the block before, above or above and before, or one by its distance
 * from the last. Returns false where there is no such block or endpoint. */
static bool endpoint_take(Slice *slice, uint32_t x, uint32_t y) {
    const unsigned predictor = slice->predictors & 3;
    slice->predictors >>= 2;
    if (predictor == 0 && !x) return false;
    if (predictor == 1) {
        if (!y) return false;
        slice->endpoint = slice->above[x];
    } else if (predictor == 2) {
        if (!x || !y) return false;
        slice->endpoint = slice->above[x - 1];
    } else if (predictor == 3) {
        const int delta = huffman_take(&slice->bits, &slice->books->deltas), count = slice->books->endpoint_count;
        if (delta == HUFFMAN_NONE) return false;
        slice->endpoint += delta;
        if (slice->endpoint >= count) slice->endpoint -= count;
    }
    slice->row[x] = (uint16_t)slice->endpoint;
    return slice->endpoint < slice->books->endpoint_count;
}

/* Returns a remembered selector; one that is used moves half the way to the front. */
static int selector_recall(Slice *slice, int place) {
    const uint16_t selector = slice->recent[place];
    slice->recent[place] = slice->recent[place / 2];
    slice->recent[place / 2] = selector;
    return selector;
}

/* Returns the number of a block's selector: one of the code book, or one of the remembered; -1 after a failure. */
static int selector_take(Slice *slice) {
    const Codebooks *books = slice->books;
    int symbol = books->selector_count;
    if (slice->run) {
        slice->run--;
    } else {
        symbol = huffman_take(&slice->bits, &books->selections);
        if (symbol == books->selector_count + books->recent_count) {
            const int run = huffman_take(&slice->bits, &books->runs);
            if (run == HUFFMAN_NONE) return -1;
            slice->run = (run == RUN_LONG ? chunks_take(&slice->bits, 7) : (uint32_t)run) + RUN_LEAST - 1;
            symbol = books->selector_count;
        }
    }
    if (symbol == HUFFMAN_NONE || symbol >= books->selector_count + books->recent_count) return -1;
    if (symbol >= books->selector_count) return selector_recall(slice, symbol - books->selector_count);
    if (books->recent_count) {
        slice->recent[slice->rover++] = (uint16_t)symbol;
        if (slice->rover == books->recent_count) slice->rover = books->recent_count / 2;
    }
    return symbol;
}

/* Fills the colours of a block; alpha becomes the green of a slice of its own. */
static void block_fill(const Endpoint *endpoint, const uint8_t selector[4], bool alpha, uint8_t texels[16][4]) {
    static const int steps[8][2] = {{2, 8}, {5, 17}, {9, 29}, {13, 42}, {18, 60}, {24, 80}, {33, 106}, {47, 183}};
    const int *step = steps[endpoint->intensity];
    const int shifts[4] = {-step[1], -step[0], step[0], step[1]};
    for (int t = 0; t < 16; t++)
        for (int c = 0; c < 3; c++) {
            const int base = endpoint->color[c] << 3 | endpoint->color[c] >> 2;
            const int value = base + shifts[selector[t / 4] >> 2 * (t % 4) & 3];
            const uint8_t kept = (uint8_t)(value < 0 ? 0 : value > 255 ? 255 : value);
            if (!alpha)
                texels[t][c] = kept;
            else if (c == 1)
                texels[t][3] = kept;
        }
}

/* A slice becomes the references of each block to both code books. */
typedef struct Reference {
    uint16_t endpoint, selector;
} Reference;

static bool slice_read(Slice *slice, uint32_t columns, uint32_t rows, Reference *out) {
    slice->rover = slice->books->recent_count / 2;
    for (uint32_t y = 0; y < rows; y++) {
        for (uint32_t x = 0; x < columns; x++, out++) {
            if (!(x & 1) && !predictors_take(slice, x, y)) return false;
            if (!endpoint_take(slice, x, y)) return false;
            const int selector = selector_take(slice);
            if (selector < 0 || selector >= slice->books->selector_count) return false;
            *out = (Reference){(uint16_t)slice->endpoint, (uint16_t)selector};
        }
        uint16_t *row = slice->above;
        slice->above = slice->row;
        slice->row = row;
        if (bits_overrun(&slice->bits)) return false;
    }
    return true;
}

/* Reads the references of a slice of size bytes. */
static WeftResult slice_decode(const Ktx2 *file, const Codebooks *books, const unsigned char *data, size_t size,
                               uint32_t columns, uint32_t rows, Reference *out, WeftError *error) {
    uint16_t *lines = alloc_array(2 * (size_t)columns, sizeof(uint16_t));
    uint8_t *below = alloc_array((size_t)columns / 2 + 1, 1);
    Slice slice = {.bits = {.data = data, .size = size, .at = 0},
                   .books = books,
                   .above = lines,
                   .row = lines ? lines + columns : NULL,
                   .below = below};
    WeftResult result = WEFT_OK;
    if (!lines || !below)
        result = fail(error, WEFT_MESSAGE_MEMORY, file->source->name, NULL);
    else if (!slice_read(&slice, columns, rows, out))
        result = fail(error, WEFT_MESSAGE_IMAGE_DAMAGED, file->source->name, "KTX 2: an ETC1S slice does not decode");
    free(lines);
    free(below);
    return result;
}

/* Decodes the colours of a picture, and the alpha where there is one: part 0 and 1 of its description. */
static WeftResult parts_put(const Ktx2 *file, const Codebooks *books, const unsigned char *image,
                            const unsigned char *level, uint64_t level_size, WeftImage *out, WeftError *error) {
    const uint32_t columns = (uint32_t)(out->width + 3) / 4, rows = (uint32_t)(out->height + 3) / 4;
    const size_t count = (size_t)columns * rows;
    Reference *references = alloc_array(2 * count, sizeof(Reference));
    if (!references) return fail(error, WEFT_MESSAGE_MEMORY, file->source->name, NULL);
    WeftResult result = WEFT_OK;
    bool second = false;
    for (int c = 0; c < file->channels; c++) second |= file->from[c] == 3;
    for (int part = 0; part < (second ? 2 : 1) && result == WEFT_OK; part++) {
        const uint64_t at = little_endian(image + 4 + 8 * part, 4), size = little_endian(image + 8 + 8 * part, 4);
        result = at + size > level_size ? fail(error, WEFT_MESSAGE_IMAGE_DAMAGED, file->source->name,
                                               "KTX 2: a slice lies outside its level")
                                        : slice_decode(file, books, level + at, (size_t)size, columns, rows,
                                                       references + (size_t)part * count, error);
    }
    for (size_t k = 0; k < count && result == WEFT_OK; k++) {
        uint8_t texels[16][4];
        for (size_t part = 0; part < (second ? 2 : 1); part++) {
            const Reference *reference = &references[part * count + k];
            block_fill(&books->endpoints[reference->endpoint], books->selectors[reference->selector], part == 1,
                       texels);
        }
        ktx2_block_put(file, texels, (uint32_t)(k % columns), (uint32_t)(k / columns), out);
    }
    free(references);
    return result;
}

WeftResult ktx2_etc1s_picture(const Ktx2 *file, int level, int face, WeftImage *out, WeftError *error) {
    const ImageSource *source = file->source;
    const uint64_t at = little_endian(source->data + 64, 8), size = little_endian(source->data + 72, 8);
    uint64_t before = 0, images = 0;
    for (int k = 0; k < (int)file->levels; k++) {
        if (k == level) before = images + (uint64_t)face * ktx2_side(file->depth, k);
        images += (uint64_t)file->layers * file->faces * ktx2_side(file->depth, k);
    }
    if (at > source->size || size > source->size - at || size < GLOBAL + IMAGE * images)
        return fail(error, WEFT_MESSAGE_IMAGE_DAMAGED, source->name, "KTX 2: its BasisLZ data lie behind its end");
    const unsigned char *global = source->data + at, *image = global + GLOBAL + IMAGE * before;
    const unsigned char *entry = source->data + 80 + 24 * (size_t)level;
    const uint64_t level_at = little_endian(entry, 8), level_size = little_endian(entry + 8, 8);
    if (level_at > source->size || level_size > source->size - level_at)
        return fail(error, WEFT_MESSAGE_IMAGE_SIZE, source->name, "KTX 2: level %d lies behind its end", level);
    if (little_endian(image, 4) & P_FRAME)
        return fail(error, WEFT_MESSAGE_IMAGE_UNSUPPORTED, source->name, "KTX 2: a frame that needs the one before it");
    Codebooks *books = NULL;
    WeftResult result = books_read(file, global, size, images, &books, error);
    if (!books) return result;
    result = parts_put(file, books, image, source->data + level_at, level_size, out, error);
    books_free(books);
    return result;
}
