/* fuzz_tiff - the TIFF reader: libtiff behind our checks
 *
 * Any input must be read or refused with one line; sanitizers watch the rest. */
#include "image_input.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) { return image_input(image_read_tiff, data, size); }
