#include <math.h>
#include <stdlib.h>

#include "brdf/rgl_facets.h"

#include "base/memory.h"
#include "base/pi.h"
#include "base/thread.h"

/* Directions of the iteration, and columns of the final tables. There is one more azimuth, since the first and the last
 * are equal. Tables have two equal rows if the source is isotropic. */
enum { ACROSS = 64, AROUND = ACROSS + 1, ROUNDS = 8, FINE = 256 };

/* The uniform part of D, relative to its peak. */
static const double uniform_part = 0.03;

Dir rgl_direction(double theta, double phi) {
    return dir((float)((sin)(theta) * (cos)(phi)), (float)((sin)(theta) * (sin)(phi)),
               (float)(fmax)((cos)(theta), 0.0));
}

typedef struct Facets {
    const RglSource *source;
    Dir normal[AROUND][ACROSS]; /* facet normals, at the corners of equal cells of u */
    double area[ACROSS];        /* solid angle of a facet's cell */
    RglTable ndf;               /* D of the iteration */
    RglTable back, sigma;       /* being filled: f cos of retroreflection, and sigma */
} Facets;

static void normals_make(Facets *self) {
    for (int x = 0; x < ACROSS; x++) {
        SquarePoint u = {.x = (double)x / (ACROSS - 1)};
        double theta, phi, end = x == 0 || x == ACROSS - 1 ? 0.5 : 1.0;
        for (int y = 0; y < AROUND; y++) {
            u.y = (double)y / (AROUND - 1);
            rgl_angles_of(u, &theta, &phi);
            self->normal[y][x] = rgl_direction(theta, phi);
        }
        self->area[x] = end * 2.0 * PI_DOUBLE * PI_DOUBLE * u.x * (sin)(theta) / (ACROSS - 1) / (AROUND - 1);
    }
}

static bool table_create(RglTable *table, int width, bool isotropic) {
    *table = (RglTable){.width = width, .height = isotropic ? 2 : width + 1};
    table->value = alloc_array((size_t)width * (size_t)table->height, sizeof *table->value);
    return table->value != NULL;
}

/* Replaces back and sigma by new tables. */
static bool tables_create(Facets *self, int width) {
    free(self->back.value);
    free(self->sigma.value);
    self->sigma.value = NULL;
    return table_create(&self->back, width, self->source->isotropic) &&
           table_create(&self->sigma, width, self->source->isotropic);
}

static int count_of(const RglTable *table) { return table->width * table->height; }

static double projected(const Facets *self, Dir w) {
    double sum = 0.0;
    for (int y = 0; y + 1 < AROUND; y++) {
        const float *d = self->ndf.value + (size_t)(self->ndf.height == AROUND ? y : 0) * ACROSS;
        for (int x = 0; x < ACROSS; x++) {
            double cosine = (double)dir_dot(w, self->normal[y][x]);
            if (cosine > 0.0) sum += cosine * self->area[x] * (double)d[x];
        }
    }
    return sum;
}

/* Returns the direction of an entry of a table, which is equal in both rows if the source is isotropic. */
static Dir direction_of(const Facets *self, const RglTable *table, int at) {
    const int x = at % table->width, y = at / table->width;
    double theta, phi;
    rgl_angles_of(
        (SquarePoint){(double)x / (table->width - 1), self->source->isotropic ? 0.5 : (double)y / (table->height - 1)},
        &theta, &phi);
    return rgl_direction(theta, phi);
}

static void sigma_set(void *user, int at, int thread) {
    const Facets *self = user;
    (void)thread;
    self->sigma.value[at] = (float)projected(self, direction_of(self, &self->sigma, at));
}

static void back_set(void *user, int at, int thread) {
    const Facets *self = user;
    const Dir w = direction_of(self, &self->back, at);
    const float o[3] = {w.x, w.y, (float)(fmax)((double)w.z, 1e-3)};
    float f[1][3];
    (void)thread;
    self->source->f(self->source->user, o, 1, (const float(*)[3])o, f);
    self->back.value[at] = (float)(((double)f[0][0] + (double)f[0][1] + (double)f[0][2]) / 3.0 * (double)o[2]);
}

/* Sets D from back and sigma; ndf may be the table of back. */
static void ndf_set(const Facets *self, RglTable *ndf) {
    double peak = 0.0;
    for (int k = 0; k < count_of(ndf); k++)
        peak = (fmax)(peak, (double)self->back.value[k] * (double)self->sigma.value[k]);
    for (int k = 0; k < count_of(ndf); k++) {
        const double d = (double)self->back.value[k] * (double)self->sigma.value[k];
        ndf->value[k] = (float)(peak > 0.0 ? uniform_part + (1.0 - uniform_part) * d / peak : 1.0);
    }
}

/* Scales D so that sigma is 1 at the normal, and returns the divisor. */
static double ndf_scale(const Facets *self) {
    const double whole = projected(self, dir(0.0f, 0.0f, 1.0f));
    for (int k = 0; k < count_of(&self->ndf); k++) self->ndf.value[k] /= (float)whole;
    return whole;
}

/* Fills back and sigma. */
static void fill(Facets *self, int threads) {
    parallel_for(threads, count_of(&self->back), back_set, self);
    parallel_for(threads, count_of(&self->sigma), sigma_set, self);
}

static bool iterate(Facets *self, int threads, double *whole) {
    if (!tables_create(self, ACROSS) || !table_create(&self->ndf, ACROSS, self->source->isotropic)) return false;
    for (int k = 0; k < count_of(&self->ndf); k++) self->ndf.value[k] = 1.0f;
    for (int round = 0; round < ROUNDS; round++) {
        ndf_scale(self);
        fill(self, threads);
        ndf_set(self, &self->ndf);
    }
    *whole = ndf_scale(self);
    return true;
}

bool rgl_facets(const RglSource *source, int threads, Rgl *out) {
    double whole;
    Facets *self = alloc_array(1, sizeof *self);
    if (!self) return false;
    self->source = source;
    normals_make(self);
    const bool made = iterate(self, threads, &whole) && tables_create(self, FINE);
    if (made) {
        fill(self, threads);
        ndf_set(self, &self->back);
        for (int k = 0; k < count_of(&self->back); k++) self->back.value[k] /= (float)whole;
        out->ndf = self->back, out->sigma = self->sigma;
        self->back = self->sigma = (RglTable){0};
    }
    free(self->ndf.value);
    free(self->back.value);
    free(self->sigma.value);
    free(self);
    return made;
}
