/* tga.c - TGA: Truevision, "TGA File Format Specification", version 2.0, 1991 */
#include <stdlib.h>

#include "base/fail.h"
#include "image/codec.h"

enum { TGA_HEADER = 18, TGA_MAPPED = 1, TGA_COLOR = 2, TGA_GREY = 3, TGA_RLE = 8 };

typedef struct Tga {
    int kind; /* TGA_MAPPED, TGA_COLOR or TGA_GREY */
    int packed;
    int pixel_bits, color_bits; /* of a pixel in the file, and of the colour it is or names */
    int has_alpha;
    int channels;
    int map_first, map_length;
    int width, height;
    int from_right, from_top;
    const unsigned char *map, *pixels, *end;
} Tga;

static int word(const unsigned char *bytes) { return bytes[0] | bytes[1] << 8; }
static int byte_count(int bits) { return (bits + 7) / 8; }

static int is_color_depth(int bits) { return bits == 15 || bits == 16 || bits == 24 || bits == 32; }

/* Returns 1 if the header is possible. The format has no signature, so a file with another header is no TGA. */
static int tga_possible(const Tga *tga, int map_type, int type) {
    if (map_type > 1 || (type & ~TGA_RLE) != tga->kind) return 0;
    switch (tga->kind) {
    case TGA_MAPPED:
        return map_type == 1 && (tga->pixel_bits == 8 || tga->pixel_bits == 16) && is_color_depth(tga->color_bits);
    case TGA_COLOR: return is_color_depth(tga->pixel_bits);
    case TGA_GREY: return tga->pixel_bits == 8 || tga->pixel_bits == 16;
    default: return 0;
    }
}

static WeftResult tga_header(const ImageSource *source, Tga *tga, WeftError *error) {
    const unsigned char *head = source->data;
    if (source->size < TGA_HEADER) return fail(error, WEFT_MESSAGE_IMAGE_FORMAT, source->name, NULL);
    const int map_type = head[1], type = head[2], attributes = head[17];
    *tga = (Tga){.kind = type & 3,
                 .packed = type & TGA_RLE,
                 .map_first = word(head + 3),
                 .map_length = map_type ? word(head + 5) : 0,
                 .width = word(head + 12),
                 .height = word(head + 14),
                 .pixel_bits = head[16],
                 .from_right = attributes & 0x10,
                 .from_top = attributes & 0x20,
                 .map = head,
                 .pixels = head,
                 .end = head + source->size};
    tga->color_bits = tga->kind == TGA_MAPPED ? head[7] : tga->pixel_bits;
    if (!tga_possible(tga, map_type, type)) return fail(error, WEFT_MESSAGE_IMAGE_FORMAT, source->name, NULL);
    if (attributes & 0xc0) return fail(error, WEFT_MESSAGE_IMAGE_UNSUPPORTED, source->name, "TGA: interleaved lines");
    /* The attribute bits count the alpha bits of a colour; grey of 16 bits has 8 of alpha. */
    tga->has_alpha = tga->kind == TGA_GREY ? tga->color_bits == 16
                                           : (attributes & 15) && (tga->color_bits == 16 || tga->color_bits == 32);
    tga->channels = (tga->kind == TGA_GREY ? 1 : 3) + (tga->has_alpha ? 1 : 0);

    const size_t before = TGA_HEADER + (size_t)head[0];
    const size_t map_size = map_type ? (size_t)tga->map_length * (size_t)byte_count(head[7]) : 0;
    if (source->size < before + map_size)
        return fail(error, WEFT_MESSAGE_IMAGE_DAMAGED, source->name, "TGA: it ends within its header");
    tga->map = head + before;
    tga->pixels = tga->map + map_size;
    return WEFT_OK;
}

static unsigned char widened(int five_bits) { return (unsigned char)((five_bits * 255 + 15) / 31); }

/* Reads the colour at `from`, of color_bits, blue first. */
static void color_unpack(const Tga *tga, const unsigned char *from, unsigned char *to) {
    if (tga->kind == TGA_GREY) {
        to[0] = from[0];
        if (tga->has_alpha) to[1] = from[1];
    } else if (tga->color_bits <= 16) {
        const int bits = word(from);
        to[0] = widened(bits >> 10 & 31);
        to[1] = widened(bits >> 5 & 31);
        to[2] = widened(bits & 31);
        if (tga->has_alpha) to[3] = bits & 0x8000 ? 255 : 0;
    } else {
        to[0] = from[2];
        to[1] = from[1];
        to[2] = from[0];
        if (tga->has_alpha) to[3] = from[3];
    }
}

/* Reads the pixel at `from`; returns 0 if its index is outside the colour map. */
static int pixel_unpack(const Tga *tga, const unsigned char *from, unsigned char *to) {
    if (tga->kind == TGA_MAPPED) {
        const int index = (tga->pixel_bits == 8 ? from[0] : word(from)) - tga->map_first;
        if (index < 0 || index >= tga->map_length) return 0;
        from = tga->map + (size_t)index * (size_t)byte_count(tga->color_bits);
    }
    color_unpack(tga, from, to);
    return 1;
}

/* Returns the place of the n-th pixel of the file. */
static unsigned char *pixel_place(const Tga *tga, const WeftImage *image, size_t n) {
    size_t width = (size_t)tga->width, x = n % width, y = n / width;
    if (tga->from_right) x = width - 1 - x;
    if (!tga->from_top) y = (size_t)tga->height - 1 - y;
    return (unsigned char *)image->pixels + (y * width + x) * (size_t)tga->channels;
}

/* Reads all pixels; a file without packets is read as one packet of all. Returns the fault or NULL. Packets may run
 * over the end of a line: the specification forbids it, but some writers do it. */
static const char *tga_decode(const Tga *tga, const WeftImage *image) {
    const size_t total = (size_t)tga->width * (size_t)tga->height, step = (size_t)byte_count(tga->pixel_bits);
    const unsigned char *at = tga->pixels;
    for (size_t n = 0; n < total;) {
        size_t count = total;
        int run = 0;
        if (tga->packed) {
            if (at == tga->end) return "it ends early";
            run = *at & 0x80;
            count = (size_t)(*at++ & 0x7f) + 1;
            if (count > total - n) return "a packet runs over the end of the image";
        }
        if ((size_t)(tga->end - at) < (run ? step : count * step)) return "it ends early";
        for (size_t i = 0; i < count; i++, n++) {
            if (!pixel_unpack(tga, at, pixel_place(tga, image, n))) return "a pixel names no colour of the map";
            if (!run || i + 1 == count) at += step;
        }
    }
    return NULL;
}

WeftResult image_read_tga(const ImageSource *source, WeftImage *out, WeftError *error) {
    Tga tga = {.map = source->data, .pixels = source->data, .end = source->data};
    WeftResult result = tga_header(source, &tga, error);
    if (result != WEFT_OK) return result;
    /* The longest packet encodes 128 pixels in a byte and one pixel. */
    const int64_t pixels = (int64_t)tga.width * tga.height, step = byte_count(tga.pixel_bits);
    result = image_check_header(source, tga.width, tga.height, tga.channels, error);
    if (result == WEFT_OK)
        result = image_reachable(source, tga.packed ? pixels / 128 * (1 + step) : pixels * step, error);
    if (result == WEFT_OK) result = weft_image_create(tga.width, tga.height, tga.channels, WEFT_PIXEL_U8, out, error);
    if (result != WEFT_OK) return result;
    const char *wrong = tga_decode(&tga, out);
    if (!wrong) return WEFT_OK;
    weft_image_free(out);
    return fail(error, WEFT_MESSAGE_IMAGE_DAMAGED, source->name, "TGA: %s", wrong);
}
