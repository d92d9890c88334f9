/* webp.c - WebP through libwebp: lossy and lossless, with and without alpha, and the first picture of an animation
 *
 * Specification: Google, "WebP Container Specification", 2010. */
#include <string.h>

#include <webp/decode.h>
#include <webp/demux.h>

#include "base/fail.h"
#include "image/codec.h"

static WeftResult webp_fail(const ImageSource *source, VP8StatusCode status, WeftError *error) {
    switch (status) {
    case VP8_STATUS_OUT_OF_MEMORY: return fail(error, WEFT_MESSAGE_MEMORY, source->name, NULL);
    case VP8_STATUS_UNSUPPORTED_FEATURE:
        return fail(error, WEFT_MESSAGE_IMAGE_UNSUPPORTED, source->name, "WebP: a feature that libwebp lacks");
    case VP8_STATUS_NOT_ENOUGH_DATA:
    case VP8_STATUS_SUSPENDED: return fail(error, WEFT_MESSAGE_IMAGE_DAMAGED, source->name, "WebP: it ends early");
    default: return fail(error, WEFT_MESSAGE_IMAGE_DAMAGED, source->name, "WebP: its data are damaged");
    }
}

static size_t pixel_bytes(const WeftImage *image) {
    return (size_t)image->width * (size_t)image->height * (size_t)image->channels;
}

static VP8StatusCode still_decode(const ImageSource *source, WebPDecoderConfig *config, WeftImage *image) {
    config->output.colorspace = image->channels == 4 ? MODE_RGBA : MODE_RGB;
    config->output.is_external_memory = 1;
    config->output.u.RGBA.rgba = image->pixels;
    config->output.u.RGBA.stride = image->width * image->channels;
    config->output.u.RGBA.size = pixel_bytes(image);
    const VP8StatusCode status = WebPDecode(source->data, source->size, config);
    WebPFreeDecBuffer(&config->output);
    return status;
}

/* Decodes the first picture of an animation, on its canvas. */
static VP8StatusCode first_decode(const ImageSource *source, WeftImage *image) {
    const WebPData data = {source->data, source->size};
    WebPDemuxState state;
    WebPDemuxDelete(WebPDemuxPartial(&data, &state));
    if (state == WEBP_DEMUX_PARSING_HEADER || state == WEBP_DEMUX_PARSED_HEADER) return VP8_STATUS_NOT_ENOUGH_DATA;
    if (state == WEBP_DEMUX_PARSE_ERROR) return VP8_STATUS_BITSTREAM_ERROR;
    WebPAnimDecoder *decoder = WebPAnimDecoderNew(&data, NULL);
    if (!decoder) return VP8_STATUS_OUT_OF_MEMORY;
    uint8_t *canvas;
    int time;
    const bool decoded = WebPAnimDecoderGetNext(decoder, &canvas, &time);
    if (decoded) memcpy(image->pixels, canvas, pixel_bytes(image));
    WebPAnimDecoderDelete(decoder);
    return decoded ? VP8_STATUS_OK : VP8_STATUS_BITSTREAM_ERROR;
}

WeftResult image_read_webp(const ImageSource *source, WeftImage *out, WeftError *error) {
    WebPDecoderConfig config;
    if (!WebPInitDecoderConfig(&config)) return webp_fail(source, VP8_STATUS_UNSUPPORTED_FEATURE, error);
    const VP8StatusCode known = WebPGetFeatures(source->data, source->size, &config.input);
    if (known != VP8_STATUS_OK) return webp_fail(source, known, error);
    const bool moves = config.input.has_animation != 0;
    const int channels = config.input.has_alpha || moves ? 4 : 3;
    /* The library holds a second copy of the pixels while it decodes, and two canvases of an animation. */
    const int held = moves ? 12 : 4;
    WeftResult result = image_check_header(source, config.input.width, config.input.height, channels + held, error);
    if (result != WEFT_OK) return result;
    WeftImage image;
    result = weft_image_create(config.input.width, config.input.height, channels, WEFT_PIXEL_U8, &image, error);
    if (result != WEFT_OK) return result;
    const VP8StatusCode status = moves ? first_decode(source, &image) : still_decode(source, &config, &image);
    if (status != VP8_STATUS_OK) {
        weft_image_free(&image);
        return webp_fail(source, status, error);
    }
    if (moves)
        warn(source->log, WEFT_MESSAGE_IMAGE_REPAIRED, source->name,
             "WebP: it shows the first picture of its animation");
    *out = image;
    return WEFT_OK;
}
