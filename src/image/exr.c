/* exr.c - OpenEXR through its C library, but for two compressions; colours of a file are multiplied by alpha, those
 * of a WeftImage are not */
#include <float.h>
#include <limits.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <openexr.h>

#include "base/fail.h"
#include "base/little_endian.h"
#include "base/memory.h"
#include "base/stream_reason.h"
#include "image/codec.h"
#include "image/exr_dwa.h"
#include "image/exr_pick.h"
#include "image/half.h"
#include "image/primaries.h"

/* The attribute with the denoiser of a picture. */
static const char exr_denoised[] = "denoised";

/* The state that the library's callbacks share. */
typedef struct ExrJob {
    const ImageSource *source; /* when reading */
    FILE *stream;              /* when writing */
    char reason[192];          /* the library's first error message */
} ExrJob;

static ExrJob *exr_job(exr_const_context_t exr) {
    void *job = NULL;
    return exr_get_user_data(exr, &job) == EXR_ERR_SUCCESS ? job : NULL;
}

static void exr_job_error(exr_const_context_t exr, exr_result_t code, const char *text) {
    (void)code;
    ExrJob *job = exr_job(exr);
    if (!job || job->reason[0]) return;
    snprintf(job->reason, sizeof job->reason, "%s", text);
    for (char *c = job->reason; *c; c++) /* the library quotes bytes of the file */
        if ((unsigned char)*c >= 0x7f) *c = '?';
}

/* Allocates memory of a bounded size, zeroed so that a chunk that decodes to too few bytes shows no old memory. */
static void *exr_job_alloc(size_t size) { return size <= (size_t)1 << 30 ? alloc_array(size, 1) : NULL; }

static int64_t exr_job_read(exr_const_context_t exr, void *user, void *to, uint64_t size, uint64_t offset,
                            exr_stream_error_func_ptr_t report) {
    (void)exr;
    (void)report;
    const ImageSource *source = ((ExrJob *)user)->source;
    if (offset >= source->size) return 0;
    if (size > source->size - offset) size = source->size - offset;
    memcpy(to, source->data + offset, size);
    return (int64_t)size;
}

static int64_t exr_job_size(exr_const_context_t exr, void *user) {
    (void)exr;
    return (int64_t)((ExrJob *)user)->source->size;
}

static int64_t exr_job_write(exr_const_context_t exr, void *user, const void *from, uint64_t size, uint64_t offset,
                             exr_stream_error_func_ptr_t report) {
    (void)exr;
    (void)report;
    FILE *stream = ((ExrJob *)user)->stream;
    if (offset > LONG_MAX || fseek(stream, (long)offset, SEEK_SET) != 0) return -1;
    return (int64_t)fwrite(from, 1, size, stream);
}

static exr_context_initializer_t exr_job_setup(ExrJob *job) {
    exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
    setup.error_handler_fn = exr_job_error;
    setup.alloc_fn = exr_job_alloc;
    setup.free_fn = free;
    setup.user_data = job;
    return setup;
}

/* Reading. */

typedef struct Exr {
    const ImageSource *source;
    exr_context_t context;
    int part;
    exr_attr_box2i_t data, display; /* windows, inclusive */
    exr_compression_t compression;
    const exr_attr_chlist_t *channels;
    const char *const *wanted; /* names of the channels to read, as they are; NULL: those of the picture */
    int wanted_count;
    ExrPick pick;
    int64_t pixel_bytes; /* of all the file's channels */
    bool tiled;
    int32_t chunk_width, chunk_height; /* of a tile, or of a block of lines; the last ones may be smaller */
    exr_decode_pipeline_t pipeline;
    exr_result_t (*decompress)(exr_decode_pipeline_t *); /* the library's, NULL without compression */
} Exr;

static int64_t box_width(exr_attr_box2i_t box) { return (int64_t)box.max.x - box.min.x + 1; }
static int64_t box_height(exr_attr_box2i_t box) { return (int64_t)box.max.y - box.min.y + 1; }

static int value_bytes(exr_pixel_type_t type) { return type == EXR_PIXEL_HALF ? 2 : 4; }

/* Returns the first part that is not deep, or -1; *count receives the number of parts. */
static int flat_part(exr_context_t context, int *count) {
    *count = 0;
    exr_get_count(context, count);
    for (int part = 0; part < *count; part++) {
        exr_storage_t storage;
        if (exr_get_storage(context, part, &storage) == EXR_ERR_SUCCESS &&
            (storage == EXR_STORAGE_SCANLINE || storage == EXR_STORAGE_TILED))
            return part;
    }
    return -1;
}

/* Picks the channels that are wanted, by their full names. */
static WeftResult wanted_pick(Exr *exr, WeftError *error) {
    exr->pick = (ExrPick){.from = {-1, -1, -1, -1}, .count = exr->wanted_count};
    for (int c = 0; c < exr->wanted_count; c++) {
        for (int i = 0; i < exr->channels->num_channels; i++)
            if (strcmp(exr->channels->entries[i].name.str, exr->wanted[c]) == 0) exr->pick.from[c] = i;
        if (exr->pick.from[c] < 0)
            return fail(error, WEFT_MESSAGE_IMAGE_UNSUPPORTED, exr->source->name, "EXR: it has no channel %s",
                        exr->wanted[c]);
    }
    return WEFT_OK;
}

/* Picks the picture's channels, or those that are wanted. Refuses subsampled channels, which luminance-chroma files have and which would change
 * the order of the values in a chunk. */
static WeftResult exr_channels(Exr *exr, WeftError *error) {
    const char *name = exr->source->name;
    const exr_attr_chlist_t *channels = exr->channels;
    for (int i = 0; i < channels->num_channels; i++) {
        const exr_attr_chlist_entry_t *entry = channels->entries + i;
        const char *channel = entry->name.str + exr_layer_length(entry->name.str);
        if (strcmp(channel, "RY") == 0 || strcmp(channel, "BY") == 0)
            return fail(error, WEFT_MESSAGE_IMAGE_UNSUPPORTED, name,
                        "EXR: luminance-chroma pixels; convert it to R G B");
        if (entry->x_sampling != 1 || entry->y_sampling != 1)
            return fail(error, WEFT_MESSAGE_IMAGE_UNSUPPORTED, name, "EXR: subsampled channels; convert it to R G B");
        exr->pixel_bytes += value_bytes(entry->pixel_type);
    }
    if (exr->wanted) return wanted_pick(exr, error);
    if (!exr_pick(channels, &exr->pick))
        return fail(error, WEFT_MESSAGE_IMAGE_UNSUPPORTED, name,
                    "EXR: no channels R G B, red green blue, X Y Z, Y or V; rename those of its picture");
    if (exr->pick.words[0])
        warn(exr->source->log, WEFT_MESSAGE_IMAGE_REPAIRED, name, "EXR: it shows %s", exr->pick.words);
    return WEFT_OK;
}

/* Returns an upper bound of the bytes of pixels that a byte of a file decodes to. Deflate has 1032 (258 bytes from 2
 * bits); before it PXR24 drops one byte of four of a float, and DWA codes 64 halves in two bytes. The run lengths of
 * RLE and PIZ and the fixed blocks of B44 stay below Deflate. */
static int64_t ratio_most(exr_compression_t compression) {
    const int64_t deflate = 1032;
    switch (compression) {
    case EXR_COMPRESSION_NONE: return 1;
    case EXR_COMPRESSION_PXR24: return deflate * 4 / 3;
    case EXR_COMPRESSION_DWAA:
    case EXR_COMPRESSION_DWAB: return deflate * 64;
    default: return deflate;
    }
}

/* Returns false for a window so far off that it would overflow the library's sums; the C++ library has this limit
 * too. */
static int box_sane(exr_attr_box2i_t box) {
    const int far = INT_MAX / 2;
    return box.min.x > -far && box.min.y > -far && box.max.x < far && box.max.y < far;
}

/* Reads the size of the chunks of the full image (level 0). */
static exr_result_t exr_chunks(Exr *exr) {
    exr_storage_t storage = EXR_STORAGE_SCANLINE;
    exr_result_t status = exr_get_storage(exr->context, exr->part, &storage);
    exr->tiled = storage == EXR_STORAGE_TILED;
    exr->chunk_width = (int32_t)box_width(exr->data);
    if (status == EXR_ERR_SUCCESS)
        status = exr->tiled ? exr_get_tile_sizes(exr->context, exr->part, 0, 0, &exr->chunk_width, &exr->chunk_height)
                            : exr_get_scanlines_per_chunk(exr->context, exr->part, &exr->chunk_height);
    return status;
}

/* Fills *exr from the header and checks everything that sizes depend on. */
static WeftResult exr_header(Exr *exr, WeftError *error) {
    const ImageSource *source = exr->source;
    int parts;
    exr->part = flat_part(exr->context, &parts);
    if (exr->part < 0) return fail(error, WEFT_MESSAGE_IMAGE_UNSUPPORTED, source->name, "EXR: deep pixels; flatten it");
    if (parts > 1)
        warn(source->log, WEFT_MESSAGE_IMAGE_REPAIRED, source->name, "EXR: it shows the first of its %d parts", parts);
    if (exr_get_data_window(exr->context, exr->part, &exr->data) != EXR_ERR_SUCCESS ||
        exr_get_display_window(exr->context, exr->part, &exr->display) != EXR_ERR_SUCCESS ||
        exr_get_compression(exr->context, exr->part, &exr->compression) != EXR_ERR_SUCCESS ||
        exr_get_channels(exr->context, exr->part, &exr->channels) != EXR_ERR_SUCCESS)
        return fail(error, WEFT_MESSAGE_IMAGE_DAMAGED, source->name, "EXR: its header lacks what it must have");
    if (!box_sane(exr->data) || !box_sane(exr->display))
        return fail(error, WEFT_MESSAGE_IMAGE_SIZE, source->name, "EXR: a window too far off");
    WeftResult result = exr_channels(exr, error);
    if (result != WEFT_OK) return result;

    const int64_t width = box_width(exr->data), height = box_height(exr->data);
    if (exr_chunks(exr) != EXR_ERR_SUCCESS)
        return fail(error, WEFT_MESSAGE_IMAGE_DAMAGED, source->name, "EXR: its header describes no chunks");
    /* A chunk is in memory up to three times: packed, in an intermediate form and unpacked. */
    result = image_check_header(source, exr->chunk_width, exr->chunk_height, 3 * exr->pixel_bytes, error);
    if (result == WEFT_OK) result = image_check_header(source, width, height, exr->pixel_bytes, error);
    if (result == WEFT_OK)
        result = image_reachable(source, width * height * exr->pixel_bytes / ratio_most(exr->compression), error);
    if (result == WEFT_OK)
        result = image_check_header(source, box_width(exr->display), box_height(exr->display),
                                    exr->pick.count * (int64_t)sizeof(float), error);
    return result;
}

/* Returns one value of the file, which is little-endian. */
static float value_read(const unsigned char *at, exr_pixel_type_t type) {
    if (type == EXR_PIXEL_HALF) return half_value((unsigned)little_endian(at, 2));
    return type == EXR_PIXEL_UINT ? (float)(uint32_t)little_endian(at, 4) : little_endian_float(at);
}

/* Copies the channels of the image from a line of the file, which contains one channel after another. Its first pixel
 * is at column x of the image, and the line may extend beyond the image on both sides. */
static void line_place(const Exr *exr, const unsigned char *line, int64_t width, int64_t x, float *to,
                       int64_t to_width) {
    const int64_t first = x < 0 ? -x : 0, end = x + width > to_width ? to_width - x : width;
    for (int i = 0; i < exr->channels->num_channels; i++) {
        const exr_pixel_type_t type = exr->channels->entries[i].pixel_type;
        for (int c = 0; c < exr->pick.count; c++) {
            if (exr->pick.from[c] != i) continue;
            for (int64_t n = first; n < end; n++)
                to[(x + n) * exr->pick.count + c] = value_read(line + n * value_bytes(type), type);
        }
        line += width * value_bytes(type);
    }
}

/* Decompresses one chunk, its first pixel at (x, y) of the image, and copies it. The library only reads and
 * decompresses: its conversions (3.1.5) reverse the channels of interleaved half, and for a file of three or four
 * channels write through the null pointers of those that were not requested. */
static exr_result_t chunk_decode(Exr *exr, const exr_chunk_info_t *chunk, int64_t x, int64_t y, WeftImage *image) {
    exr_decode_pipeline_t *pipeline = &exr->pipeline;
    const int64_t line_bytes = chunk->width * exr->pixel_bytes;
    if (chunk->width < 1 || chunk->height < 1 || (int64_t)chunk->unpacked_size != line_bytes * chunk->height ||
        (exr->compression == EXR_COMPRESSION_NONE && chunk->packed_size != chunk->unpacked_size))
        return EXR_ERR_CORRUPT_CHUNK;
    exr_result_t status;
    if (pipeline->channels) {
        status = exr_decoding_update(exr->context, exr->part, chunk, pipeline);
    } else {
        status = exr_decoding_initialize(exr->context, exr->part, chunk, pipeline);
        if (status == EXR_ERR_SUCCESS) status = exr_decoding_choose_default_routines(exr->context, exr->part, pipeline);
        pipeline->unpack_and_convert_fn = NULL;
        exr->decompress = pipeline->decompress_fn;
    }
    /* A chunk of the full size is not compressed; the library would decompress B44 even then. */
    pipeline->decompress_fn = chunk->packed_size == chunk->unpacked_size ? NULL : exr->decompress;
    if (status == EXR_ERR_SUCCESS) status = exr_decoding_run(exr->context, exr->part, pipeline);
    if (status != EXR_ERR_SUCCESS) return status;
    for (int64_t row = 0; row < chunk->height; row++) {
        if (y + row < 0 || y + row >= image->height) continue;
        line_place(exr, (const unsigned char *)pipeline->unpacked_buffer + row * line_bytes, chunk->width, x,
                   (float *)image->pixels + (y + row) * image->width * exr->pick.count, image->width);
    }
    return EXR_ERR_SUCCESS;
}

/* Decodes all chunks of the full image, whose first pixel is at (left, top) of *image. */
static exr_result_t chunks_decode(Exr *exr, int64_t left, int64_t top, WeftImage *image) {
    const int64_t width = exr->chunk_width, height = exr->chunk_height;
    for (int64_t y = 0; y * height < box_height(exr->data); y++)
        for (int64_t x = 0; x * width < box_width(exr->data); x++) {
            exr_chunk_info_t chunk;
            exr_result_t status = exr->tiled
                                      ? exr_read_tile_chunk_info(exr->context, exr->part, (int)x, (int)y, 0, 0, &chunk)
                                      : exr_read_scanline_chunk_info(exr->context, exr->part,
                                                                     (int)(exr->data.min.y + y * height), &chunk);
            if (status == EXR_ERR_SUCCESS)
                status = chunk_decode(exr, &chunk, left + x * width, top + y * height, image);
            if (status != EXR_ERR_SUCCESS) return status;
        }
    return EXR_ERR_SUCCESS;
}

/* Reads a file of a compression that the C library lacks (3.1.5), as chunks_decode does. */
static WeftResult whole_decode(Exr *exr, int64_t left, int64_t top, WeftImage *image, WeftError *error) {
    const int64_t width = box_width(exr->data), height = box_height(exr->data);
    const int count = exr->pick.count;
    ExrPlanes planes = {.count = count, .left = exr->data.min.x, .top = exr->data.min.y, .width = (int)width};
    char reason[128] = "";
    for (int c = 0; c < count; c++)
        if (exr->pick.from[c] >= 0) planes.names[c] = exr->channels->entries[exr->pick.from[c]].name.str;
    planes.values = alloc_array((size_t)(width * height), (size_t)count * sizeof(float));
    if (!planes.values) return fail(error, WEFT_MESSAGE_MEMORY, exr->source->name, NULL);
    const ExrDwa status = exr_dwa_read(exr->source->data, exr->source->size, exr->part, &planes, reason, sizeof reason);
    const int64_t first = left < 0 ? -left : 0, end = left + width > image->width ? image->width - left : width;
    for (int64_t y = 0; status == EXR_DWA_READ && y < height; y++)
        if (top + y >= 0 && top + y < image->height && first < end)
            memcpy((float *)image->pixels + ((top + y) * image->width + left + first) * count,
                   planes.values + (y * width + first) * count, (size_t)((end - first) * count) * sizeof(float));
    free(planes.values);
    if (status == EXR_DWA_READ) return WEFT_OK;
    for (char *c = reason; *c; c++) /* the library quotes bytes of the file */
        if ((unsigned char)*c >= 0x7f) *c = '?';
    return fail(error, status == EXR_DWA_MEMORY ? WEFT_MESSAGE_MEMORY : WEFT_MESSAGE_IMAGE_DAMAGED, exr->source->name,
                "EXR: %s", reason);
}

/* Converts colours to those of Rec. 709, where the file says that they are others. */
static void colors_convert(const Exr *exr, WeftImage *image) {
    exr_attr_chromaticities_t given;
    ColorConversion matrix = xyz_matrix();
    if (image->channels < 3) return;
    if (!exr->pick.xyz) {
        if (exr_attr_get_chromaticities(exr->context, exr->part, "chromaticities", &given) != EXR_ERR_SUCCESS) return;
        const Primaries primaries = {{(double)given.red_x, (double)given.red_y, (double)given.green_x,
                                      (double)given.green_y, (double)given.blue_x, (double)given.blue_y,
                                      (double)given.white_x, (double)given.white_y}};
        if (primaries_rec709(&primaries)) return;
        const bool spanned = primaries_matrix(&primaries, &matrix);
        warn(exr->source->log, WEFT_MESSAGE_IMAGE_REPAIRED, exr->source->name, "EXR: its chromaticities are %s",
             spanned ? "other than Rec. 709's, to which its colours were turned" : "those of no colours; Rec. 709's");
        if (!spanned) return;
    }
    image_convert_colors(image, &matrix);
}

/* Divides colours by alpha. Where alpha is 0 they are light without coverage and stay. */
static void alpha_straighten(WeftImage *image) {
    const int channels = image->channels;
    if (channels % 2) return;
    float *pixel = image->pixels;
    const size_t count = (size_t)image->width * (size_t)image->height;
    for (size_t i = 0; i < count; i++, pixel += channels)
        for (int c = 0; pixel[channels - 1] > 0.0f && c < channels - 1; c++) pixel[c] /= pixel[channels - 1];
}

/* Fails with the message for a status of the library. */
static WeftResult exr_refuse(const ExrJob *job, exr_result_t status, WeftError *error) {
    WeftMessage message = WEFT_MESSAGE_IMAGE_DAMAGED;
    if (status == EXR_ERR_FEATURE_NOT_IMPLEMENTED) message = WEFT_MESSAGE_IMAGE_UNSUPPORTED;
    if (memory_was_short()) message = WEFT_MESSAGE_MEMORY;
    return fail(error, message, job->source->name, "EXR: %s",
                job->reason[0] ? job->reason : exr_get_default_error_message(status));
}

static WeftResult exr_decode(Exr *exr, const ExrJob *job, WeftImage *out, WeftError *error) {
    WeftResult result = exr_header(exr, error);
    if (result != WEFT_OK) return result;
    result = weft_image_create((int)box_width(exr->display), (int)box_height(exr->display), exr->pick.count,
                               WEFT_PIXEL_F32, out, error);
    if (result != WEFT_OK) return result;
    const int64_t left = (int64_t)exr->data.min.x - exr->display.min.x;
    const int64_t top = (int64_t)exr->data.min.y - exr->display.min.y;
    if (exr->compression == EXR_COMPRESSION_DWAA || exr->compression == EXR_COMPRESSION_DWAB) {
        result = whole_decode(exr, left, top, out, error);
        if (result != WEFT_OK) return result;
    } else {
        exr_result_t status = chunks_decode(exr, left, top, out);
        if (exr->pipeline.channels) exr_decoding_destroy(exr->context, &exr->pipeline);
        if (status != EXR_ERR_SUCCESS) return exr_refuse(job, status, error);
    }
    if (exr->wanted) return WEFT_OK;
    alpha_straighten(out);
    image_repair(exr->source, out);
    colors_convert(exr, out);
    const exr_attribute_t *denoised = NULL;
    if (exr_get_attribute_by_name(exr->context, exr->part, exr_denoised, &denoised) == EXR_ERR_SUCCESS)
        warn(exr->source->log, WEFT_MESSAGE_IMAGE_DENOISED, exr->source->name, NULL);
    return WEFT_OK;
}

/* Copies the attribute of comments, NULL where there is none; returns false if memory is short. */
static bool comment_copy(const Exr *exr, char **comment) {
    const exr_attribute_t *attribute = NULL;
    *comment = NULL;
    if (exr_get_attribute_by_name(exr->context, exr->part, "comments", &attribute) != EXR_ERR_SUCCESS ||
        attribute->type != EXR_ATTR_STRING || !attribute->string->str)
        return true;
    const size_t length = (size_t)attribute->string->length;
    *comment = alloc_array(length + 1, 1);
    if (*comment) memcpy(*comment, attribute->string->str, length);
    return *comment != NULL;
}

/* Reads the picture, or the channels that are wanted and the comment. */
static WeftResult exr_read(Exr *exr, WeftImage *out, char **comment, WeftError *error) {
    const ImageSource *source = exr->source;
    ExrJob job = {.source = source};
    exr_context_initializer_t setup = exr_job_setup(&job);
    setup.read_fn = exr_job_read;
    setup.size_fn = exr_job_size;
    setup.max_image_width = setup.max_image_height = IMAGE_SIDE_MAX;
    setup.max_tile_width = setup.max_tile_height = IMAGE_SIDE_MAX;
    setup.flags = EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION; /* a cut file is damaged, not half an image */
    memory_begin();
    exr_result_t status = exr_start_read(&exr->context, source->name, &setup);
    if (status != EXR_ERR_SUCCESS) return exr_refuse(&job, status, error);
    WeftResult result = exr_decode(exr, &job, out, error);
    if (result == WEFT_OK && comment && !comment_copy(exr, comment))
        result = fail(error, WEFT_MESSAGE_MEMORY, source->name, NULL);
    exr_finish(&exr->context);
    if (result != WEFT_OK) weft_image_free(out);
    return result;
}

WeftResult image_read_exr(const ImageSource *source, WeftImage *out, WeftError *error) {
    Exr exr = {.source = source};
    return exr_read(&exr, out, NULL, error);
}

WeftResult image_read_exr_channels(const ImageSource *source, const char *const *channels, int count, WeftImage *out,
                                   char **comment, WeftError *error) {
    Exr exr = {.source = source, .wanted = channels, .wanted_count = count};
    return exr_read(&exr, out, comment, error);
}

/* Writing. */

/* Channels by name, in the alphabetical order that the format requires, with their index in the image. */
static const struct {
    const char *name;
    int channel;
} exr_layouts[5][4] = {
    {{0}}, {{"Y", 0}}, {{"A", 1}, {"Y", 0}}, {{"B", 2}, {"G", 1}, {"R", 0}}, {{"A", 3}, {"B", 2}, {"G", 1}, {"R", 0}},
};

/* One channel of the file. */
typedef struct ExrPlane {
    const char *name;
    const WeftImage *image;
    int channel;
    bool covered; /* multiplied by alpha */
    bool single;  /* of 32 bits, else half */
} ExrPlane;

enum { EXR_PLANES = 4 * (1 + WEFT_IMAGE_LAYERS) };

static int compare_planes(const void *a, const void *b) {
    return strcmp(((const ExrPlane *)a)->name, ((const ExrPlane *)b)->name);
}

/* Lists all channels in the file's order; returns their number. */
static int planes_list(const WeftImage *image, const WeftImageWriting *how, ExrPlane planes[EXR_PLANES]) {
    int count = 0, alpha = image->channels % 2 == 0 ? image->channels - 1 : -1;
    for (int c = 0; c < image->channels; c++) {
        int from = exr_layouts[image->channels][c].channel;
        planes[count++] = (ExrPlane){exr_layouts[image->channels][c].name, image, from,
                                     alpha >= 0 && from != alpha && !how->data, how->single != 0};
    }
    for (int k = 0; k < how->layer_count; k++)
        for (int c = 0; c < how->layers[k].image->channels; c++)
            planes[count++] = (ExrPlane){how->layers[k].channels[c], how->layers[k].image, c, false, true};
    qsort(planes, (size_t)count, sizeof *planes, compare_planes);
    return count;
}

static WeftResult layers_check(const char *name, const WeftImage *image, const WeftImageWriting *how,
                               WeftError *error) {
    if (how->layer_count < 0 || how->layer_count > WEFT_IMAGE_LAYERS)
        return fail(error, WEFT_MESSAGE_DESC, name, "%d layers; at most %d", how->layer_count, WEFT_IMAGE_LAYERS);
    for (int k = 0; k < how->layer_count; k++) {
        const WeftImage *layer = how->layers[k].image;
        if (!layer || !layer->pixels || layer->type != WEFT_PIXEL_F32 || layer->width != image->width ||
            layer->height != image->height || layer->channels < 1 || layer->channels > 4)
            return fail(error, WEFT_MESSAGE_DESC, name, "a layer has not the form of the picture");
        for (int c = 0; c < layer->channels; c++)
            if (!how->layers[k].channels[c])
                return fail(error, WEFT_MESSAGE_DESC, name, "a layer has a channel without a name");
    }
    return WEFT_OK;
}

static exr_result_t exr_describe(exr_context_t exr, const WeftImage *image, const WeftImageWriting *how,
                                 const ExrPlane *planes, int count) {
    int part = 0;
    exr_result_t status = exr_add_part(exr, "image", EXR_STORAGE_SCANLINE, &part);
    if (status == EXR_ERR_SUCCESS)
        status = exr_initialize_required_attr_simple(exr, part, image->width, image->height, EXR_COMPRESSION_ZIP);
    for (int k = 0; status == EXR_ERR_SUCCESS && k < count; k++)
        status = exr_add_channel(
            exr, part, planes[k].name, planes[k].single ? EXR_PIXEL_FLOAT : EXR_PIXEL_HALF,
            how->data || planes[k].image != image ? EXR_PERCEPTUALLY_LINEAR : EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1);
    if (status == EXR_ERR_SUCCESS && how->comment) status = exr_attr_set_string(exr, part, "comments", how->comment);
    if (status == EXR_ERR_SUCCESS && how->denoised)
        status = exr_attr_set_string(exr, part, exr_denoised, how->denoised);
    for (int k = 0; status == EXR_ERR_SUCCESS && k < how->text_count; k++)
        status = exr_attr_set_string(exr, part, how->texts[k].name, how->texts[k].text);
    if (status == EXR_ERR_SUCCESS && how->isa) status = exr_attr_set_string(exr, part, "isa", how->isa);
    if (status == EXR_ERR_SUCCESS) status = exr_set_version(exr, part, 1);
    return status == EXR_ERR_SUCCESS ? exr_write_header(exr) : status;
}

/* Returns x clamped to [-most, most]; NaN becomes 0. */
static float clamped(float x, float most) { return isnan(x) ? 0.0f : fminf(fmaxf(x, -most), most); }

/* Fills `to` with lines y .. y + lines of a channel for the file: colours are multiplied by alpha. */
static void plane_fill(const ExrPlane *plane, int y, int lines, float *to) {
    const WeftImage *image = plane->image;
    const float most = plane->single ? FLT_MAX : 65504.0f;
    const int channels = image->channels;
    const float *pixel = (const float *)image->pixels + (size_t)y * (size_t)image->width * (size_t)channels;
    for (size_t i = 0; i < (size_t)image->width * (size_t)lines; i++, pixel += channels) {
        const float cover = plane->covered ? clamped(pixel[channels - 1], most) : 1.0f;
        to[i] = clamped(clamped(pixel[plane->channel], most) * cover, most);
    }
}

/* Compresses a chunk by the library and corrects its result: if the compressed chunk is not smaller, the library
 * (3.1.5) keeps it, but a reader takes a chunk of the full size for an uncompressed one. */
static exr_result_t chunk_compress(exr_encode_pipeline_t *pipeline) {
    exr_result_t (*const *library)(exr_encode_pipeline_t *) = pipeline->encoding_user_data;
    exr_result_t status = (*library)(pipeline);
    if (status == EXR_ERR_SUCCESS && pipeline->compressed_bytes >= pipeline->packed_bytes) {
        memcpy(pipeline->compressed_buffer, pipeline->packed_buffer, pipeline->packed_bytes);
        pipeline->compressed_bytes = pipeline->packed_bytes;
    }
    return status;
}

static exr_result_t exr_encode(exr_context_t exr, const WeftImage *image, const ExrPlane *planes, int count,
                               float *values, int chunk_lines) {
    exr_encode_pipeline_t pipeline = EXR_ENCODE_PIPELINE_INITIALIZER;
    exr_result_t (*library)(exr_encode_pipeline_t *) = NULL;
    exr_result_t status = EXR_ERR_SUCCESS;
    for (int y = 0; status == EXR_ERR_SUCCESS && y < image->height; y += chunk_lines) {
        exr_chunk_info_t chunk;
        const int first = pipeline.channels == NULL;
        status = exr_write_scanline_chunk_info(exr, 0, y, &chunk);
        if (status == EXR_ERR_SUCCESS)
            status = first ? exr_encoding_initialize(exr, 0, &chunk, &pipeline)
                           : exr_encoding_update(exr, 0, &chunk, &pipeline);
        if (status != EXR_ERR_SUCCESS) break;
        for (int c = 0; c < count; c++) {
            exr_coding_channel_info_t *channel = pipeline.channels + c;
            float *plane = values + (size_t)c * (size_t)image->width * (size_t)chunk.height;
            plane_fill(&planes[c], y, chunk.height, plane);
            channel->encode_from_ptr = (const uint8_t *)plane;
            channel->user_data_type = EXR_PIXEL_FLOAT;
            channel->user_bytes_per_element = sizeof(float);
            channel->user_pixel_stride = sizeof(float);
            channel->user_line_stride = (int32_t)sizeof(float) * image->width;
        }
        if (first) {
            status = exr_encoding_choose_default_routines(exr, 0, &pipeline);
            library = pipeline.compress_fn;
            pipeline.compress_fn = chunk_compress;
            pipeline.encoding_user_data = &library;
        }
        if (status == EXR_ERR_SUCCESS) status = exr_encoding_run(exr, 0, &pipeline);
    }
    if (pipeline.channels) exr_encoding_destroy(exr, &pipeline);
    return status;
}

WeftResult image_write_exr(FILE *stream, const char *name, const WeftImage *image, const WeftImageWriting *how,
                           WeftError *error) {
    ExrJob job = {.stream = stream};
    ExrPlane planes[EXR_PLANES];
    WeftResult result = layers_check(name, image, how, error);
    if (result != WEFT_OK) return result;
    int count = planes_list(image, how, planes);
    exr_context_initializer_t setup = exr_job_setup(&job);
    setup.write_fn = exr_job_write;
    exr_context_t exr = NULL;
    memory_begin();
    exr_result_t status = exr_start_write(&exr, name, EXR_WRITE_FILE_DIRECTLY, &setup);
    int32_t lines = 0;
    float *values = NULL;
    if (status == EXR_ERR_SUCCESS) status = exr_describe(exr, image, how, planes, count);
    if (status == EXR_ERR_SUCCESS) status = exr_get_scanlines_per_chunk(exr, 0, &lines);
    if (status == EXR_ERR_SUCCESS) {
        values = alloc_array((size_t)image->width * (size_t)count * (size_t)lines, sizeof(float));
        status = values ? exr_encode(exr, image, planes, count, values, lines) : EXR_ERR_OUT_OF_MEMORY;
    }
    free(values);
    if (exr) {
        exr_result_t finished = exr_finish(&exr); /* writes the table of chunks */
        if (status == EXR_ERR_SUCCESS) status = finished;
    }
    if (ferror(stream)) return fail(error, WEFT_MESSAGE_FILE_WRITE, name, "%s", stream_reason(stream));
    if (status == EXR_ERR_SUCCESS) return WEFT_OK;
    return fail(error, memory_was_short() ? WEFT_MESSAGE_MEMORY : WEFT_MESSAGE_FILE_WRITE, name, "EXR: %s",
                job.reason[0] ? job.reason : exr_get_default_error_message(status));
}
