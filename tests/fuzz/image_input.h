/* image_input.h - what the image fuzz targets do with an input: read it, look at the outcome, release it */
#ifndef WEFT_TESTS_FUZZ_IMAGE_INPUT_H
#define WEFT_TESTS_FUZZ_IMAGE_INPUT_H

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "image/codec.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* Warnings while the last input was read. */
static int image_warnings;

static void image_warned(void *user, WeftMessage message, const char *text) {
    (void)user;
    (void)message;
    if (!text[0] || strchr(text, '\n')) abort();
    image_warnings++;
}

/* Reads an input. `understood`, which may be NULL, tells of one that was read without a word whether it holds nothing
 * else than what the reader knows. */
static int image_input_understood(WeftResult (*read)(const ImageSource *, WeftImage *, WeftError *),
                                  bool (*understood)(const WeftImage *, const uint8_t *, size_t), const uint8_t *data,
                                  size_t size) {
    const WeftLog log = {.fn = image_warned};
    const ImageSource source = {.data = data, .size = size, .name = "input", .log = &log};
    WeftImage image = {0};
    WeftError error = {0};
    image_warnings = 0;
    WeftResult result = read(&source, &image, &error);
    if (result != WEFT_OK) {
        if (image.pixels || !error.text[0] || strchr(error.text, '\n') || error.result != result) abort();
        return 0;
    }
    if (image.type == WEFT_PIXEL_F32) {
        const float *values = image.pixels;
        const size_t count = (size_t)image.width * (size_t)image.height * (size_t)image.channels;
        for (size_t i = 0; i < count; i++)
            if (!isfinite(values[i])) abort();
    }
    if (understood && !image_warnings && !understood(&image, data, size)) abort();
    weft_image_free(&image);
    return 0;
}

static inline int image_input(WeftResult (*read)(const ImageSource *, WeftImage *, WeftError *), const uint8_t *data,
                              size_t size) {
    return image_input_understood(read, NULL, data, size);
}

#endif
