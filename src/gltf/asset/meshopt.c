#include "gltf/asset/meshopt.h"

#include <math.h>
#include <meshoptimizer.h>

#include "base/little_endian.h"
#include "gltf/asset/vertex_codec.h"

const char *meshopt_reason(const Compression *c, size_t size) {
    if (c->stride == 0 || c->count != size / c->stride || size % c->stride)
        return "count times byteStride is not the view's byteLength";
    if (c->mode == MODE_ATTRIBUTES ? c->stride % 4 || c->stride > 256 : c->stride != 2 && c->stride != 4)
        return "byteStride does not suit the mode";
    if (c->mode == MODE_TRIANGLES && c->count % 3) return "count is not a multiple of 3";
    if (c->filter != FILTER_NONE && c->mode != MODE_ATTRIBUTES) return "only attributes can have a filter";
    if (((c->filter == FILTER_OCTAHEDRAL || c->filter == FILTER_COLOR) && c->stride != 4 && c->stride != 8) ||
        (c->filter == FILTER_QUATERNION && c->stride != 8))
        return "byteStride does not suit the filter";
    return NULL;
}

/* Turns Y, Co, Cg and an alpha, whose highest bit tells how many bits all have, into colours: appendix B, filter 4, of
 * the text of KHR_meshopt_compression. */
static void color_unfilter(unsigned char *bytes, size_t count, size_t stride) {
    const size_t width = stride / 4;
    const float most = width == 1 ? 255.0f : 65535.0f;
    for (size_t i = 0; i < count; i++, bytes += stride) {
        int in[4];
        for (size_t c = 0; c < 4; c++) {
            const bool chroma = c == 1 || c == 2;
            const int value = (int)little_endian(bytes + c * width, width), half = width == 1 ? 0x80 : 0x8000;
            in[c] = chroma && value >= half ? value - 2 * half : value;
        }
        int all = in[3]; /* as many ones as a colour has bits */
        for (int shift = 1; shift < 16; shift *= 2) all |= all >> shift;
        const int alpha = in[3] & all >> 1;
        const int out[4] = {in[0] + in[1] - in[2], in[0] + in[2], in[0] - in[1] - in[2], alpha << 1 | (alpha & 1)};
        for (size_t c = 0; c < 4; c++) {
            const float value = all ? (float)out[c] * (most / (float)all) + 0.5f : 0.0f;
            const unsigned number = (unsigned)(value > 0.0f ? fminf(value, most) : 0.0f);
            bytes[c * width] = (unsigned char)(number & 255);
            if (width == 2) bytes[c * width + 1] = (unsigned char)(number >> 8);
        }
    }
}

/* Decodes vertices of either version of the codec. Returns false if they are damaged. */
static bool vertices_decode(const Compression *c, unsigned char *out) {
    if (c->source.size && c->source.data[0] == VERTEX_CODEC_1)
        return vertex_decode(c->source.data, c->source.size, c->count, c->stride, out);
    return meshopt_decodeVertexBuffer(out, c->count, c->stride, c->source.data, c->source.size) == 0;
}

const char *meshopt_decode(const Compression *c, unsigned char *out) {
    if (!c->source.data) return "its buffer has no data";
    int failed = 1;
    switch (c->mode) {
    case MODE_ATTRIBUTES: failed = !vertices_decode(c, out); break;
    case MODE_TRIANGLES:
        failed = meshopt_decodeIndexBuffer(out, c->count, c->stride, c->source.data, c->source.size);
        break;
    case MODE_INDICES:
        failed = meshopt_decodeIndexSequence(out, c->count, c->stride, c->source.data, c->source.size);
        break;
    }
    if (failed) return "damaged data";
    switch (c->filter) {
    case FILTER_NONE: break;
    case FILTER_OCTAHEDRAL: meshopt_decodeFilterOct(out, c->count, c->stride); break;
    case FILTER_QUATERNION: meshopt_decodeFilterQuat(out, c->count, c->stride); break;
    case FILTER_EXPONENTIAL: meshopt_decodeFilterExp(out, c->count, c->stride); break;
    case FILTER_COLOR: color_unfilter(out, c->count, c->stride); break;
    }
    return NULL;
}
