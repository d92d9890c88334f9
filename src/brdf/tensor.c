#include "brdf/tensor.h"

#include <stdint.h>
#include <string.h>

#include "base/fail.h"
#include "base/little_endian.h"

static const char magic[12] = "tensor_file";
static const size_t sizes[TENSOR_TYPES] = {0, 1, 1, 2, 2, 4, 4, 8, 8, 2, 4, 8};

/* A header, read up to `at`. */
typedef struct Header {
    const unsigned char *bytes;
    size_t size, at;
    bool ended; /* the header is too short */
} Header;

static uint64_t take(Header *header, size_t count) {
    if (header->size - header->at < count) header->ended = true;
    if (header->ended) return 0;
    header->at += count;
    return little_endian(header->bytes + header->at - count, count);
}

static void take_name(Header *header, size_t length, char name[TENSOR_NAME]) {
    if (header->size - header->at < length || length >= TENSOR_NAME) header->ended = true;
    if (header->ended) return;
    memcpy(name, header->bytes + header->at, length);
    name[length] = '\0';
    header->at += length;
}

/* Sets count to the product of the extents. Returns false if an array of that many numbers would exceed the file. */
static bool count_numbers(Tensor *tensor, uint64_t offset, size_t size) {
    const size_t each = sizes[tensor->type];
    if (offset > size) return false;
    tensor->count = 1;
    for (int k = 0; k < tensor->rank; k++) {
        if (tensor->extent[k] == 0 || tensor->extent[k] > (size - offset) / each / tensor->count) return false;
        tensor->count *= tensor->extent[k];
    }
    return tensor->count <= (size - offset) / each;
}

static WeftResult take_tensor(Header *header, const char *name, Tensor *out, WeftError *error) {
    take_name(header, take(header, 2), out->name);
    uint64_t rank = take(header, 2), type = take(header, 1), offset = take(header, 8);
    if (header->ended)
        return fail(error, WEFT_MESSAGE_BSDF, name, "its list of arrays is cut short or has a long name");
    if (rank < 1 || rank > TENSOR_AXES || type < 1 || type >= TENSOR_TYPES)
        return fail(error, WEFT_MESSAGE_BSDF, name, "\"%s\" has %u axes of type %u", out->name, (unsigned)rank,
                    (unsigned)type);
    out->rank = (int)rank;
    out->type = (TensorType)type;
    for (int k = 0; k < out->rank; k++) out->extent[k] = take(header, 8);
    if (header->ended || !count_numbers(out, offset, header->size))
        return fail(error, WEFT_MESSAGE_BSDF, name, "\"%s\" does not lie within its %zu bytes", out->name,
                    header->size);
    out->data = header->bytes + offset;
    return WEFT_OK;
}

WeftResult tensor_file_read(const unsigned char *bytes, size_t size, const char *name, TensorFile *out,
                            WeftError *error) {
    *out = (TensorFile){.count = 0};
    if (size < sizeof magic || memcmp(bytes, magic, sizeof magic) != 0)
        return fail(error, WEFT_MESSAGE_BSDF, name, "it does not begin with \"%s\"", magic);
    if (size < sizeof magic + 6) return fail(error, WEFT_MESSAGE_BSDF, name, "it is cut short behind \"%s\"", magic);
    Header header = {.bytes = bytes, .size = size, .at = sizeof magic};
    unsigned major = (unsigned)take(&header, 1), minor = (unsigned)take(&header, 1);
    uint64_t count = take(&header, 4);
    if (major != 1 || minor != 0)
        return fail(error, WEFT_MESSAGE_BSDF, name, "it has version %u.%u, not 1.0", major, minor);
    if (count > TENSORS_MOST)
        return fail(error, WEFT_MESSAGE_BSDF, name, "it has %u arrays, and at most %d are read", (unsigned)count,
                    TENSORS_MOST);
    WeftResult result = WEFT_OK;
    for (; out->count < (int)count && result == WEFT_OK; out->count++)
        result = take_tensor(&header, name, &out->tensors[out->count], error);
    return result;
}

const Tensor *tensor_find(const TensorFile *file, const char *name) {
    for (int k = 0; k < file->count; k++)
        if (strcmp(file->tensors[k].name, name) == 0) return &file->tensors[k];
    return NULL;
}

float tensor_float(const Tensor *tensor, size_t k) { return little_endian_float(tensor->data + 4 * k); }

static void put(FILE *stream, uint64_t value, int count) {
    for (int k = 0; k < count; k++) fputc((int)(value >> 8 * k & 255u), stream);
}

static size_t header_size(const Tensor *tensors, int count) {
    size_t size = sizeof magic + 6;
    for (int k = 0; k < count; k++) size += 13 + strlen(tensors[k].name) + 8 * (size_t)tensors[k].rank;
    return size;
}

bool tensor_file_write(FILE *stream, const Tensor *tensors, int count) {
    size_t offset = header_size(tensors, count);
    fwrite(magic, 1, sizeof magic, stream);
    put(stream, 1, 2);
    put(stream, (uint64_t)count, 4);
    for (int k = 0; k < count; k++) {
        const Tensor *tensor = &tensors[k];
        put(stream, strlen(tensor->name), 2);
        fputs(tensor->name, stream);
        put(stream, (uint64_t)tensor->rank, 2);
        put(stream, tensor->type, 1);
        put(stream, offset, 8);
        for (int axis = 0; axis < tensor->rank; axis++) put(stream, tensor->extent[axis], 8);
        offset += tensor->count * sizes[tensor->type];
    }
    for (int k = 0; k < count; k++) fwrite(tensors[k].data, sizes[tensors[k].type], tensors[k].count, stream);
    return !ferror(stream);
}
