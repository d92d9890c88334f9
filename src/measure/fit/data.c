#include "measure/fit/data.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/fail.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/pi.h"
#include "brdf/measured.h"
#include "measure/fit/brdf_table.h"

struct WeftData {
    int count, all;
    bool isotropic;
    float (*wo)[3], (*wi)[3], (*f)[3];
};

/* The cosine of 80 degrees: samples at smaller cosines are skipped. */
static const float cosine_least = 0.17364818f;
enum { SAMPLES_LEAST = 16 };

void weft_data_free(WeftData *self) {
    if (!self) return;
    free(self->wo);
    free(self->wi);
    free(self->f);
    free(self);
}

void weft_data_sample(const WeftData *self, int k, float wo[3], float wi[3], float f[3]) {
    memcpy(wo, self->wo[k], sizeof *self->wo);
    memcpy(wi, self->wi[k], sizeof *self->wi);
    memcpy(f, self->f[k], sizeof *self->f);
}

int weft_data_count(const WeftData *self, int *all) {
    if (all) *all = self->all;
    return self->count;
}

/* Returns a step that visits each of count items before any for the second time. */
static size_t step_through(size_t count) {
    size_t step = (size_t)((double)count * 0.6180339887498949) | 1u;
    for (;; step++) {
        size_t a = count, b = step;
        while (b) {
            size_t rest = a % b;
            a = b;
            b = rest;
        }
        if (a <= 1) return step;
    }
}

static bool is_measured(const float f[3]) {
    return f[0] >= 0.0f && f[1] >= 0.0f && f[2] >= 0.0f && f[0] + f[1] + f[2] < 1e30f;
}

/* The numbers of skipped samples, and whether any other is above 0. */
typedef struct Passed {
    int unmeasured, grazing;
    bool any;
} Passed;

/* Copies the samples in an order in which any first part is representative of all. */
static Passed take_samples(WeftData *self, const float (*wo)[3], const float (*wi)[3], const float (*f)[3]) {
    size_t n = (size_t)self->all, step = step_through(n), at = 0;
    Passed passed = {.any = false};
    for (size_t k = 0; k < n; k++, at = (at + step) % n) {
        bool measured = is_measured(f[at]), high = wo[at][2] >= cosine_least && wi[at][2] >= cosine_least;
        passed.unmeasured += !measured;
        passed.grazing += measured && !high;
        if (!measured || !high) continue;
        memcpy(self->wo[self->count], wo[at], sizeof *wo);
        memcpy(self->wi[self->count], wi[at], sizeof *wi);
        memcpy(self->f[self->count++], f[at], sizeof *f);
        passed.any |= f[at][0] + f[at][1] + f[at][2] > 0.0f;
    }
    return passed;
}

static WeftResult check_samples(const WeftData *self, const Passed *passed, const char *name, WeftMessage message,
                                WeftError *error) {
    if (self->all == 0) return fail(error, message, name, "nothing in it is a sample");
    if (self->count < SAMPLES_LEAST)
        return fail(error, message, name,
                    "of %d samples %d were not measured and %d are more than 80 degrees off the normal, which leaves "
                    "%d; %d are needed",
                    self->all, passed->unmeasured, passed->grazing, self->count, SAMPLES_LEAST);
    if (!passed->any)
        return fail(error, message, name,
                    "nothing in it is above 0, of %d samples; %d more were not measured, and %d are more than "
                    "80 degrees off the normal",
                    self->count, passed->unmeasured, passed->grazing);
    return WEFT_OK;
}

/* Makes data from samples that a file of that name or, if message is DESC, a caller has. */
static WeftResult data_make(int count, const float (*wo)[3], const float (*wi)[3], const float (*f)[3], bool isotropic,
                            const char *name, WeftMessage message, WeftData **out, WeftError *error) {
    WeftData *self = alloc_array(1, sizeof *self);
    size_t n = (size_t)(count > 0 ? count : 0);
    if (self) {
        *self = (WeftData){.all = (int)n, .isotropic = isotropic};
        self->wo = alloc_array(n, sizeof *self->wo);
        self->wi = alloc_array(n, sizeof *self->wi);
        self->f = alloc_array(n, sizeof *self->f);
    }
    WeftResult result;
    if (self && self->wo && self->wi && self->f) {
        Passed passed = n ? take_samples(self, wo, wi, f) : (Passed){.any = false};
        result = check_samples(self, &passed, name, message, error);
    } else {
        result = fail(error, WEFT_MESSAGE_MEMORY, name, NULL);
    }
    if (result != WEFT_OK) {
        weft_data_free(self);
        self = NULL;
    }
    *out = self;
    return result;
}

WeftResult weft_data_create(int count, const float (*wo)[3], const float (*wi)[3], const float (*f)[3], int isotropic,
                            WeftData **out, WeftError *error) {
    return data_make(count, wo, wi, f, isotropic != 0, "samples", WEFT_MESSAGE_DESC, out, error);
}

/* Finds the directions of a place in MERL's coordinates, rotated about the normal by phi. Szymon
 * Rusinkiewicz, "A New Change of Variables for Efficient BRDF Representation", 1998. */
static void rusinkiewicz(double th, double td, double pd, double phi, float wo[3], float wi[3]) {
    double x = (sin)(td) * (cos)(pd), y = (sin)(td) * (sin)(pd), z = (cos)(td);
    double i[3] = {(cos)(th)*x + (sin)(th)*z, y, (cos)(th)*z - (sin)(th)*x};
    const double h[3] = {(sin)(th), 0.0, (cos)(th)};
    double o[3] = {2.0 * z * h[0] - i[0], 2.0 * z * h[1] - i[1], 2.0 * z * h[2] - i[2]};
    double c = (cos)(phi), s = (sin)(phi);
    wi[0] = (float)(c * i[0] - s * i[1]), wi[1] = (float)(s * i[0] + c * i[1]), wi[2] = (float)i[2];
    wo[0] = (float)(c * o[0] - s * o[1]), wo[1] = (float)(s * o[0] + c * o[1]), wo[2] = (float)o[2];
}

enum { SIDE_H = 24, SIDE_D = 24, SIDE_P = 12, SAMPLES = SIDE_H * SIDE_D * SIDE_P };

/* Returns the middle of the bin that represents cell k of n. */
static double middle(int k, int n, int bins, int *bin) {
    *bin = (int)((k + 0.5) * bins / n);
    return (*bin + 0.5) / bins;
}

/* Fills samples of f at a grid of half vectors and differences. Each pair is rotated by another azimuth, so that data
 * that are not isotropic do not fit an isotropic lobe by chance. For MERL the values are those of the bins. */
static void grid_samples(const Measured *measured, float (*wo)[3], float (*wi)[3], float (*f)[3]) {
    const Merl *merl = &measured->merl;
    const double half_pi = 0.5 * PI_DOUBLE;
    const bool binned = measured->format == MEASURED_MERL, around = !binned || merl->shape.around;
    const int bins = binned ? merl->shape.phi_d : 2 * MERL_PHI_D;
    for (int k = 0; k < SAMPLES; k++) {
        int h, d, p;
        double root = middle(k / (SIDE_D * SIDE_P), SIDE_H, MERL_THETA_H, &h);
        double td = middle(k / SIDE_P % SIDE_D, SIDE_D, MERL_THETA_D, &d) * half_pi;
        double pd = middle(k % SIDE_P, SIDE_P, bins, &p) * (around ? 4.0 : 2.0) * half_pi;
        rusinkiewicz(root * root * half_pi, td, pd, 2.39996322972865 * k, wo[k], wi[k]);
        size_t bin = ((size_t)h * MERL_THETA_D + (size_t)d) * (size_t)bins + (size_t)p;
        if (!binned) measured_at(measured, dir(wo[k][0], wo[k][1], wo[k][2]), dir(wi[k][0], wi[k][1], wi[k][2]), f[k]);
        for (int c = 0; binned && c < 3; c++) f[k][c] = merl->f[c][bin];
    }
}

static WeftResult data_of_measured(const Measured *measured, const char *name, WeftData **out, WeftError *error) {
    static const WeftMessage messages[] = {[MEASURED_MERL] = WEFT_MESSAGE_MEASURED,
                                           [MEASURED_RGL] = WEFT_MESSAGE_BSDF,
                                           [MEASURED_UTIA] = WEFT_MESSAGE_UTIA};
    float(*block)[3] = alloc_array((size_t)3 * SAMPLES, sizeof *block);
    if (!block) return fail(error, WEFT_MESSAGE_MEMORY, name, NULL);
    float(*wo)[3] = block, (*wi)[3] = block + SAMPLES, (*f)[3] = block + (size_t)2 * SAMPLES;
    grid_samples(measured, wo, wi, f);
    WeftResult result = data_make(SAMPLES, (const float(*)[3])wo, (const float(*)[3])wi, (const float(*)[3])f,
                                  measured_isotropic(measured), name, messages[measured->format], out, error);
    free(block);
    return result;
}

WeftResult weft_data_read_memory(const void *data, size_t size, const char *name, WeftData **out, WeftError *error) {
    WeftResult result;
    *out = NULL;
    if (measured_format(name) != MEASURED_NONE) {
        Measured measured;
        result = measured_read_memory(data, size, name, &measured, error);
        if (result == WEFT_OK) result = data_of_measured(&measured, name, out, error);
        measured_free(&measured);
        return result;
    }
    BrdfTable table;
    result = brdf_table_read(data, size, name, &table, error);
    if (result == WEFT_OK)
        result = data_make(table.count, (const float(*)[3])table.wo, (const float(*)[3])table.wi,
                           (const float(*)[3])table.f, false, name, WEFT_MESSAGE_BRDF_TABLE, out, error);
    brdf_table_free(&table);
    return result;
}

WeftResult weft_data_read(const char *path, WeftData **out, WeftError *error) {
    FileBytes bytes;
    *out = NULL;
    WeftResult result = file_read(path, MEASURED_MOST, &bytes, error);
    if (result != WEFT_OK) return result;
    result = weft_data_read_memory(bytes.data, bytes.size, path, out, error);
    free(bytes.data);
    return result;
}

bool data_isotropic(const WeftData *self) { return self->isotropic; }

bool data_samples(const WeftData *self, WeftBrdfMetric metric, Samples *out) {
    if (!samples_create(out, self->count, metric)) return false;
    for (int k = 0; k < self->count; k++) {
        out->weight[k] = 1.0f;
        for (int c = 0; c < 3; c++) {
            out->o[c][k] = self->wo[k][c];
            out->i[c][k] = self->wi[k][c];
            out->x[c][k] = self->f[k][c] * self->wi[k][2];
        }
    }
    out->first = self->count > 4000 ? self->count / 4 : self->count > 1000 ? 1000 : self->count;
    samples_finish(out);
    return true;
}
