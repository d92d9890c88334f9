/* fuzz_exr_channels - named channels of an OpenEXR file and its comment, as weft merge reads parts of a picture
 *
 * Any input must be read or refused with one line, and a comment ends with a zero. */
#include "image_input.h"

static WeftResult read_part(const ImageSource *source, WeftImage *out, WeftError *error) {
    static const char *const channels[] = {"R", "G", "B", "A"};
    char *comment = NULL;
    WeftResult result = image_read_exr_channels(source, channels, 1 + (int)(source->size % 4), out, &comment, error);
    if (result != WEFT_OK && comment) abort();
    if (comment && strlen(comment) > source->size) abort();
    free(comment);
    if (result != WEFT_OK) return result;
    float *values = out->pixels; /* that they are finite is for weft merge to check */
    const size_t count = (size_t)out->width * (size_t)out->height * (size_t)out->channels;
    for (size_t k = 0; k < count; k++)
        if (!isfinite(values[k])) values[k] = 0.0f;
    return WEFT_OK;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) { return image_input(read_part, data, size); }
