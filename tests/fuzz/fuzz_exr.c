/* fuzz_exr - the OpenEXR reader: the library behind our checks, windows, tiles, channels, every compression
 *
 * Any input must be read or refused with one line; sanitizers watch the rest. What is read without a word has the
 * channels of a picture: R G B, or Y. */
#include "image_input.h"

/* Returns true if the bytes have a channel of that name, with the zero behind it. */
static bool has_channel(const uint8_t *data, size_t size, char name) {
    for (size_t k = 0; k + 1 < size; k++)
        if (data[k] == (uint8_t)name && data[k + 1] == 0) return true;
    return false;
}

static bool understood(const WeftImage *image, const uint8_t *data, size_t size) {
    const char *names = image->channels < 3 ? "Y" : "RGB";
    bool all = true;
    for (; *names; names++) all &= has_channel(data, size, *names);
    return all;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    return image_input_understood(image_read_exr, understood, data, size);
}
