/* fuzz_exr - the OpenEXR reader: OpenEXRCore behind our checks, windows, tiles, channels, every compression
 *
 * Any input must be read or refused with one line; sanitizers watch the rest. */
#include "image_input.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) { return image_input(image_read_exr, data, size); }
