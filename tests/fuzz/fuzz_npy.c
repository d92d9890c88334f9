/* fuzz_npy - the NumPy reader: the dictionary of its header, types, byte orders and both orders of indices
 *
 * Any input must be read or refused with one line; sanitizers watch the rest. */
#include "image_input.h"

/* As the caller of the reader does, only what has the signature is handed over. */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    if (size < 6 || memcmp(data, "\x93NUMPY", 6) != 0) return 0;
    return image_input(image_read_npy, data, size);
}
