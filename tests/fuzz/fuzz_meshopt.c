/* fuzz_meshopt - the views of KHR_meshopt_compression: each mode and filter, false sizes, damaged data
 *
 * An input begins with its mode and filter, a byte each, and its stride and count, two bytes each. What breaks no rule is
 * decoded into exactly its bytes or refused; sanitizers watch the rest. */
#include <stdlib.h>

#include "gltf/asset/meshopt.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    enum { HEAD = 6, MODES = MODE_INDICES + 1, FILTERS = FILTER_COLOR + 1 };
    if (size < HEAD) return 0;
    Compression view = {.source = {.data = data + HEAD, .size = size - HEAD},
                        .stride = (size_t)data[2] + 256u * data[3],
                        .count = (size_t)data[4] + 256u * data[5],
                        .mode = data[0] % MODES,
                        .filter = data[1] % FILTERS};
    const size_t decoded = view.stride * view.count;
    if (meshopt_reason(&view, decoded)) return 0;
    unsigned char *out = malloc(decoded ? decoded : 1);
    if (!out) abort();
    const char *why = meshopt_decode(&view, out);
    if (why && !why[0]) abort();
    free(out);
    return 0;
}
