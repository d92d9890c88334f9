/* png.c - PNG through libpng */
#include <png.h>
#include <setjmp.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "base/fail.h"
#include "base/memory.h"
#include "base/stream_reason.h"
#include "image/codec.h"

/* State that outlives a longjmp, by which libpng reports errors. */
typedef struct PngJob {
    jmp_buf escape;
    char reason[160];
    const ImageSource *source;    /* when reading */
    size_t position;              /* when reading */
    bool denoised;                /* when reading: the file has a chunk of denoised_key */
    bool data;                    /* when writing: data, not a picture */
    char *comment, *how_denoised; /* when writing: texts, or NULL */
} PngJob;

/* The keyword of the text chunk with the denoiser of a picture. */
static char denoised_key[] = "Denoised";

static _Noreturn void png_job_fail(png_structp png, png_const_charp reason) {
    PngJob *job = png_get_error_ptr(png);
    snprintf(job->reason, sizeof job->reason, "%s", reason);
    longjmp(job->escape, 1);
}

static void png_job_warn(png_structp png, png_const_charp reason) {
    (void)png;
    (void)reason;
}

static void png_job_read(png_structp png, png_bytep to, size_t size) {
    PngJob *job = png_get_io_ptr(png);
    if (size > job->source->size - job->position) png_error(png, "it ends early");
    memcpy(to, job->source->data + job->position, size);
    job->position += size;
}

/* Reads the keyword of a text chunk, which libpng does not parse. */
static int png_job_chunk(png_structp png, png_unknown_chunkp chunk) {
    PngJob *job = png_get_user_chunk_ptr(png);
    if (memcmp(chunk->name, "tEXt", 4) == 0 && chunk->size >= sizeof denoised_key)
        job->denoised |= memcmp(chunk->data, denoised_key, sizeof denoised_key) == 0;
    return 1;
}

/* Makes libpng parse only chunks that change pixels. Others are skipped, except that the keyword of texts is read. */
static void skip_ancillary(png_structp png, PngJob *job) {
    static const char skipped[] = "bKGD\0cHRM\0cICP\0eXIf\0gAMA\0hIST\0iCCP\0iTXt\0oFFs\0pCAL\0pHYs\0sBIT\0sCAL\0"
                                  "sPLT\0sRGB\0sTER\0tIME\0zTXt";
    png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_NEVER, NULL, 0);
    png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_NEVER, (png_const_bytep)skipped, sizeof skipped / 5);
    png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_ALWAYS, (png_const_bytep) "tEXt", 1);
    png_set_read_user_chunk_fn(png, job, png_job_chunk);
}

/* Decodes the file; all calls of libpng that may longjmp are here. */
static WeftResult png_decode(png_structp png, png_infop info, PngJob *job, WeftImage *out, WeftError *error) {
    const ImageSource *source = job->source;
    skip_ancillary(png, job);
    png_set_user_limits(png, IMAGE_SIDE_MAX, IMAGE_SIDE_MAX);
    png_read_info(png, info);
    const int64_t width = png_get_image_width(png, info), height = png_get_image_height(png, info);
    /* Deflate's shortest code for its longest match: 258 bytes from 2 bits. */
    const int64_t deflate = 1032;
    WeftResult result = image_reachable(source, (int64_t)png_get_rowbytes(png, info) * height / deflate, error);
    if (result != WEFT_OK) return result;

    png_set_expand(png); /* palette to RGB, 1 2 4 bits to 8, tRNS to alpha */
    if (png_get_bit_depth(png, info) == 16 && __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__) png_set_swap(png);
    const int passes = png_set_interlace_handling(png);
    png_read_update_info(png, info);
    const int deep = png_get_bit_depth(png, info) == 16, channels = png_get_channels(png, info);
    result = image_check_header(source, width, height, channels * (deep ? 2 : 1), error);
    if (result != WEFT_OK) return result;
    result = weft_image_create((int)width, (int)height, channels, deep ? WEFT_PIXEL_U16 : WEFT_PIXEL_U8, out, error);
    if (result != WEFT_OK) return result;

    const size_t stride = png_get_rowbytes(png, info);
    for (int pass = 0; pass < passes; pass++)
        for (size_t y = 0; y < (size_t)height; y++) png_read_row(png, (png_bytep)out->pixels + y * stride, NULL);
    png_read_end(png, NULL);
    return WEFT_OK;
}

/* Decodes, or fails after a longjmp. It is separate from its caller, whose variables then stay well defined. */
static WeftResult png_read_guarded(PngJob *job, png_structp png, png_infop info, WeftImage *out, WeftError *error) {
    if (setjmp(job->escape))
        return fail(error, memory_was_short() ? WEFT_MESSAGE_MEMORY : WEFT_MESSAGE_IMAGE_DAMAGED, job->source->name,
                    "PNG: %s", job->reason);
    memory_begin();
    png_set_read_fn(png, job, png_job_read);
    return png_decode(png, info, job, out, error);
}

WeftResult image_read_png(const ImageSource *source, WeftImage *out, WeftError *error) {
    PngJob job = {.source = source};
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &job, png_job_fail, png_job_warn);
    png_infop info = png ? png_create_info_struct(png) : NULL;
    WeftResult result =
        info ? png_read_guarded(&job, png, info, out, error) : fail(error, WEFT_MESSAGE_MEMORY, source->name, NULL);
    png_destroy_read_struct(&png, &info, NULL);
    if (result != WEFT_OK) weft_image_free(out);
    if (result == WEFT_OK && job.denoised) warn(source->log, WEFT_MESSAGE_IMAGE_DENOISED, source->name, NULL);
    return result;
}

/* Writes a text chunk, unless `words` is NULL. The format defines it as Latin-1, so readers may misread other
 * characters than ASCII. The library copies both strings. */
static void write_text(png_structp png, png_infop info, char *keyword, char *words) {
    if (!words) return;
    const png_text text = {
        .compression = PNG_TEXT_COMPRESSION_NONE, .key = keyword, .text = words, .text_length = strlen(words)};
    png_set_text(png, info, &text, 1);
}

static void png_encode(png_structp png, png_infop info, const WeftImage *image, const PngJob *job) {
    static char comment_key[] = "Comment";
    static const int color_types[] = {0, PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA, PNG_COLOR_TYPE_RGB,
                                      PNG_COLOR_TYPE_RGB_ALPHA};
    const int deep = image->type == WEFT_PIXEL_U16;
    png_set_IHDR(png, info, (png_uint_32)image->width, (png_uint_32)image->height, deep ? 16 : 8,
                 color_types[image->channels], PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    if (!job->data) png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
    write_text(png, info, comment_key, job->comment);
    write_text(png, info, denoised_key, job->how_denoised);
    png_set_compression_level(png, 3); /* a third of the time of the default, files a fifth longer */
    png_write_info(png, info);
    if (deep && __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__) png_set_swap(png);
    const size_t stride = (size_t)image->width * (size_t)image->channels * (deep ? 2 : 1);
    for (size_t y = 0; y < (size_t)image->height; y++) png_write_row(png, (png_const_bytep)image->pixels + y * stride);
    png_write_end(png, info);
}

static WeftResult png_write_guarded(PngJob *job, png_structp png, png_infop info, FILE *stream, const char *name,
                                    const WeftImage *image, WeftError *error) {
    if (setjmp(job->escape))
        return ferror(stream) ? fail(error, WEFT_MESSAGE_FILE_WRITE, name, "%s", stream_reason(stream))
                              : fail(error, WEFT_MESSAGE_FILE_WRITE, name, "PNG: %s", job->reason);
    png_init_io(png, stream);
    png_encode(png, info, image, job);
    return WEFT_OK;
}

WeftResult image_write_png(FILE *stream, const char *name, const WeftImage *image, const WeftImageWriting *how,
                           WeftError *error) {
    PngJob job = {.data = how->data != 0,
                  .comment = how->comment ? strdup(how->comment) : NULL,
                  .how_denoised = how->denoised ? strdup(how->denoised) : NULL};
    const bool copied = !how->comment == !job.comment && !how->denoised == !job.how_denoised;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &job, png_job_fail, png_job_warn);
    png_infop info = png ? png_create_info_struct(png) : NULL;
    WeftResult result = info && copied ? png_write_guarded(&job, png, info, stream, name, image, error)
                                       : fail(error, WEFT_MESSAGE_MEMORY, name, NULL);
    png_destroy_write_struct(&png, &info);
    free(job.comment);
    free(job.how_denoised);
    return result;
}
