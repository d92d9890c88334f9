/* fuzz_webp - the WebP reader: lossy, lossless, alpha, chunks out of place, damaged data
 *
 * Any input must be read or refused with one line; sanitizers watch the rest. */
#include "image_input.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) { return image_input(image_read_webp, data, size); }
