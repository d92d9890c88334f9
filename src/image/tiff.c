/* tiff.c - the first picture of a TIFF file, by libtiff
 *
 * Numbers of 8 and 16 bits and floats of 16 and 32 are read as they are; pictures of other kinds, such as palettes,
 * inks and one bit, as libtiff converts them to 8 bits. */
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include <tiffio.h>

#include "base/fail.h"
#include "base/memory.h"
#include "image/codec.h"
#include "image/half.h"

/* A file while libtiff reads it. */
typedef struct TiffJob {
    const ImageSource *source;
    uint64_t at;
    char reason[160]; /* the first message */
} TiffJob;

typedef struct Tiff {
    const ImageSource *source;
    TIFF *file;
    TiffJob *job;
    uint32_t width, height;
    uint16_t bits, samples, kind, planes, photometric;
    int colors, alpha; /* alpha: its sample, or -1 */
    bool associated;   /* colours are multiplied by alpha */
} Tiff;

static tmsize_t job_read(thandle_t handle, void *to, tmsize_t size) {
    TiffJob *job = handle;
    const uint64_t left = job->at < job->source->size ? job->source->size - job->at : 0;
    const size_t count = size < 0 ? 0 : (uint64_t)size < left ? (size_t)size : (size_t)left;
    if (count) memcpy(to, job->source->data + job->at, count);
    job->at += count;
    return (tmsize_t)count;
}

static tmsize_t job_write(thandle_t handle, void *from, tmsize_t size) {
    (void)handle;
    (void)from;
    (void)size;
    return 0;
}

static toff_t job_seek(thandle_t handle, toff_t offset, int whence) {
    TiffJob *job = handle;
    job->at = whence == SEEK_CUR ? job->at + offset : whence == SEEK_END ? job->source->size + offset : offset;
    return job->at;
}

static int job_close(thandle_t handle) {
    (void)handle;
    return 0;
}

static toff_t job_size(thandle_t handle) { return ((TiffJob *)handle)->source->size; }

static int job_error(TIFF *file, void *user, const char *module, const char *format, va_list arguments) {
    TiffJob *job = user;
    (void)file;
    (void)module;
    if (!job->reason[0]) vsnprintf(job->reason, sizeof job->reason, format, arguments);
    for (char *c = job->reason; *c; c++)
        if ((unsigned char)*c >= 0x7f || (unsigned char)*c < 0x20) *c = '?';
    return 1;
}

static int job_warning(TIFF *file, void *user, const char *module, const char *format, va_list arguments) {
    (void)file;
    (void)user;
    (void)module;
    (void)format;
    (void)arguments;
    return 1;
}

static TIFF *job_open(TiffJob *job) {
    TIFFOpenOptions *options = TIFFOpenOptionsAlloc();
    if (!options) return NULL;
    TIFFOpenOptionsSetMaxSingleMemAlloc(options, (tmsize_t)1 << 30);
    TIFFOpenOptionsSetErrorHandlerExtR(options, job_error, job);
    TIFFOpenOptionsSetWarningHandlerExtR(options, job_warning, job);
    TIFF *file =
        TIFFClientOpenExt("memory", "rm", job, job_read, job_write, job_seek, job_close, job_size, NULL, NULL, options);
    TIFFOpenOptionsFree(options);
    return file;
}

static WeftResult damaged(const TiffJob *job, WeftError *error) {
    return fail(error, memory_was_short() ? WEFT_MESSAGE_MEMORY : WEFT_MESSAGE_IMAGE_DAMAGED, job->source->name,
                "TIFF: %s", job->reason[0] ? job->reason : "it cannot be decoded");
}

/* Fills what the header says, and the places of colours and alpha among its samples. */
static void header_take(Tiff *tiff) {
    uint16_t extra = 0, *types = NULL;
    TIFFGetField(tiff->file, TIFFTAG_IMAGEWIDTH, &tiff->width);
    TIFFGetField(tiff->file, TIFFTAG_IMAGELENGTH, &tiff->height);
    TIFFGetFieldDefaulted(tiff->file, TIFFTAG_BITSPERSAMPLE, &tiff->bits);
    TIFFGetFieldDefaulted(tiff->file, TIFFTAG_SAMPLESPERPIXEL, &tiff->samples);
    TIFFGetFieldDefaulted(tiff->file, TIFFTAG_SAMPLEFORMAT, &tiff->kind);
    TIFFGetFieldDefaulted(tiff->file, TIFFTAG_PLANARCONFIG, &tiff->planes);
    if (!TIFFGetField(tiff->file, TIFFTAG_PHOTOMETRIC, &tiff->photometric)) /* required, yet left out by some */
        tiff->photometric = tiff->samples >= 3 ? PHOTOMETRIC_RGB : PHOTOMETRIC_MINISBLACK;
    TIFFGetFieldDefaulted(tiff->file, TIFFTAG_EXTRASAMPLES, &extra, &types);
    tiff->colors = tiff->photometric == PHOTOMETRIC_RGB ? 3 : 1;
    tiff->alpha = -1;
    for (int k = 0; k < extra && tiff->alpha < 0; k++)
        if (types[k] != EXTRASAMPLE_UNSPECIFIED && tiff->colors + k < tiff->samples) {
            tiff->alpha = tiff->colors + k;
            tiff->associated = types[k] == EXTRASAMPLE_ASSOCALPHA;
        }
}

/* Returns true if the samples are the numbers of the picture. */
static bool is_plain(const Tiff *tiff) {
    const bool whole = tiff->kind == SAMPLEFORMAT_UINT && (tiff->bits == 8 || tiff->bits == 16);
    const bool single = tiff->kind == SAMPLEFORMAT_IEEEFP && (tiff->bits == 16 || tiff->bits == 32);
    uint16_t compression = COMPRESSION_NONE;
    TIFFGetFieldDefaulted(tiff->file, TIFFTAG_COMPRESSION, &compression);
    return (whole || single) && tiff->samples >= tiff->colors && compression != COMPRESSION_JPEG &&
           compression != COMPRESSION_OJPEG &&
           (tiff->photometric == PHOTOMETRIC_RGB || tiff->photometric == PHOTOMETRIC_MINISBLACK ||
            tiff->photometric == PHOTOMETRIC_MINISWHITE);
}

/* Returns the channel of the image that a sample is, or -1. */
static int channel_of(const Tiff *tiff, int sample) {
    return sample < tiff->colors ? sample : sample == tiff->alpha ? tiff->colors : -1;
}

/* Copies one sample, in this machine's byte order. */
static void sample_put(const Tiff *tiff, const unsigned char *at, size_t to, WeftImage *out) {
    uint16_t word;
    switch (out->type) {
    case WEFT_PIXEL_U8: ((uint8_t *)out->pixels)[to] = at[0]; break;
    case WEFT_PIXEL_U16: memcpy((uint16_t *)out->pixels + to, at, 2); break;
    case WEFT_PIXEL_F32:
        memcpy(&word, at, sizeof word);
        if (tiff->bits == 16)
            ((float *)out->pixels)[to] = half_value(word);
        else
            memcpy((float *)out->pixels + to, at, 4);
        break;
    }
}

/* Copies a block of pixels, of all samples or of one plane, whose first pixel is at (left, top). */
static void block_put(const Tiff *tiff, const unsigned char *block, uint32_t width, uint32_t height, uint32_t left,
                      uint32_t top, int plane, WeftImage *out) {
    const size_t bytes = tiff->bits / 8u, count = plane < 0 ? tiff->samples : 1u;
    for (uint32_t y = 0; y < height && top + y < tiff->height; y++)
        for (uint32_t x = 0; x < width && left + x < tiff->width; x++)
            for (size_t s = 0; s < count; s++) {
                const int channel = channel_of(tiff, plane < 0 ? (int)s : plane);
                const size_t pixel = (size_t)(top + y) * tiff->width + left + x;
                if (channel < 0) continue;
                sample_put(tiff, block + (((size_t)y * width + x) * count + s) * bytes,
                           pixel * (size_t)out->channels + (size_t)channel, out);
            }
}

/* Reads tiles or lines, plane by plane where samples lie in several. */
static bool blocks_read(const Tiff *tiff, WeftImage *out) {
    const bool separate = tiff->planes == PLANARCONFIG_SEPARATE && tiff->samples > 1, tiled = TIFFIsTiled(tiff->file);
    uint32_t width = tiff->width, height = 1;
    if (tiled) {
        TIFFGetField(tiff->file, TIFFTAG_TILEWIDTH, &width);
        TIFFGetField(tiff->file, TIFFTAG_TILELENGTH, &height);
    }
    const tmsize_t size = tiled ? TIFFTileSize(tiff->file) : TIFFScanlineSize(tiff->file);
    const uint64_t needed = (uint64_t)width * height * (separate ? 1u : tiff->samples) * (tiff->bits / 8u);
    if (size <= 0 || !width || !height || (uint64_t)size < needed || size > (tmsize_t)1 << 30) return false;
    unsigned char *block = alloc_array((size_t)size, 1);
    bool read = block != NULL;
    for (int plane = 0; plane < (separate ? tiff->samples : 1) && read; plane++)
        for (uint32_t y = 0; y < tiff->height && read; y += height)
            for (uint32_t x = 0; x < tiff->width && read; x += width) {
                read = tiled ? TIFFReadTile(tiff->file, block, x, y, 0, (uint16_t)plane) >= 0
                             : TIFFReadScanline(tiff->file, block, y, (uint16_t)plane) > 0;
                if (read) block_put(tiff, block, width, height, x, y, separate ? plane : -1, out);
            }
    free(block);
    return read;
}

/* Inverts greys that are white at 0, and divides colours that are multiplied by alpha. */
static void values_mend(const Tiff *tiff, WeftImage *out) {
    const size_t channels = (size_t)out->channels, count = (size_t)out->width * (size_t)out->height;
    const double most = out->type == WEFT_PIXEL_U8 ? 255.0 : out->type == WEFT_PIXEL_U16 ? 65535.0 : 1.0;
    const bool white = tiff->photometric == PHOTOMETRIC_MINISWHITE, divided = tiff->associated && channels % 2 == 0;
    for (size_t n = 0; n < count * channels && (white || divided); n++) {
        const size_t alpha = n / channels * channels + channels - 1;
        if (channels % 2 == 0 && n == alpha) continue;
        uint8_t *bytes = out->pixels;
        uint16_t *words = out->pixels;
        float *singles = out->pixels;
        double value = out->type == WEFT_PIXEL_U8    ? bytes[n]
                       : out->type == WEFT_PIXEL_U16 ? words[n]
                                                     : (double)singles[n];
        const double cover = out->type == WEFT_PIXEL_U8    ? bytes[alpha]
                             : out->type == WEFT_PIXEL_U16 ? words[alpha]
                                                           : (double)singles[alpha];
        if (divided && cover > 0.0) value *= most / cover;
        if (white) value = most - value;
        if (out->type == WEFT_PIXEL_F32)
            singles[n] = (float)value;
        else if (out->type == WEFT_PIXEL_U8)
            bytes[n] = (uint8_t)(fmax(fmin(value, most), 0.0) + 0.5);
        else
            words[n] = (uint16_t)(fmax(fmin(value, most), 0.0) + 0.5);
    }
}

/* Reads a picture of another kind as libtiff converts it. */
static WeftResult converted_read(Tiff *tiff, WeftImage *out, WeftError *error) {
    char why[1024] = "";
    if (!TIFFRGBAImageOK(tiff->file, why)) {
        for (char *c = why; *c; c++)
            if ((unsigned char)*c >= 0x7f || (unsigned char)*c < 0x20) *c = '?';
        return fail(error, WEFT_MESSAGE_IMAGE_UNSUPPORTED, tiff->source->name,
                    "TIFF: %.200s; convert it to .png or .exr", why);
    }
    WeftResult result = weft_image_create((int)tiff->width, (int)tiff->height, 3, WEFT_PIXEL_U8, out, error);
    if (result != WEFT_OK) return result;
    const size_t count = (size_t)tiff->width * tiff->height;
    uint32_t *pixels = alloc_array(count, sizeof *pixels);
    if (!pixels) return fail(error, WEFT_MESSAGE_MEMORY, tiff->source->name, NULL);
    const bool read =
        TIFFReadRGBAImageOriented(tiff->file, tiff->width, tiff->height, pixels, ORIENTATION_TOPLEFT, 1) != 0;
    for (size_t n = 0; n < count && read; n++) {
        unsigned char *to = (unsigned char *)out->pixels + 3 * n;
        to[0] = (unsigned char)TIFFGetR(pixels[n]);
        to[1] = (unsigned char)TIFFGetG(pixels[n]);
        to[2] = (unsigned char)TIFFGetB(pixels[n]);
    }
    free(pixels);
    return read ? WEFT_OK : damaged(tiff->job, error);
}

static WeftResult plain_read(Tiff *tiff, WeftImage *out, WeftError *error) {
    const WeftPixelType type = tiff->kind == SAMPLEFORMAT_IEEEFP ? WEFT_PIXEL_F32
                               : tiff->bits == 8                 ? WEFT_PIXEL_U8
                                                                 : WEFT_PIXEL_U16;
    const int channels = tiff->colors + (tiff->alpha >= 0);
    WeftResult result = weft_image_create((int)tiff->width, (int)tiff->height, channels, type, out, error);
    if (result != WEFT_OK) return result;
    if (!blocks_read(tiff, out)) return damaged(tiff->job, error);
    values_mend(tiff, out);
    if (type == WEFT_PIXEL_F32) image_repair(tiff->source, out);
    return WEFT_OK;
}

WeftResult image_read_tiff(const ImageSource *source, WeftImage *out, WeftError *error) {
    /* Deflate has 1032; what other compressions reach beyond it is not a picture. */
    const int64_t ratio_most = 4096;
    TiffJob job = {.source = source};
    memory_begin();
    Tiff tiff = {.source = source, .job = &job, .file = job_open(&job)};
    if (!tiff.file) return damaged(&job, error);
    header_take(&tiff);
    const int64_t bytes = (int64_t)tiff.samples * (tiff.bits < 8 ? 1 : tiff.bits / 8) + 4;
    WeftResult result = image_check_header(source, tiff.width, tiff.height, bytes, error);
    if (result == WEFT_OK)
        result = image_reachable(source, (int64_t)tiff.width * tiff.height * tiff.samples * tiff.bits / 8 / ratio_most,
                                 error);
    if (result == WEFT_OK) result = is_plain(&tiff) ? plain_read(&tiff, out, error) : converted_read(&tiff, out, error);
    uint16_t orientation = ORIENTATION_TOPLEFT;
    TIFFGetFieldDefaulted(tiff.file, TIFFTAG_ORIENTATION, &orientation);
    if (result == WEFT_OK && orientation != ORIENTATION_TOPLEFT && is_plain(&tiff))
        warn(source->log, WEFT_MESSAGE_IMAGE_REPAIRED, source->name, "TIFF: its orientation %d is passed over",
             orientation);
    if (result == WEFT_OK && tiff.samples > tiff.colors + (tiff.alpha >= 0) && is_plain(&tiff))
        warn(source->log, WEFT_MESSAGE_IMAGE_REPAIRED, source->name, "TIFF: it shows %d of its %d channels",
             tiff.colors + (tiff.alpha >= 0), tiff.samples);
    if (result == WEFT_OK && TIFFLastDirectory(tiff.file) == 0)
        warn(source->log, WEFT_MESSAGE_IMAGE_REPAIRED, source->name, "TIFF: it shows the first of its pictures");
    TIFFClose(tiff.file);
    if (result != WEFT_OK) weft_image_free(out);
    return result;
}
