/* fuzz_hdr - the Radiance HDR reader: header lines, orientations, both run-length codes
 *
 * Any input must be read or refused with one line; sanitizers watch the rest. A header that is read without a word
 * asks for no gamma and no other shape of pixels. */
#include "image_input.h"

#include <stdio.h>

/* Returns true unless a line of the header is KEY=NUMBER with a number that is not about 1. */
static bool is_one(const char *line, const char *key) {
    const size_t length = strlen(key);
    return strncmp(line, key, length) != 0 || fabs(strtod(line + length, NULL) - 1.0) < 0.021;
}

static bool understood(const WeftImage *image, const uint8_t *data, size_t size) {
    bool all = true;
    (void)image;
    /* A line that is empty or begins with 0 is the last. */
    for (size_t at = 0; at < size && !strchr("\n\r", data[at]);) {
        char line[64];
        const uint8_t *end = memchr(data + at, '\n', size - at);
        if (!end) break;
        const size_t length = (size_t)(end - data) - at;
        snprintf(line, sizeof line, "%.*s", (int)(length < sizeof line ? length : sizeof line - 1),
                 (const char *)data + at);
        all &= is_one(line, "GAMMA=") && is_one(line, "PIXASPECT=");
        at += length + 1;
    }
    return all;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    return image_input_understood(image_read_hdr, understood, data, size);
}
