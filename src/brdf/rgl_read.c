/* rgl_read.c - reading of files in the RGL format */
#include <math.h>
#include <stdlib.h>

#include "base/fail.h"
#include "base/memory.h"
#include "base/pi.h"
#include "brdf/rgl.h"
#include "brdf/spectrum.h"
#include "brdf/tensor.h"

/* A file while it is read. */
typedef struct RglFile {
    TensorFile tensors;
    const char *name;
    WeftError *error;
    WeftResult result; /* the first failure */
} RglFile;

static void refuse(RglFile *file, const char *field, const char *why) {
    if (file->result == WEFT_OK)
        file->result = fail(file->error, WEFT_MESSAGE_BSDF, file->name, "\"%s\" %s", field, why);
}

/* Finds an array of floats with that many axes; returns NULL on failure. */
static const Tensor *floats_of(RglFile *file, const char *field, int rank) {
    const Tensor *tensor = tensor_find(&file->tensors, field);
    if (!tensor)
        refuse(file, field, "is missing");
    else if (tensor->rank != rank || tensor->type != TENSOR_F32)
        refuse(file, field, "has not the axes or the type that it should have");
    else
        return tensor;
    return NULL;
}

/* Copies the numbers and checks that all are finite. */
static float *copied(RglFile *file, const Tensor *tensor) {
    float *out = file->result == WEFT_OK ? alloc_array(tensor->count, sizeof *out) : NULL;
    if (!out && file->result == WEFT_OK) file->result = fail(file->error, WEFT_MESSAGE_MEMORY, file->name, NULL);
    for (size_t k = 0; out && k < tensor->count; k++) {
        out[k] = tensor_float(tensor, k);
        if (!isfinite(out[k])) refuse(file, tensor->name, "has a number that is not finite");
    }
    return out;
}

/* Reads the numbers of an axis, which must ascend. */
static float *axis_of(RglFile *file, const char *field, int *count) {
    const Tensor *tensor = floats_of(file, field, 1);
    float *out = tensor ? copied(file, tensor) : NULL;
    *count = out ? (int)tensor->count : 0;
    for (int k = 1; out && k < *count; k++)
        if (!(out[k] > out[k - 1])) refuse(file, field, "does not ascend");
    return out;
}

/* Reads the last two extents, which must be 2 to 65536. */
static void sides_of(RglFile *file, const Tensor *tensor, int *width, int *height) {
    size_t w = tensor->extent[tensor->rank - 1], h = tensor->extent[tensor->rank - 2];
    *width = (int)w, *height = (int)h;
    if (w < 2 || h < 2 || w > 65536 || h > 65536) refuse(file, tensor->name, "has a side below 2 or above 65536");
}

static void table_of(RglFile *file, const char *field, RglTable *out) {
    const Tensor *tensor = floats_of(file, field, 2);
    if (!tensor) return;
    sides_of(file, tensor, &out->width, &out->height);
    out->value = copied(file, tensor);
}

/* Finds an array with a slice for each azimuth and polar angle. */
static const Tensor *sliced(RglFile *file, const Rgl *rgl, const char *field, int rank) {
    const Tensor *tensor = floats_of(file, field, rank);
    if (!tensor || file->result != WEFT_OK) return NULL;
    if (tensor->extent[0] == (size_t)rgl->phis && tensor->extent[1] == (size_t)rgl->thetas) return tensor;
    refuse(file, field, "has not as many slices as there are angles");
    return NULL;
}

static void warp_of(RglFile *file, const Rgl *rgl, const char *field, SquareWarp *out) {
    const Tensor *tensor = sliced(file, rgl, field, 4);
    int width, height;
    if (!tensor) return;
    sides_of(file, tensor, &width, &height);
    float *density = copied(file, tensor);
    if (!density) return;
    bool made = square_warp_create(out, width, height, (size_t)rgl->phis * (size_t)rgl->thetas, density);
    if (!made) file->result = fail(file->error, WEFT_MESSAGE_MEMORY, file->name, NULL);
}

/* Reads the field rgb. */
static void colors_of(RglFile *file, Rgl *rgl) {
    const Tensor *tensor = sliced(file, rgl, "rgb", 5);
    if (!tensor) return;
    if (tensor->extent[2] != 3) refuse(file, "rgb", "has not three channels");
    rgl->color = copied(file, tensor);
}

/* Integrates the spectra to colours by the weights of the wavelengths. */
static void sum_spectra(const Tensor *spectra, const double *weights, float *color) {
    const size_t count = spectra->extent[2], n = spectra->extent[3] * spectra->extent[4],
                 slices = spectra->extent[0] * spectra->extent[1];
    for (size_t at = 0; at < slices * 3 * n; at++) {
        const size_t slice = at / (3 * n), c = at / n % 3, first = slice * count * n + at % n;
        double sum = 0.0;
        for (size_t k = 0; k < count; k++) sum += weights[c * count + k] * (double)tensor_float(spectra, first + k * n);
        color[at] = (float)sum;
    }
}

/* Reads spectra as colours. Interpolation is linear, so it commutes with the sum over wavelengths. */
static void spectra_of(RglFile *file, Rgl *rgl) {
    int count = 0;
    const Tensor *tensor = sliced(file, rgl, "spectra", 5);
    float *wavelength = tensor ? axis_of(file, "wavelengths", &count) : NULL;
    if (wavelength && tensor->extent[2] != (size_t)count)
        refuse(file, "spectra", "has not a slice for each wavelength");
    double *weights = wavelength ? alloc_array((size_t)3 * (size_t)count, sizeof *weights) : NULL;
    if (weights && !spectrum_weights(wavelength, count, weights))
        refuse(file, "wavelengths", "do not reach from red to blue");
    if (weights && file->result == WEFT_OK) {
        rgl->color = alloc_array(tensor->count / (size_t)count * 3, sizeof *rgl->color);
        if (rgl->color) sum_spectra(tensor, weights, rgl->color);
    }
    if (file->result == WEFT_OK && !rgl->color) file->result = fail(file->error, WEFT_MESSAGE_MEMORY, file->name, NULL);
    for (size_t k = 0; rgl->color && k < tensor->count / (size_t)count * 3; k++)
        if (!isfinite(rgl->color[k])) refuse(file, "spectra", "has a number that is not finite");
    free(wavelength);
    free(weights);
}

/* Returns the number of equal parts of the circle, from the span of the azimuths. */
static int parts_of(const Rgl *rgl) {
    double span = (double)rgl->phi[rgl->phis - 1] - (double)rgl->phi[0];
    double parts = rgl->phis > 2 ? 2.0 * PI_DOUBLE / span : 1.0;
    return parts > 1.5 && parts < 2.5 ? 2 : parts > 3.5 && parts < 4.5 ? 4 : 1;
}

static void take_fields(RglFile *file, Rgl *rgl) {
    int width, height;
    const char *colors = tensor_find(&file->tensors, "rgb") ? "rgb" : "spectra";
    rgl->phi = axis_of(file, "phi_i", &rgl->phis);
    rgl->theta = axis_of(file, "theta_i", &rgl->thetas);
    table_of(file, "ndf", &rgl->ndf);
    table_of(file, "sigma", &rgl->sigma);
    warp_of(file, rgl, "vndf", &rgl->normals);
    warp_of(file, rgl, "luminance", &rgl->luminance);
    const Tensor *tensor = sliced(file, rgl, colors, 5);
    if (!tensor) return;
    sides_of(file, tensor, &width, &height);
    rgl->side = width;
    if (width != height || rgl->luminance.width != width || rgl->luminance.height != width)
        refuse(file, colors, "and \"luminance\" are not squares of one size");
    if (file->result != WEFT_OK) return;
    if (tensor == tensor_find(&file->tensors, "rgb"))
        colors_of(file, rgl);
    else
        spectra_of(file, rgl);
    rgl->parts = parts_of(rgl);
}

WeftResult rgl_read_memory(const void *data, size_t size, const char *name, Rgl *out, WeftError *error) {
    RglFile file = {.name = name, .error = error};
    *out = (Rgl){0};
    file.result = tensor_file_read(data, size, name, &file.tensors, error);
    if (file.result == WEFT_OK) take_fields(&file, out);
    return file.result;
}
