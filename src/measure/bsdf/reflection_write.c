/* reflection_write.c - writes any reflection as a file of RGL's format */
#include <math.h>
#include <stdint.h>

#include "base/fail.h"
#include "base/file.h"
#include "base/pi.h"
#include "brdf/measured.h"
#include "brdf/rgl_make.h"
#include "measure/bsdf/halton.h"
#include "measure/bsdf/reflection.h"
#include "weft/reflection.h"

/* The most numbers of a file: with D, sigma and the axes it stays within MEASURED_MOST, the limit of the reader. */
enum { POINTS_MOST = MEASURED_MOST / 4 - (1 << 18) };

static void source_f(void *user, const float wo[3], int count, const float (*wi)[3], float (*f)[3]) {
    weft_reflection_eval(user, WEFT_PART_ALL, wo, count, wi, f);
}

/* Returns true if f of some pairs does not change when both directions are mapped in the plane: x to a x + b
 * y, y to c x + d y. */
static bool is_symmetric(const WeftReflection *reflection, float a, float b, float c, float d) {
    static const float directions[][3] = {
        {0.6f, 0.0f, 0.8f}, {0.64f, 0.48f, 0.6f}, {-0.28f, 0.0f, 0.96f}, {-0.48f, 0.36f, 0.8f}};
    enum { DIRECTIONS = sizeof directions / sizeof *directions };
    bool same = true;
    for (int pair = 0; pair < DIRECTIONS * DIRECTIONS; pair++) {
        const int at = pair / DIRECTIONS;
        const float *o = directions[at], *i = directions[pair % DIRECTIONS];
        const float wo[3] = {a * o[0] + b * o[1], c * o[0] + d * o[1], o[2]};
        const float wi[2][3] = {{i[0], i[1], i[2]}, {a * i[0] + b * i[1], c * i[0] + d * i[1], i[2]}};
        float f[1][3], mapped[1][3];
        weft_reflection_eval(reflection, WEFT_PART_ALL, o, 1, wi, f);
        weft_reflection_eval(reflection, WEFT_PART_ALL, wo, 1, wi + 1, mapped);
        for (int k = 0; k < 3; k++) same &= fabsf(mapped[0][k] - f[0][k]) <= 1e-3f * (fabsf(f[0][k]) + 1e-6f);
    }
    return same;
}

static RglSource source_of(const WeftReflection *reflection) {
    RglSource source = {.f = source_f, .user = (void *)(uintptr_t)reflection, .isotropic = true};
    for (int k = 1; k < 5; k++) {
        const float c = cosf(1.1f * (float)k), s = sinf(1.1f * (float)k);
        source.isotropic &= is_symmetric(reflection, c, -s, s, c);
    }
    const bool half = is_symmetric(reflection, -1.0f, 0.0f, 0.0f, -1.0f);
    source.parts = !half ? 1 : is_symmetric(reflection, 1.0f, 0.0f, 0.0f, -1.0f) ? 4 : 2;
    return source;
}

static void tables_f(void *user, const float wo[3], int count, const float (*wi)[3], float (*f)[3]) {
    for (int k = 0; k < count; k++) rgl_at(user, dir(wo[0], wo[1], wo[2]), dir(wi[k][0], wi[k][1], wi[k][2]), f[k]);
}

static float nearest_slice(const Rgl *slices, float theta) {
    int k = 0;
    while (k + 1 < slices->thetas && slices->theta[k] + slices->theta[k + 1] < 2.0f * theta) k++;
    return slices->theta[k];
}

/* Returns the mean difference of f over the mean of a's f, for pairs up to 80 degrees; wo is at slices of the
 * tables, if these are given. */
static double difference(const RglSource *a, const RglSource *b, const Rgl *slices) {
    enum { PAIRS = 4096 };
    double sum = 0.0, off = 0.0;
    for (int n = 0; n < PAIRS; n++) {
        float u = (float)halton(n, 2), v = (float)halton(n, 3), theta = 80.0f * (float)RADIANS * u,
              phi = PI_FLOAT * (2.0f * v - 1.0f);
        if (slices) {
            theta = nearest_slice(slices, theta);
            phi = slices->phi[(int)(v * (float)slices->phis)];
        }
        const float z = 0.1737f + 0.8263f * (float)halton(n, 5), r = sqrtf(1.0f - z * z),
                    azimuth = 2.0f * PI_FLOAT * (float)halton(n, 7);
        const float wo[3] = {sinf(theta) * cosf(phi), sinf(theta) * sinf(phi), cosf(theta)},
                    wi[1][3] = {{r * cosf(azimuth), r * sinf(azimuth), z}};
        float f[1][3], g[1][3];
        a->f(a->user, wo, 1, wi, f);
        b->f(b->user, wo, 1, wi, g);
        for (int c = 0; c < 3; c++) sum += (double)f[0][c], off += fabs((double)f[0][c] - (double)g[0][c]);
    }
    return sum > 0.0 ? off / sum : off;
}

double weft_reflection_distance(const WeftReflection *reflection, const WeftReflection *other) {
    const RglSource a = {.f = source_f, .user = (void *)(uintptr_t)reflection},
                    b = {.f = source_f, .user = (void *)(uintptr_t)other};
    return difference(&a, &b, NULL);
}

static long long numbers_of(const RglDesc *desc, bool isotropic) {
    return 5LL * desc->thetas * (isotropic ? 1 : desc->phis) * desc->side * desc->side;
}

/* Returns a fifth more, since tables whose error falls with the square of their steps may need no more. */
static int finer_count(int count, int most) {
    const int more = count + count / 5;
    return more < most ? more : most;
}

/* A little below 1e-3, because other pairs may differ more. */
static const double near_enough = 9.5e-4;

/* Makes all tables of that size except D and sigma. */
static bool tables_make(const RglSource *source, const RglDesc *desc, Rgl *out) {
    return rgl_make(source, desc, out) && rgl_sharpen(out);
}

/* Refines the tables until f comes back within 1e-3 of its mean, or the next step would exceed the largest
 * size. Refines slices or sides, whichever errs more before sharpening. Returns false if memory is short. */
static bool refine(const RglSource *source, RglDesc *desc, Rgl *out) {
    const RglSource tables = {.f = tables_f, .user = out};
    for (;;) {
        if (!rgl_make(source, desc, out)) return false;
        const bool by_slices = difference(source, &tables, NULL) > 2.0 * difference(source, &tables, out);
        RglDesc finer = *desc;
        if (!rgl_sharpen(out)) return false;
        if (difference(source, &tables, NULL) <= near_enough) return true;
        if (by_slices) {
            finer.thetas = finer_count(desc->thetas, RGL_SLICES_MOST);
            finer.phis = finer_count(desc->phis, RGL_SLICES_MOST);
        } else {
            finer.side = finer_count(desc->side, RGL_SIDE_MOST);
        }
        if (numbers_of(&finer, source->isotropic) > POINTS_MOST ||
            numbers_of(&finer, source->isotropic) == numbers_of(desc, source->isotropic))
            return true;
        *desc = finer;
    }
}

static WeftResult desc_check(const RglDesc *desc, bool isotropic, WeftError *error) {
    const char *name = "a .bsdf";
    if (desc->thetas < 2 || desc->thetas > RGL_SLICES_MOST)
        return fail(error, WEFT_MESSAGE_DESC, name, "it has %d polar angles, not 2 .. %d", desc->thetas,
                    RGL_SLICES_MOST);
    if (desc->phis < 3 || desc->phis > RGL_SLICES_MOST)
        return fail(error, WEFT_MESSAGE_DESC, name, "it has %d azimuths, not 3 .. %d", desc->phis, RGL_SLICES_MOST);
    if (desc->side < 8 || desc->side > RGL_SIDE_MOST)
        return fail(error, WEFT_MESSAGE_DESC, name, "its tables have sides of %d points, not 8 .. %d", desc->side,
                    RGL_SIDE_MOST);
    if (numbers_of(desc, isotropic) > POINTS_MOST)
        return fail(error, WEFT_MESSAGE_DESC, name, "it would have more than %d numbers", POINTS_MOST);
    return WEFT_OK;
}

static WeftResult file_write(const Rgl *rgl, const char *comment, const char *path, WeftError *error) {
    OutputFile file;
    WeftResult result = output_open(&file, path, error);
    if (result != WEFT_OK) return result;
    if (rgl_write(rgl, comment, file.stream) || ferror(file.stream)) return output_commit(&file, error);
    output_discard(&file);
    return fail(error, WEFT_MESSAGE_MEMORY, path, NULL);
}

WeftResult weft_reflection_write(const WeftReflection *reflection, const char *path, const WeftBsdfDesc *desc,
                                 WeftError *error) {
    const RglSource source = source_of(reflection);
    const bool isotropic = source.isotropic, given = desc->thetas || desc->phis || desc->side;
    RglDesc fine = {.thetas = desc->thetas ? desc->thetas
                              : given      ? 32
                              : isotropic  ? 24
                                           : 16,
                    .phis = desc->phis ? desc->phis
                            : given    ? 17
                                       : 9,
                    .side = desc->side  ? desc->side
                            : isotropic ? 64
                                        : 32,
                    .threads = desc->threads};
    Rgl rgl = {0};
    const char *walk = reflection_walks(reflection);
    if (walk) return fail(error, WEFT_MESSAGE_DESC, walk, "is an estimate by random walks; tabulate fibre, its mean");
    WeftResult result = desc_check(&fine, isotropic, error);
    if (result != WEFT_OK) return result;
    if (result == WEFT_OK && !(rgl_facets(&source, fine.threads, &rgl) &&
                               (given ? tables_make(&source, &fine, &rgl) : refine(&source, &fine, &rgl))))
        result = fail(error, WEFT_MESSAGE_MEMORY, path, NULL);
    if (result == WEFT_OK)
        result = file_write(&rgl, desc->comment && desc->comment[0] ? desc->comment : " ", path, error);
    rgl_free(&rgl);
    return result;
}
