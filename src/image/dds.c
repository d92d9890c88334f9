/* dds.c - the first picture of a DirectDraw surface, of formats that are numbers and not blocks
 *
 * Microsoft, "DDS_HEADER structure", "DDS_HEADER_DXT10 structure", "DXGI_FORMAT enumeration" and "Programming Guide for
 * DDS", Windows documentation, 2022. */
#include <stdbool.h>
#include <string.h>

#include "base/fail.h"
#include "base/little_endian.h"
#include "image/codec.h"
#include "image/half.h"
#include "image/pixel.h"

enum {
    HEADER = 128,
    MORE = 20, /* bytes of the second header, where there is one */
    HAS_FOURCC = 0x4,
    HAS_RGB = 0x40,
    HAS_LUMINANCE = 0x20000,
    IS_CUBE = 0x200,
    IS_VOLUME = 0x200000
};

/* The type of the numbers of a texel. */
typedef enum DdsKind { DDS_BYTE, DDS_WORD, DDS_HALF, DDS_SINGLE } DdsKind;

typedef struct DdsFormat {
    uint32_t dxgi, code; /* numbers in the second header, and in place of a FourCC in the first; 0: none */
    int channels;
    DdsKind kind;
    bool reversed; /* blue comes first */
} DdsFormat;

static const DdsFormat dds_formats[] = {
    {2, 116, 4, DDS_SINGLE, false},  {6, 0, 3, DDS_SINGLE, false},  {16, 115, 2, DDS_SINGLE, false},
    {41, 114, 1, DDS_SINGLE, false}, {10, 113, 4, DDS_HALF, false}, {34, 112, 2, DDS_HALF, false},
    {54, 111, 1, DDS_HALF, false},   {11, 36, 4, DDS_WORD, false},  {35, 0, 2, DDS_WORD, false},
    {56, 0, 1, DDS_WORD, false},     {28, 0, 4, DDS_BYTE, false},   {29, 0, 4, DDS_BYTE, false},
    {49, 0, 2, DDS_BYTE, false},     {61, 0, 1, DDS_BYTE, false},   {87, 0, 4, DDS_BYTE, true},
    {91, 0, 4, DDS_BYTE, true},
};

/* Formats of the first header that are bits and masks of red, green and alpha. */
static const struct {
    uint32_t flag, bits, red, green, alpha;
    DdsFormat format;
} dds_masks[] = {
    {HAS_RGB, 32, 0x000000ff, 0x0000ff00, 0xff000000, {0, 0, 4, DDS_BYTE, false}},
    {HAS_RGB, 32, 0x00ff0000, 0x0000ff00, 0xff000000, {0, 0, 4, DDS_BYTE, true}},
    {HAS_RGB, 24, 0x00ff0000, 0x0000ff00, 0, {0, 0, 3, DDS_BYTE, true}},
    {HAS_RGB, 32, 0x0000ffff, 0xffff0000, 0, {0, 0, 2, DDS_WORD, false}},
    {HAS_LUMINANCE, 8, 0x000000ff, 0, 0, {0, 0, 1, DDS_BYTE, false}},
    {HAS_LUMINANCE, 16, 0x0000ffff, 0, 0, {0, 0, 1, DDS_WORD, false}},
    {HAS_LUMINANCE, 16, 0x000000ff, 0, 0x0000ff00, {0, 0, 2, DDS_BYTE, false}},
};

/* Returns word k of the headers. */
static uint32_t header_word(const ImageSource *source, int k) {
    return (uint32_t)little_endian(source->data + 4 * k, 4);
}

static bool has_second_header(const ImageSource *source) {
    return header_word(source, 20) & HAS_FOURCC && memcmp(source->data + 84, "DX10", 4) == 0;
}

/* Returns the format of the pixels, or NULL. */
static const DdsFormat *format_of(const ImageSource *source) {
    const uint32_t flags = header_word(source, 20), code = header_word(source, 21);
    const bool second = has_second_header(source);
    const uint32_t dxgi = second ? header_word(source, 32) : 0;
    for (size_t k = 0; k < sizeof dds_formats / sizeof *dds_formats && flags & HAS_FOURCC; k++)
        if (second ? dds_formats[k].dxgi == dxgi : code && dds_formats[k].code == code) return &dds_formats[k];
    for (size_t k = 0; k < sizeof dds_masks / sizeof *dds_masks && !(flags & HAS_FOURCC); k++)
        if (flags & dds_masks[k].flag && header_word(source, 22) == dds_masks[k].bits &&
            header_word(source, 23) == dds_masks[k].red && header_word(source, 24) == dds_masks[k].green &&
            header_word(source, 26) == dds_masks[k].alpha)
            return &dds_masks[k].format;
    return NULL;
}

/* Refuses pixels of a format that is not here, by name. */
static WeftResult format_refuse(const ImageSource *source, WeftError *error) {
    const unsigned char *code = source->data + 84;
    const char *advice = "convert it to .exr or .png, or to a format of plain numbers such as R16G16B16A16_FLOAT";
    if (has_second_header(source))
        return fail(error, WEFT_MESSAGE_IMAGE_UNSUPPORTED, source->name, "DDS: pixels of DXGI format %u; %s",
                    (unsigned)header_word(source, 32), advice);
    if (header_word(source, 20) & HAS_FOURCC && code[0] >= 'A')
        return fail(error, WEFT_MESSAGE_IMAGE_UNSUPPORTED, source->name, "DDS: pixels of format %.4s; %s",
                    (const char *)code, advice);
    return fail(error, WEFT_MESSAGE_IMAGE_UNSUPPORTED, source->name, "DDS: pixels of %u bits; %s",
                (unsigned)header_word(source, 22), advice);
}

/* Converts one number of the file. */
static void number_put(const unsigned char *at, DdsKind kind, size_t to, WeftImage *out) {
    switch (kind) {
    case DDS_BYTE: ((uint8_t *)out->pixels)[to] = at[0]; break;
    case DDS_WORD: ((uint16_t *)out->pixels)[to] = (uint16_t)little_endian(at, 2); break;
    case DDS_HALF: ((float *)out->pixels)[to] = half_value((unsigned)little_endian(at, 2)); break;
    case DDS_SINGLE: ((float *)out->pixels)[to] = little_endian_float(at); break;
    }
}

/* Returns the channels of the picture: red and green get a blue of 0, since two channels are grey and alpha, which only
 * bytes of the first header are. */
static int channels_of(const DdsFormat *format) {
    const bool has_alpha = format->kind == DDS_BYTE && !format->dxgi;
    return format->channels == 2 && !has_alpha ? 3 : format->channels;
}

static void pixels_put(const unsigned char *at, const DdsFormat *format, WeftImage *out) {
    static const size_t bytes[] = {1, 2, 2, 4};
    const size_t channels = (size_t)format->channels, count = (size_t)out->width * (size_t)out->height;
    for (size_t n = 0; n < count; n++)
        for (size_t c = 0; c < channels; c++, at += bytes[format->kind])
            number_put(at, format->kind, n * (size_t)out->channels + (format->reversed && c < 3 ? 2 - c : c), out);
}

/* Says that there are more pictures than the one that is read. */
static void rest_say(const ImageSource *source) {
    const bool second = has_second_header(source);
    const char *kind = header_word(source, 28) & IS_CUBE       ? "the first face of its cube"
                       : header_word(source, 28) & IS_VOLUME   ? "the first slice of its volume"
                       : second && header_word(source, 35) > 1 ? "the first picture of its array"
                                                               : NULL;
    if (kind) warn(source->log, WEFT_MESSAGE_IMAGE_REPAIRED, source->name, "DDS: it shows %s", kind);
}

WeftResult image_read_dds(const ImageSource *source, WeftImage *out, WeftError *error) {
    static const WeftPixelType types[] = {WEFT_PIXEL_U8, WEFT_PIXEL_U16, WEFT_PIXEL_F32, WEFT_PIXEL_F32};
    static const int64_t bytes[] = {1, 2, 2, 4};
    if (source->size < HEADER || header_word(source, 1) != HEADER - 4)
        return fail(error, WEFT_MESSAGE_IMAGE_DAMAGED, source->name, "DDS: its header is cut or of another size");
    const size_t start = HEADER + (has_second_header(source) ? MORE : 0);
    if (source->size < start) return fail(error, WEFT_MESSAGE_IMAGE_DAMAGED, source->name, "DDS: it ends early");
    const DdsFormat *format = format_of(source);
    if (!format) return format_refuse(source, error);
    const int64_t width = header_word(source, 4), height = header_word(source, 3);
    WeftResult result = image_check_header(source, width, height, 4 * (int64_t)format->channels, error);
    if (result == WEFT_OK)
        result =
            image_reachable(source, (int64_t)start + width * height * format->channels * bytes[format->kind], error);
    if (result == WEFT_OK)
        result = weft_image_create((int)width, (int)height, channels_of(format), types[format->kind], out, error);
    if (result != WEFT_OK) return result;
    pixels_put(source->data + start, format, out);
    if (out->type == WEFT_PIXEL_F32) image_repair(source, out);
    rest_say(source);
    return WEFT_OK;
}
