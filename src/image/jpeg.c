/* jpeg.c - JPEG through libjpeg */
#include <setjmp.h>
#include <stdio.h>
#include <string.h>

#include <jerror.h>
#include <jpeglib.h>

#include "base/fail.h"
#include "image/codec.h"

/* State that outlives a longjmp, by which libjpeg reports errors. */
typedef struct JpegJob {
    struct jpeg_decompress_struct jpeg;
    struct jpeg_error_mgr errors;
    struct jpeg_progress_mgr progress;
    jmp_buf escape;
    WeftMessage message;
    char reason[JMSG_LENGTH_MAX];
    char warning[JMSG_LENGTH_MAX]; /* the first one */
    int64_t blocks;                /* of 8 x 8 samples, all components */
    WeftImage image;
} JpegJob;

static JpegJob *job_of(j_common_ptr jpeg) { return jpeg->client_data; }

static _Noreturn void jpeg_job_fail(j_common_ptr jpeg) {
    JpegJob *job = job_of(jpeg);
    switch (job->errors.msg_code) {
    case JERR_BAD_PRECISION:
    case JERR_SOF_UNSUPPORTED:
    case JERR_ARITH_NOTIMPL:
    case JERR_CONVERSION_NOTIMPL:
    case JERR_COMPONENT_COUNT: job->message = WEFT_MESSAGE_IMAGE_UNSUPPORTED; break;
    case JERR_OUT_OF_MEMORY: job->message = WEFT_MESSAGE_MEMORY; break;
    default: job->message = WEFT_MESSAGE_IMAGE_DAMAGED; break;
    }
    job->errors.format_message(jpeg, job->reason);
    longjmp(job->escape, 1);
}

static void jpeg_job_message(j_common_ptr jpeg, int level) {
    JpegJob *job = job_of(jpeg);
    if (level >= 0) return; /* a trace */
    if (job->errors.num_warnings++ == 0) job->errors.format_message(jpeg, job->warning);
}

static void jpeg_job_silent(j_common_ptr jpeg) { (void)jpeg; }

static _Noreturn void jpeg_job_refuse(JpegJob *job, WeftMessage message, const char *reason) {
    job->message = message;
    snprintf(job->reason, sizeof job->reason, "%s", reason);
    longjmp(job->escape, 1);
}

/* Refuses files with too many scans. A scan of a few bytes makes the decoder visit every block of its component, so a
 * small file with many scans can take hours. Useful files have about ten (libjpeg's progressive script: 10 for
 * colour). */
static void jpeg_job_progress(j_common_ptr jpeg) {
    const int64_t scans_max = 100, visits_max = (int64_t)1 << 28;
    JpegJob *job = job_of(jpeg);
    int64_t scans = job->jpeg.input_scan_number;
    if (scans > scans_max || scans * job->blocks > visits_max + job->blocks)
        jpeg_job_refuse(job, WEFT_MESSAGE_IMAGE_UNSUPPORTED, "a progressive JPEG of too many scans");
}

static int64_t block_count(const struct jpeg_decompress_struct *jpeg) {
    int64_t blocks = 0;
    for (int c = 0; c < jpeg->num_components; c++)
        blocks += (int64_t)jpeg->comp_info[c].width_in_blocks * jpeg->comp_info[c].height_in_blocks;
    return blocks;
}

/* Converts CMYK to RGB, white times the transmittances of a colour ink and of black. Adobe's files contain 255 - ink,
 * others ink. */
static void cmyk_to_rgb(const JSAMPLE *cmyk, unsigned char *rgb, size_t count, int inverted) {
    for (size_t i = 0; i < count; i++, cmyk += 4, rgb += 3)
        for (int c = 0; c < 3; c++) {
            unsigned paper = inverted ? cmyk[c] : 255u - cmyk[c], black = inverted ? cmyk[3] : 255u - cmyk[3];
            rgb[c] = (unsigned char)((paper * black + 127) / 255);
        }
}

static WeftResult jpeg_decode(JpegJob *job, const ImageSource *source, WeftError *error) {
    struct jpeg_decompress_struct *jpeg = &job->jpeg;
    jpeg_create_decompress(jpeg);
    jpeg->progress = &job->progress;
    jpeg_mem_src(jpeg, source->data, (unsigned long)source->size);
    jpeg_read_header(jpeg, TRUE);
    if (jpeg->arith_code) jpeg_job_refuse(job, WEFT_MESSAGE_IMAGE_UNSUPPORTED, "arithmetic coding");

    /* A block takes at least one bit, the Huffman code of its DC difference. Several scans need all coefficients in
     * memory, 128 bytes a block. */
    job->blocks = block_count(jpeg);
    WeftResult result = image_reachable(source, job->blocks / 8, error);
    if (result != WEFT_OK) return result;
    const int grey = jpeg->num_components == 1, four = jpeg->num_components == 4;
    const int64_t pixels = (int64_t)jpeg->image_width * jpeg->image_height;
    const int64_t coefficients = jpeg_has_multiple_scans(jpeg) ? job->blocks * 128 / pixels : 0;
    result = image_check_header(source, jpeg->image_width, jpeg->image_height, coefficients + 3, error);
    if (result != WEFT_OK) return result;

    jpeg->out_color_space = grey ? JCS_GRAYSCALE : four ? JCS_CMYK : JCS_RGB;
    jpeg_start_decompress(jpeg);
    result = weft_image_create((int)jpeg->output_width, (int)jpeg->output_height, grey ? 1 : 3, WEFT_PIXEL_U8,
                               &job->image, error);
    if (result != WEFT_OK) return result;

    const size_t width = jpeg->output_width, stride = width * (size_t)job->image.channels;
    JSAMPARRAY line = NULL;
    if (four) line = jpeg->mem->alloc_sarray((j_common_ptr)jpeg, JPOOL_IMAGE, jpeg->output_width * 4, 1);
    while (jpeg->output_scanline < jpeg->output_height) {
        unsigned char *to = (unsigned char *)job->image.pixels + jpeg->output_scanline * stride;
        JSAMPROW direct = to;
        jpeg_read_scanlines(jpeg, four ? line : &direct, 1);
        if (four) cmyk_to_rgb(line[0], to, width, jpeg->saw_Adobe_marker);
    }
    jpeg_finish_decompress(jpeg);
    return WEFT_OK;
}

/* Decodes, or fails after a longjmp. It is separate from its caller, whose variables then stay well defined. */
static WeftResult jpeg_read_guarded(JpegJob *job, const ImageSource *source, WeftError *error) {
    if (setjmp(job->escape)) return fail(error, job->message, source->name, "JPEG: %s", job->reason);
    return jpeg_decode(job, source, error);
}

WeftResult image_read_jpeg(const ImageSource *source, WeftImage *out, WeftError *error) {
    JpegJob job = {.progress = {.progress_monitor = jpeg_job_progress}};
    job.jpeg.err = jpeg_std_error(&job.errors);
    job.jpeg.client_data = &job;
    job.errors.error_exit = jpeg_job_fail;
    job.errors.emit_message = jpeg_job_message;
    job.errors.output_message = jpeg_job_silent;
    WeftResult result = jpeg_read_guarded(&job, source, error);
    jpeg_destroy_decompress(&job.jpeg);
    if (result != WEFT_OK) {
        weft_image_free(&job.image);
        return result;
    }
    if (job.errors.num_warnings) warn(source->log, WEFT_MESSAGE_IMAGE_REPAIRED, source->name, "JPEG: %s", job.warning);
    *out = job.image;
    return WEFT_OK;
}
