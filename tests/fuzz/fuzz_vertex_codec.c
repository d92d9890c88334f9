/* fuzz_vertex_codec - version 1 of meshoptimizer's vertex codec: the first two bytes choose stride and count
 *
 * Any input must be decoded or refused, without a byte that is read or written beyond. */
#include <stdint.h>
#include <stdlib.h>

#include "gltf/asset/vertex_codec.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    if (size < 2) return 0;
    const size_t stride = 4 * (1 + (size_t)(data[0] & 63)), count = 3 * (size_t)data[1];
    unsigned char *out = malloc(stride * count + 1);
    if (!out) abort();
    vertex_decode(data + 2, size - 2, count, stride, out);
    free(out);
    return 0;
}
