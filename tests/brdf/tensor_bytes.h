/* tensor_bytes.h - files of RGL's format put together byte by byte */
#ifndef WEFT_TESTS_TENSOR_BYTES_H
#define WEFT_TESTS_TENSOR_BYTES_H

#include <stdint.h>
#include <string.h>

enum { BYTES_ROOM = 1 << 18 };

typedef struct TensorBytes {
    size_t size;             /* of the header, until the arrays are behind it */
    size_t arrays;           /* how many were begun */
    size_t offset_at[16];    /* where the offset of each is in the header */
    const float *values[16]; /* NULL: one byte */
    size_t counts[16];
    unsigned char data[BYTES_ROOM];
} TensorBytes;

static void bytes_put(TensorBytes *bytes, uint64_t value, int count) {
    for (int k = 0; k < count; k++) bytes->data[bytes->size++] = (unsigned char)(value >> 8 * k);
}

static void bytes_begin(TensorBytes *bytes, uint32_t count) {
    memset(bytes, 0, sizeof *bytes);
    memcpy(bytes->data, "tensor_file", 12);
    bytes->size = 12;
    bytes_put(bytes, 1, 2);
    bytes_put(bytes, count, 4);
}

/* An array of rank extents; its values must live until bytes_end. */
static void bytes_array(TensorBytes *bytes, const char *name, const float *values, int rank, const size_t *extent) {
    size_t k = bytes->arrays++;
    bytes_put(bytes, strlen(name), 2);
    memcpy(bytes->data + bytes->size, name, strlen(name));
    bytes->size += strlen(name);
    bytes_put(bytes, (uint64_t)rank, 2);
    bytes_put(bytes, values ? 10 : 1, 1);
    bytes->offset_at[k] = bytes->size;
    bytes_put(bytes, 0, 8);
    bytes->values[k] = values;
    bytes->counts[k] = 1;
    for (int axis = 0; axis < rank; axis++) {
        bytes_put(bytes, extent[axis], 8);
        bytes->counts[k] *= extent[axis];
    }
}

static void bytes_end(TensorBytes *bytes) {
    for (size_t k = 0; k < bytes->arrays; k++) {
        size_t end = bytes->size;
        bytes->size = bytes->offset_at[k];
        bytes_put(bytes, end, 8);
        bytes->size = end;
        if (!bytes->values[k]) bytes_put(bytes, 0, 1);
        for (size_t n = 0; bytes->values[k] && n < bytes->counts[k]; n++) {
            uint32_t bits;
            memcpy(&bits, bytes->values[k] + n, sizeof bits);
            bytes_put(bytes, bits, 4);
        }
    }
}

#endif
