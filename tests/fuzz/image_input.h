/* image_input.h - what the image fuzz targets do with an input: read it, look at the outcome, release it */
#ifndef WEFT_TESTS_FUZZ_IMAGE_INPUT_H
#define WEFT_TESTS_FUZZ_IMAGE_INPUT_H

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "image/codec.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static int image_input(WeftResult (*read)(const ImageSource *, WeftImage *, WeftError *), const uint8_t *data,
                       size_t size) {
    const ImageSource source = {.data = data, .size = size, .name = "input"};
    WeftImage image = {0};
    WeftError error = {0};
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
    weft_image_free(&image);
    return 0;
}

#endif
