/* rgl_write.c - writing of files in the RGL format */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "brdf/rgl.h"
#include "brdf/tensor.h"

enum { FIELDS = 9 };

/* The arrays of a file, with floats as little-endian bytes. */
typedef struct Fields {
    int count;
    Tensor tensors[FIELDS];
    unsigned char *bytes[FIELDS];
    bool short_of_memory;
} Fields;

static void add(Fields *fields, const char *name, TensorType type, const void *data, int rank, const int *extent) {
    Tensor *tensor = &fields->tensors[fields->count];
    *tensor = (Tensor){.type = type, .rank = rank, .count = 1};
    snprintf(tensor->name, sizeof tensor->name, "%s", name);
    for (int k = 0; k < rank; k++) {
        tensor->extent[k] = (size_t)extent[k];
        tensor->count *= (size_t)extent[k];
    }
    tensor->data = data;
    if (type == TENSOR_F32) {
        unsigned char *bytes = fields->bytes[fields->count] = alloc_array(tensor->count, 4);
        for (size_t k = 0; bytes && k < 4 * tensor->count; k++) {
            uint32_t bits;
            memcpy(&bits, (const float *)data + k / 4, sizeof bits);
            bytes[k] = (unsigned char)(bits >> 8 * (k % 4));
        }
        fields->short_of_memory |= !bytes;
        tensor->data = bytes;
    }
    fields->count++;
}

bool rgl_write(const Rgl *self, const char *description, FILE *stream) {
    static const unsigned char with_jacobian = 1; /* the density of W is over u */
    const int p = self->phis, t = self->thetas, n = self->side, one = 1, letters = (int)strlen(description);
    const SquareWarp *w = &self->normals, *l = &self->luminance;
    Fields fields = {.count = 0};
    add(&fields, "description", TENSOR_U8, description, 1, &letters);
    add(&fields, "jacobian", TENSOR_U8, &with_jacobian, 1, &one);
    add(&fields, "phi_i", TENSOR_F32, self->phi, 1, &p);
    add(&fields, "theta_i", TENSOR_F32, self->theta, 1, &t);
    add(&fields, "ndf", TENSOR_F32, self->ndf.value, 2, (const int[]){self->ndf.height, self->ndf.width});
    add(&fields, "sigma", TENSOR_F32, self->sigma.value, 2, (const int[]){self->sigma.height, self->sigma.width});
    add(&fields, "vndf", TENSOR_F32, w->density, 4, (const int[]){p, t, w->height, w->width});
    add(&fields, "luminance", TENSOR_F32, l->density, 4, (const int[]){p, t, l->height, l->width});
    add(&fields, "rgb", TENSOR_F32, self->color, 5, (const int[]){p, t, 3, n, n});
    bool written = !fields.short_of_memory && tensor_file_write(stream, fields.tensors, fields.count);
    for (int k = 0; k < FIELDS; k++) free(fields.bytes[k]);
    return written;
}
