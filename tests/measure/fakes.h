/* fakes.h - bsdfs that are wrong in one way each, for the measurements to find out
 *
 * Include it after cmocka: the dialect's names shadow <math.h>. */
#ifndef WEFT_TEST_MEASURE_FAKES_H
#define WEFT_TEST_MEASURE_FAKES_H

#include "measure/bsdf/bsdf.h"
#include "measure/check/passport.h"
#include "shading/dialect/warp.h"

static inline void fake_prepare(const Bsdf *bsdf, int setting, Dir o, BsdfView *view) {
    view->bsdf = bsdf;
    view->o = o;
}

static inline void fake_f(const BsdfView *view, Dirs i, float *f) {
    for (size_t k = 0; k < i.n; k++) f[k] = i.z[k] > 0.0f ? 1.0f / PI : 0.0f;
}

static inline void fake_pdf(const BsdfView *view, Dirs i, float *pdf) {
    for (size_t k = 0; k < i.n; k++) pdf[k] = i.z[k] > 0.0f ? warp_cosine_pdf(dir(i.x[k], i.y[k], i.z[k])) : 0.0f;
}

static inline Dir fake_sample(const BsdfView *view, float u, float v) { return warp_cosine(u, v); }

/* A white Lambert surface: nothing is wrong with it. */
static inline Bsdf fake_lambert(void) {
    return (Bsdf){.rows = 1,
                  .parameter = "",
                  .settings = 1,
                  .whole = true,
                  .prepare = fake_prepare,
                  .f = fake_f,
                  .pdf = fake_pdf,
                  .sample = fake_sample};
}

static inline WeftPassport fake_passport(const Bsdf *bsdf) {
    WeftPassport passport = {0};
    assert_true(passport_measure(bsdf, &(WeftPassportDesc){.no_gpu = 1}, &passport));
    return passport;
}

#endif
