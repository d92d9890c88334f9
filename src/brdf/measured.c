#define _XOPEN_SOURCE 700 /* realpath */
#include <stdlib.h>

#include "brdf/measured.h"

#include "base/fail.h"
#include "base/file.h"
#include "base/path.h"
#include "brdf/foreign.h"
#include "shading/dialect/warp.h"

MeasuredFormat measured_format(const char *name) {
    return path_ends(name, ".binary") ? MEASURED_MERL
           : path_ends(name, ".bsdf") ? MEASURED_RGL
           : path_ends(name, ".bin")  ? MEASURED_UTIA
                                      : MEASURED_NONE;
}

WeftResult measured_read_memory(const void *data, size_t size, const char *name, Measured *out, WeftError *error) {
    MeasuredFormat format = measured_format(name);
    *out = (Measured){.format = format == MEASURED_NONE ? MEASURED_MERL : format};
    WeftResult result = format == MEASURED_RGL    ? rgl_read_memory(data, size, name, &out->rgl, error)
                        : format == MEASURED_UTIA ? utia_read_memory(data, size, name, &out->utia, error)
                                                  : merl_read_memory(data, size, name, &out->merl, error);
    const char *foreign = result == WEFT_INPUT ? foreign_name(data, size) : NULL;
    if (!foreign) return result;
    return fail(error,
                format == MEASURED_RGL    ? WEFT_MESSAGE_BSDF
                : format == MEASURED_UTIA ? WEFT_MESSAGE_UTIA
                                          : WEFT_MESSAGE_MEASURED,
                name, "%s", foreign);
}

WeftResult measured_read(const char *path, Measured *out, WeftError *error) {
    FileBytes bytes;
    *out = (Measured){.format = MEASURED_NONE};
    WeftResult result = file_read(path, MEASURED_MOST, &bytes, error);
    if (result != WEFT_OK) return result;
    result = measured_read_memory(bytes.data, bytes.size, path, out, error);
    free(bytes.data);
    if (result == WEFT_OK) out->path = realpath(path, NULL);
    return result;
}

void measured_free(Measured *self) {
    merl_free(&self->merl);
    rgl_free(&self->rgl);
    utia_free(&self->utia);
    free(self->path);
    self->path = NULL;
    self->format = MEASURED_NONE;
}

bool measured_isotropic(const Measured *self) {
    return self->format == MEASURED_MERL || (self->format == MEASURED_RGL && rgl_isotropic(&self->rgl));
}

bool measured_at(const Measured *self, Dir o, Dir i, float f[3]) {
    if (self->format == MEASURED_MERL) return merl_at(&self->merl, o, i, f);
    if (self->format == MEASURED_RGL)
        rgl_at(&self->rgl, o, i, f);
    else
        utia_at(&self->utia, o, i, f);
    return o.z > 0.0f && i.z > 0.0f;
}

Dir measured_sample(const Measured *self, Dir o, float u, float v) {
    return self->format == MEASURED_RGL ? rgl_sample(&self->rgl, o, u, v) : warp_cosine(u, v);
}

float measured_pdf(const Measured *self, Dir o, Dir i) {
    return self->format == MEASURED_RGL ? rgl_pdf(&self->rgl, o, i) : warp_cosine_pdf(i);
}
