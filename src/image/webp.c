/* webp.c - WebP through libwebp: lossy and lossless, with and without alpha
 *
 * Specification: Google, "WebP Container Specification", 2010. */
#include <webp/decode.h>

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

WeftResult image_read_webp(const ImageSource *source, WeftImage *out, WeftError *error) {
    WebPDecoderConfig config;
    if (!WebPInitDecoderConfig(&config)) return webp_fail(source, VP8_STATUS_UNSUPPORTED_FEATURE, error);
    const VP8StatusCode known = WebPGetFeatures(source->data, source->size, &config.input);
    if (known != VP8_STATUS_OK) return webp_fail(source, known, error);
    if (config.input.has_animation)
        return fail(error, WEFT_MESSAGE_IMAGE_UNSUPPORTED, source->name,
                    "WebP: an animation; save one of its frames as a picture of its own");
    const int channels = config.input.has_alpha ? 4 : 3;
    /* The library holds a second copy of the pixels while it decodes. */
    WeftResult result = image_check_header(source, config.input.width, config.input.height, channels + 4, error);
    if (result != WEFT_OK) return result;
    WeftImage image;
    result = weft_image_create(config.input.width, config.input.height, channels, WEFT_PIXEL_U8, &image, error);
    if (result != WEFT_OK) return result;
    config.output.colorspace = channels == 4 ? MODE_RGBA : MODE_RGB;
    config.output.is_external_memory = 1;
    config.output.u.RGBA.rgba = image.pixels;
    config.output.u.RGBA.stride = image.width * channels;
    config.output.u.RGBA.size = (size_t)image.width * (size_t)image.height * (size_t)channels;
    const VP8StatusCode status = WebPDecode(source->data, source->size, &config);
    WebPFreeDecBuffer(&config.output);
    if (status != VP8_STATUS_OK) {
        weft_image_free(&image);
        return webp_fail(source, status, error);
    }
    *out = image;
    return WEFT_OK;
}
