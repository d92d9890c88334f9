#include "weft/image.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/fail.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/path.h"
#include "image/codec.h"
#include "image/pixel.h"
#include "image/srgb.h"

static size_t value_count(const WeftImage *image) {
    return (size_t)image->width * (size_t)image->height * (size_t)image->channels;
}

WeftResult weft_image_create(int width, int height, int channels, WeftPixelType type, WeftImage *out,
                             WeftError *error) {
    *out = (WeftImage){0};
    if (width < 1 || width > IMAGE_SIDE_MAX || height < 1 || height > IMAGE_SIDE_MAX || channels < 1 || channels > 4 ||
        (unsigned)type > WEFT_PIXEL_F32)
        return fail(error, WEFT_MESSAGE_DESC, "image", "%d x %d pixels of %d channels, type %d", width, height,
                    channels, (int)type);
    WeftImage image = {.width = width, .height = height, .channels = channels, .type = type};
    image.pixels = alloc_array(value_count(&image), pixel_type_size(type));
    if (!image.pixels)
        return fail(error, WEFT_MESSAGE_MEMORY, "image", "%d x %d pixels of %d channels", width, height, channels);
    *out = image;
    return WEFT_OK;
}

void weft_image_free(WeftImage *image) {
    if (!image) return;
    free(image->pixels);
    *image = (WeftImage){0};
}

WeftResult image_check_header(const ImageSource *source, int64_t width, int64_t height, int64_t bytes_per_pixel,
                              WeftError *error) {
    const int64_t always = (int64_t)512 << 20, never = (int64_t)2 << 30;
    if (width < 1 || height < 1 || width > IMAGE_SIDE_MAX || height > IMAGE_SIDE_MAX)
        return fail(error, WEFT_MESSAGE_IMAGE_SIZE, source->name, "%lld x %lld; a side is 1 to %d", (long long)width,
                    (long long)height, IMAGE_SIDE_MAX);
    int64_t bytes = width * height * bytes_per_pixel;
    if (bytes > never || (bytes > always && bytes / 16 > (int64_t)source->size))
        return fail(error, WEFT_MESSAGE_IMAGE_SIZE, source->name, "%lld x %lld from %zu bytes", (long long)width,
                    (long long)height, source->size);
    return WEFT_OK;
}

WeftResult image_reachable(const ImageSource *source, int64_t fewest_bytes, WeftError *error) {
    if (fewest_bytes <= (int64_t)source->size) return WEFT_OK;
    return fail(error, WEFT_MESSAGE_IMAGE_SIZE, source->name, "its pixels take at least %lld bytes, the file has %zu",
                (long long)fewest_bytes, source->size);
}

void image_repair(const ImageSource *source, WeftImage *image) {
    float *values = image->pixels;
    size_t bad = 0, count = value_count(image);
    for (size_t i = 0; i < count; i++) {
        if (isfinite(values[i])) continue;
        values[i] = 0.0f;
        bad++;
    }
    if (bad)
        warn(source->log, WEFT_MESSAGE_IMAGE_REPAIRED, source->name, "%zu of %zu values were not finite; 0 now", bad,
             count);
}

/* A file format. Files are recognised by their signature, whatever their suffix; a format without a reader is refused
 * by name. */
typedef struct Format {
    const char *name;
    size_t at, size; /* of the signature, bytes */
    const char *signature;
    WeftResult (*read)(const ImageSource *source, WeftImage *out, WeftError *error);
    const char *media_type; /* of a format of glTF and its extensions, else NULL */
    const char *suffix;     /* NULL: the format is not written */
    bool linear;            /* written from F32; else from U8 or U16 */
    WeftResult (*write)(FILE *stream, const char *name, const WeftImage *image, const WeftImageWriting *how,
                        WeftError *error);
    bool picture; /* a picture that is not read, which other programs convert */
} Format;

#ifdef WEFT_HAS_TIFF
#define READ_TIFF image_read_tiff
#else
#define READ_TIFF NULL
#endif
#define SIGNATURE(at, text) at, sizeof(text) - 1, text
static const Format formats[] = {
    {"PNG", SIGNATURE(0, "\x89PNG"), image_read_png, "image/png", ".png", false, image_write_png, false},
    {"JPEG", SIGNATURE(0, "\xff\xd8\xff"), image_read_jpeg, "image/jpeg", NULL, false, NULL, false},
    {"Radiance HDR", SIGNATURE(0, "#?"), image_read_hdr, NULL, ".hdr", true, image_write_hdr, false},
    {"OpenEXR", SIGNATURE(0, "\x76\x2f\x31\x01"), image_read_exr, NULL, ".exr", true, image_write_exr, false},
    {"NPY", SIGNATURE(0, "\x93NUMPY"), image_read_npy, NULL, ".npy", true, image_write_npy, false},
    {"WebP", SIGNATURE(8, "WEBP"), image_read_webp, "image/webp", NULL, false, NULL, false},
    {"KTX 2", SIGNATURE(0, "\xabKTX 20\xbb"), image_read_ktx2, "image/ktx2", ".ktx2", false, image_write_ktx2, false},
    {"KTX", SIGNATURE(0, "\xabKTX 11\xbb"), NULL, NULL, NULL, false, NULL, true},
    {"DDS", SIGNATURE(0, "DDS "), image_read_dds, NULL, NULL, false, NULL, false},
    {"GIF", SIGNATURE(0, "GIF8"), NULL, NULL, NULL, false, NULL, true},
    {"BMP", SIGNATURE(0, "BM"), NULL, NULL, NULL, false, NULL, true},
    {"TIFF", SIGNATURE(0, "II*\0"), READ_TIFF, NULL, NULL, false, NULL, true},
    {"TIFF", SIGNATURE(0, "MM\0*"), READ_TIFF, NULL, NULL, false, NULL, true},
    {"TIFF", SIGNATURE(0, "II+\0"), READ_TIFF, NULL, NULL, false, NULL, true},
    {"TIFF", SIGNATURE(0, "MM\0+"), READ_TIFF, NULL, NULL, false, NULL, true},
    {"AVIF", SIGNATURE(4, "ftypavif"), NULL, NULL, NULL, false, NULL, true},
    {"HEIF", SIGNATURE(4, "ftyphei"), NULL, NULL, NULL, false, NULL, true},
    {"JPEG XL", SIGNATURE(0, "\xff\x0a"), NULL, NULL, NULL, false, NULL, true},
    {"JPEG XL", SIGNATURE(4, "JXL \r\n"), NULL, NULL, NULL, false, NULL, true},
    {"JPEG 2000", SIGNATURE(4, "jP  \r\n"), NULL, NULL, NULL, false, NULL, true},
    {"Photoshop PSD", SIGNATURE(0, "8BPS"), NULL, NULL, NULL, false, NULL, true},
    {"GLB", SIGNATURE(0, "glTF"), NULL, NULL, NULL, false, NULL, false},
    {"HTML", SIGNATURE(0, "<!DOCTYPE"), NULL, NULL, NULL, false, NULL, false},
    {"HTML", SIGNATURE(0, "<html"), NULL, NULL, NULL, false, NULL, false},
    {"XML, perhaps SVG", SIGNATURE(0, "<?xml"), NULL, NULL, NULL, false, NULL, false},
    {"SVG", SIGNATURE(0, "<svg"), NULL, NULL, NULL, false, NULL, false},
    {"a Git LFS pointer", SIGNATURE(0, "version https://git-lfs"), NULL, NULL, NULL, false, NULL, false},
    {"TGA", SIGNATURE(0, ""), image_read_tga, NULL, NULL, false, NULL, false}, /* the last: it has no signature */
};
enum { FORMATS = sizeof formats / sizeof *formats };

/* Returns the format of a file by its first bytes; TGA if no signature matches. */
static const Format *format_of_bytes(const unsigned char *data, size_t size) {
    const Format *f = formats;
    while (f < &formats[FORMATS - 1] && !(size >= f->at + f->size && memcmp(data + f->at, f->signature, f->size) == 0))
        f++;
    return f;
}

/* Returns the format to write to a path, by its suffix; NULL if there is none. */
static const Format *format_of_path(const char *path) {
    size_t length = strlen(path);
    for (const Format *f = formats; f < &formats[FORMATS]; f++) {
        size_t suffix = f->suffix ? strlen(f->suffix) : length;
        if (length > suffix && strcasecmp(path + length - suffix, f->suffix) == 0) return f;
    }
    return NULL;
}

const char *image_media_type(const unsigned char *data, size_t size) { return format_of_bytes(data, size)->media_type; }

WeftResult weft_image_read_memory(const void *data, size_t size, const char *name, WeftImage *out, const WeftLog *log,
                                  WeftError *error) {
    *out = (WeftImage){0};
    ImageSource source = {.data = data, .size = size, .name = name, .log = log};
    const Format *format = format_of_bytes(data, size);
    if (!format->read)
        return fail(error, WEFT_MESSAGE_IMAGE_FORMAT, name, "it is %s%s", format->name,
                    format->picture ? "; convert it to .png, or to .exr if its numbers are floats" : "");
    return format->read(&source, out, error);
}

WeftResult weft_image_read(const char *path, WeftImage *out, const WeftLog *log, WeftError *error) {
    *out = (WeftImage){0};
    FileBytes file;
    WeftResult result = file_read(path, (size_t)1 << 30, &file, error);
    if (result != WEFT_OK) return result;
    result = weft_image_read_memory(file.data, file.size, path, out, log, error);
    free(file.data);
    return result;
}

WeftResult weft_image_read_channels(const char *path, const char *const *channels, int count, WeftImage *out,
                                    char **comment, WeftError *error) {
    *out = (WeftImage){0};
    if (comment) *comment = NULL;
    if (count < 1 || count > 4) return fail(error, WEFT_MESSAGE_DESC, path, "%d channels; 1 to 4", count);
    FileBytes file;
    WeftResult result = file_read(path, (size_t)1 << 30, &file, error);
    if (result != WEFT_OK) return result;
    const ImageSource source = {.data = file.data, .size = file.size, .name = path};
    const Format *format = format_of_bytes(file.data, file.size);
    result = format->read == image_read_exr
                 ? image_read_exr_channels(&source, channels, count, out, comment, error)
                 : fail(error, WEFT_MESSAGE_IMAGE_FORMAT, path, "only an .exr has channels with names");
    free(file.data);
    return result;
}

bool image_suffix_read(const char *path) {
    static const char *const suffixes[] = {".png", ".jpg", ".jpeg", ".webp", ".tga",
                                           ".hdr", ".exr", ".ktx2", ".tif",  ".tiff"};
    const bool tiff = format_of_bytes((const unsigned char *)"II*", 4)->read != NULL;
    bool read = false;
    for (size_t k = 0; k < sizeof suffixes / sizeof *suffixes - (tiff ? 0 : 2); k++)
        read |= path_ends(path, suffixes[k]);
    return read;
}

int weft_image_suffix_known(const char *path) { return format_of_path(path) != NULL; }

int weft_image_suffix_linear(const char *path) {
    const Format *format = format_of_path(path);
    return format && format->linear;
}

WeftResult weft_image_write(const char *path, const WeftImage *image, WeftError *error) {
    return weft_image_write_as(path, image, &(WeftImageWriting){0}, error);
}

WeftResult weft_image_write_as(const char *path, const WeftImage *image, const WeftImageWriting *how,
                               WeftError *error) {
    const Format *format = format_of_path(path);
    if (!format) return fail(error, WEFT_MESSAGE_OUTPUT_SUFFIX, path, NULL);
    if (!image->pixels) return fail(error, WEFT_MESSAGE_DESC, path, "an image without pixels");
    if (format->linear != (image->type == WEFT_PIXEL_F32))
        return fail(error, WEFT_MESSAGE_DESC, path, "%s takes %s pixels", format->suffix,
                    format->linear ? "float" : "8 or 16 bit");
    OutputFile file;
    WeftResult result = output_open(&file, path, error);
    if (result != WEFT_OK) return result;
    result = format->write(file.stream, path, image, how, error);
    if (result == WEFT_OK) return output_commit(&file, error);
    output_discard(&file);
    return result;
}

WeftResult weft_image_convert_f32(const WeftImage *in, int srgb, WeftImage *out, WeftError *error) {
    WeftResult result = weft_image_create(in->width, in->height, in->channels, WEFT_PIXEL_F32, out, error);
    if (result != WEFT_OK) return result;
    size_t count = value_count(in), channels = (size_t)in->channels;
    if (in->type == WEFT_PIXEL_F32) {
        memcpy(out->pixels, in->pixels, count * sizeof(float));
        return WEFT_OK;
    }
    const unsigned char *bytes = in->pixels;
    const uint16_t *words = in->pixels;
    float *values = out->pixels;
    const size_t alpha = channels % 2 == 0 ? channels - 1 : channels; /* channels: none */
    for (size_t i = 0; i < count; i++) {
        float value = in->type == WEFT_PIXEL_U8 ? (float)bytes[i] / 255.0f : (float)words[i] / 65535.0f;
        values[i] = srgb && i % channels != alpha ? srgb_decode(value) : value;
    }
    return WEFT_OK;
}
