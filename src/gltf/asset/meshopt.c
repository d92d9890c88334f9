#include "gltf/asset/meshopt.h"

#include <meshoptimizer.h>

const char *meshopt_reason(const Compression *c, size_t size) {
    if (c->stride == 0 || c->count != size / c->stride || size % c->stride)
        return "count times byteStride is not the view's byteLength";
    if (c->mode == MODE_ATTRIBUTES ? c->stride % 4 || c->stride > 256 : c->stride != 2 && c->stride != 4)
        return "byteStride does not suit the mode";
    if (c->mode == MODE_TRIANGLES && c->count % 3) return "count is not a multiple of 3";
    if (c->filter != FILTER_NONE && c->mode != MODE_ATTRIBUTES) return "only attributes can have a filter";
    if ((c->filter == FILTER_OCTAHEDRAL && c->stride != 4 && c->stride != 8) ||
        (c->filter == FILTER_QUATERNION && c->stride != 8))
        return "byteStride does not suit the filter";
    return NULL;
}

bool meshopt_decode(const Compression *c, unsigned char *out) {
    if (!c->source.data) return false;
    int failed = 1;
    switch (c->mode) {
    case MODE_ATTRIBUTES:
        failed = meshopt_decodeVertexBuffer(out, c->count, c->stride, c->source.data, c->source.size);
        break;
    case MODE_TRIANGLES:
        failed = meshopt_decodeIndexBuffer(out, c->count, c->stride, c->source.data, c->source.size);
        break;
    case MODE_INDICES:
        failed = meshopt_decodeIndexSequence(out, c->count, c->stride, c->source.data, c->source.size);
        break;
    }
    if (failed) return false;
    switch (c->filter) {
    case FILTER_NONE: break;
    case FILTER_OCTAHEDRAL: meshopt_decodeFilterOct(out, c->count, c->stride); break;
    case FILTER_QUATERNION: meshopt_decodeFilterQuat(out, c->count, c->stride); break;
    case FILTER_EXPONENTIAL: meshopt_decodeFilterExp(out, c->count, c->stride); break;
    }
    return true;
}
