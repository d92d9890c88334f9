/* draft_picture.c - a picture of two colours as a draft, one pixel a crossing, as for jacquard looms */
#include <stdint.h>
#include <string.h>

#include "base/equal.h"
#include "base/fail.h"
#include "weave/weave_draft.h"
#include "weft/image.h"

static size_t pixel_size(const WeftImage *image) {
    static const size_t sizes[] = {[WEFT_PIXEL_U8] = 1, [WEFT_PIXEL_U16] = 2, [WEFT_PIXEL_F32] = 4};
    return sizes[image->type] * (size_t)image->channels;
}

static float value_at(const WeftImage *image, size_t k) {
    if (image->type == WEFT_PIXEL_U8) return ((const uint8_t *)image->pixels)[k];
    if (image->type == WEFT_PIXEL_U16) return ((const uint16_t *)image->pixels)[k];
    return ((const float *)image->pixels)[k];
}

/* Returns the sum of a pixel's colours, without alpha. */
static float brightness(const WeftImage *image, size_t pixel) {
    const int colors = image->channels < 3 ? 1 : 3;
    float sum = 0.0f;
    for (int c = 0; c < colors; c++) sum += value_at(image, pixel * (size_t)image->channels + (size_t)c);
    return sum;
}

/* Returns the first pixel that differs from pixel 0, or 0 if none does; *third is the first that differs from both, 0
 * without one. */
static size_t second_color(const WeftImage *image, size_t pixels, size_t *third) {
    const char *bytes = image->pixels;
    const size_t size = pixel_size(image);
    size_t second = 0;
    *third = 0;
    for (size_t k = 1; k < pixels && !*third; k++) {
        if (memcmp(bytes + k * size, bytes, size) == 0) continue;
        if (!second)
            second = k;
        else if (memcmp(bytes + k * size, bytes + second * size, size) != 0)
            *third = k;
    }
    return second;
}

/* Makes the draft; the warp is on top at the darker colour. */
static WeftResult from_image(const char *path, const WeftImage *image, WeftDraft **out, WeftError *error) {
    const size_t pixels = (size_t)image->width * (size_t)image->height;
    size_t third, second = second_color(image, pixels, &third);
    if (third)
        return fail(error, WEFT_MESSAGE_DRAFT, path,
                    "it has more than two colours, the third at pixel %zu, %zu; a draft has one for warp on "
                    "top and one for weft",
                    third % (size_t)image->width, third / (size_t)image->width);
    WeftResult result = draft_create(path, image->width, image->height, WEFT_MESSAGE_DRAFT, out, error);
    if (result != WEFT_OK) return result;
    const float first = brightness(image, 0), other = brightness(image, second);
    if (second && is_equal(first, other)) {
        weft_draft_free(*out);
        *out = NULL;
        return fail(error, WEFT_MESSAGE_DRAFT, path, "its two colours are equally bright");
    }
    const float limit = second ? 0.5f * (first + other) : 0.0f;
    for (size_t k = 0; k < pixels; k++) {
        const size_t row = (size_t)image->height - 1 - k / (size_t)image->width, column = k % (size_t)image->width;
        (*out)->up[row * (size_t)image->width + column] = brightness(image, k) <= limit;
    }
    return WEFT_OK;
}

/* Returns the end of the message about a picture that cannot be read: ": it is WebP", or "" for an unknown format. */
static const char *format_suffix(const WeftError *error) {
    const char *text = weft_message_text(WEFT_MESSAGE_IMAGE_FORMAT), *at = strstr(error->text, text);
    return at ? at + strlen(text) : "";
}

WeftResult draft_from_picture(const char *path, bool text, WeftDraft **out, const WeftLog *log, WeftError *error) {
    WeftImage image;
    WeftError why;
    WeftResult result = weft_image_read(path, &image, log, &why);
    if (result != WEFT_OK && why.message == WEFT_MESSAGE_IMAGE_FORMAT)
        return fail(error, WEFT_MESSAGE_DRAFT, path, "%s%s",
                    text ? "it is text that does not begin with [WIF]" : "it is neither a WIF nor a picture",
                    format_suffix(&why));
    if (result != WEFT_OK && error) *error = why;
    if (result != WEFT_OK) return result;
    result = from_image(path, &image, out, error);
    weft_image_free(&image);
    return result;
}
