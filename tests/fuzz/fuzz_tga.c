/* fuzz_tga - the TGA reader: all types, maps, packets, origins, lying headers
 *
 * Any input must be read or refused with one line; sanitizers watch the rest. */
#include "image_input.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) { return image_input(image_read_tga, data, size); }
