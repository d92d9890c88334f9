/* tensor.h - a file of named arrays of numbers, the container of the RGL database
 *
 *   "tensor_file", 0          12 bytes
 *   1, 0                      the version, a byte each
 *   count                     u32
 *   count times: length u16, the name, rank u16, type u8, offset u64, rank extents u64
 *
 * then the numbers, each array from its offset in the file on, the last axis fastest; all little-endian.
 * Jonathan Dupuy, Wenzel Jakob, "An Adaptive Parameterization for Efficient Material Acquisition and
 * Rendering", ACM Transactions on Graphics 37(6), 2018; the details follow programs that read these files. */
#pragma once

#include <stdbool.h>
#include <stdio.h>

#include "weft/result.h"

enum { TENSOR_AXES = 6, TENSOR_NAME = 32, TENSORS_MOST = 32 };

typedef enum TensorType { TENSOR_U8 = 1, TENSOR_F32 = 10, TENSOR_TYPES = 12 } TensorType;

/* One array. */
typedef struct Tensor {
    char name[TENSOR_NAME];
    TensorType type;
    int rank;
    size_t extent[TENSOR_AXES], count; /* count is their product */
    const unsigned char *data;         /* borrowed: little-endian bytes */
} Tensor;

typedef struct TensorFile {
    int count;
    Tensor tensors[TENSORS_MOST];
} TensorFile;

/* Finds the arrays in size bytes, which must outlive the file; nothing is allocated. Each lies within the
 * bytes. Fails with WEFT_MESSAGE_BSDF. */
WeftResult tensor_file_read(const unsigned char *bytes, size_t size, const char *name, TensorFile *out,
                            WeftError *error);

/* Returns the array of that name, or NULL. */
const Tensor *tensor_find(const TensorFile *file, const char *name);

/* Returns number k of an array of TENSOR_F32. */
float tensor_float(const Tensor *tensor, size_t k);

/* Writes count arrays. Returns false on failure. */
bool tensor_file_write(FILE *stream, const Tensor *tensors, int count);
