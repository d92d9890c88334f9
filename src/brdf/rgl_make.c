#include <math.h>
#include <stdlib.h>

#include "brdf/rgl_make.h"

#include "base/memory.h"
#include "base/pi.h"
#include "base/thread.h"

typedef struct RglMaking {
    const RglSource *source;
    Rgl *rgl;
    float *luminance; /* [slice][y][x] */
} RglMaking;

/* Returns wo of a slice. */
static Dir slice_direction(const Rgl *rgl, int slice) {
    return rgl_direction((double)rgl->theta[slice % rgl->thetas], (double)rgl->phi[slice / rgl->thetas]);
}

/* k and q of one m. */
typedef struct Spread {
    double k, q;
} Spread;
static Spread spread_at(const Rgl *rgl, Dir o, SquarePoint u) {
    double theta, phi;
    rgl_angles_of(u, &theta, &phi);
    Dir m = rgl_direction(theta, phi + (rgl_isotropic(rgl) ? (double)rgl->phi[0] : 0.0));
    double cosine = (fmax)((double)dir_dot(o, m), 0.0), height = (double)dir_mirror(o, m).z;
    double q2 = cosine * rgl_table_at(&rgl->ndf, u) * u.x * (sin)(theta);
    return (Spread){(fmin)((fmax)(1.0 + 10.0 * height, 0.1), 1.0), (sqrt)((fmax)(q2, 0.0))};
}

/* Computes the density over u whose warp is W. */
static void normals_fill(const Rgl *rgl, int slice, float *density) {
    const Dir o = slice_direction(rgl, slice);
    const int side = rgl->side;
    double sum = 0.0, of_k = 0.0;
    for (int round = 0; round < 2; round++)
        for (int at = 0; at < side * side; at++) {
            const int column = at % side, row = at / side;
            Spread s = spread_at(rgl, o, (SquarePoint){(double)column / (side - 1), (double)row / (side - 1)});
            if (round == 0)
                sum += s.k * s.q, of_k += s.k;
            else
                density[at] = (float)(s.k * (s.q + sum / of_k));
        }
}

/* Computes R of a slice at all s, and the luminance of f cos_i over the pdf of W there, which gives samples uniform
 * weights. Below the horizon, where R is not evaluated, it continues with f of the mirrored wi and is negative, so that
 * it is straight where f cos_i crosses 0 and linear interpolation is exact there. */
static void colors_fill(void *user, int slice, int thread) {
    const RglMaking *making = user;
    const Rgl *rgl = making->rgl;
    const SliceBlend own = {.count = 1, .slice = {(size_t)slice}, .weight = {1.0}};
    const Dir o = slice_direction(rgl, slice);
    const float wo[3] = {o.x, o.y, o.z};
    const int side = rgl->side;
    const size_t n = (size_t)side * (size_t)side;
    const double azimuth = (double)rgl->phi[slice / rgl->thetas];
    const double sigma =
        4.0 * rgl_table_at(&rgl->sigma, rgl_square_of((double)rgl->theta[slice % rgl->thetas], azimuth));
    float *color = rgl->color + (size_t)slice * 3 * n, *luminance = making->luminance + (size_t)slice * n;
    (void)thread;
    for (size_t k = 0; k < n; k++) {
        double theta, phi;
        const size_t column = k % (size_t)side, row = k / (size_t)side;
        SquarePoint u = square_warp_point(&rgl->normals, &own, (double)column / (side - 1), (double)row / (side - 1));
        rgl_angles_of(u, &theta, &phi);
        if (rgl_isotropic(rgl)) phi += azimuth;
        Dir m = rgl_direction(theta, phi), i = dir_mirror(o, m);
        const float wi[1][3] = {{i.x, i.y, (float)(fabs)((double)i.z)}};
        float f[1][3];
        making->source->f(making->source->user, wo, 1, wi, f);
        double scale = sigma * (double)i.z / rgl_table_at(&rgl->ndf, u);
        for (size_t c = 0; c < 3; c++) color[c * n + k] = (float)((double)f[0][c] * scale);
        double area = u.x * (sin)(theta) * (fmax)((double)dir_dot(o, m), 0.0); /* dwi / du, up to a constant */
        double bright = 0.2126 * (double)f[0][0] + 0.7152 * (double)f[0][1] + 0.0722 * (double)f[0][2];
        luminance[k] = (float)((fmax)(bright * (double)i.z * area, 0.0) / square_warp_density(&rgl->normals, &own, u));
    }
}

static bool axes_make(Rgl *rgl, const RglSource *source, const RglDesc *desc) {
    rgl->thetas = desc->thetas;
    rgl->phis = source->isotropic ? 1 : desc->phis;
    rgl->side = desc->side;
    rgl->parts = source->isotropic ? 1 : source->parts;
    rgl->theta = alloc_array((size_t)rgl->thetas, sizeof *rgl->theta);
    rgl->phi = alloc_array((size_t)rgl->phis, sizeof *rgl->phi);
    if (!rgl->theta || !rgl->phi) return false;
    for (int k = 0; k < rgl->thetas; k++) { /* denser at grazing angles, where f changes faster */
        const double x = (double)k / (rgl->thetas - 1);
        rgl->theta[k] = (float)(89.0 * RADIANS * (0.7 * x + 0.3 * (sin)(0.5 * PI_DOUBLE * x)));
    }
    for (int k = 0; k < rgl->phis && rgl->phis > 1; k++)
        rgl->phi[k] = (float)(PI_DOUBLE * (2.0 * k / (rgl->parts * (rgl->phis - 1)) - 1.0));
    return true;
}

static void slices_free(Rgl *self) {
    const Rgl facets = {.ndf = self->ndf, .sigma = self->sigma};
    self->ndf = self->sigma = (RglTable){0};
    rgl_free(self);
    *self = facets;
}

bool rgl_make(const RglSource *source, const RglDesc *desc, Rgl *out) {
    RglMaking making = {.source = source, .rgl = out};
    slices_free(out);
    if (!axes_make(out, source, desc)) return false;
    const int slices = out->phis * out->thetas;
    const size_t n = (size_t)out->side * (size_t)out->side;
    float *normals = alloc_array((size_t)slices * n, sizeof *normals);
    for (int slice = 0; normals && slice < slices; slice++) normals_fill(out, slice, normals + (size_t)slice * n);
    if (!square_warp_create(&out->normals, out->side, out->side, (size_t)slices, normals)) return false;
    out->color = alloc_array((size_t)slices * 3 * n, sizeof *out->color);
    making.luminance = out->color ? alloc_array((size_t)slices * n, sizeof *making.luminance) : NULL;
    if (making.luminance) parallel_for(desc->threads, slices, colors_fill, &making);
    return square_warp_create(&out->luminance, out->side, out->side, (size_t)slices, making.luminance);
}
