#include <math.h>
#include <stdlib.h>

#include "brdf/rgl_make.h"

#include "base/memory.h"
#include "base/pi.h"
#include "base/thread.h"

/* Tables of D and sigma: over azimuths where the source is not isotropic, else two equal rows. */
enum { FACETS_ACROSS = 64, FACETS_AROUND = 65, ROUNDS = 8 };

/* The share of D's peak that is even. */
static const double even_share = 0.03;

typedef struct RglMaking {
    const RglSource *source;
    Rgl *rgl;
    float *luminance; /* [slice][y][x] */
    Dir facet[FACETS_AROUND][FACETS_ACROSS];
    double area[FACETS_ACROSS]; /* solid angle of a facet's cell */
} RglMaking;

static Dir direction(double theta, double phi) {
    return dir((float)((sin)(theta) * (cos)(phi)), (float)((sin)(theta) * (sin)(phi)),
               (float)(fmax)((cos)(theta), 0.0));
}

/* Directions at the corners of even cells of u; the first and the last azimuth are one. */
static void facets_make(RglMaking *making) {
    for (int x = 0; x < FACETS_ACROSS; x++) {
        SquarePoint u = {.x = (double)x / (FACETS_ACROSS - 1)};
        double theta, phi, end = x == 0 || x == FACETS_ACROSS - 1 ? 0.5 : 1.0;
        for (int y = 0; y < FACETS_AROUND; y++) {
            u.y = (double)y / (FACETS_AROUND - 1);
            rgl_angles_of(u, &theta, &phi);
            making->facet[y][x] = direction(theta, phi);
        }
        making->area[x] = end * 2.0 * PI_DOUBLE * PI_DOUBLE * u.x * (sin)(theta) / (FACETS_ACROSS - 1) /
                          (FACETS_AROUND - 1);
    }
}

static float *table_cell(const RglTable *table, int y, int x) {
    return &table->value[(size_t)y * (size_t)table->width + (size_t)x];
}

/* The row of a table for azimuth y of the facets. */
static int row_of(const RglTable *table, int y) { return table->height == FACETS_AROUND ? y : 0; }

static double projected(const RglMaking *making, const RglTable *ndf, Dir w) {
    double sum = 0.0;
    for (int y = 0; y + 1 < FACETS_AROUND; y++)
        for (int x = 0; x < FACETS_ACROSS; x++) {
            double cosine = (double)dir_dot(w, making->facet[y][x]);
            if (cosine > 0.0) sum += cosine * making->area[x] * (double)*table_cell(ndf, row_of(ndf, y), x);
        }
    return sum;
}

/* Sets sigma to that of D, at every facet direction. */
static void sigma_set(void *user, int item, int thread) {
    const RglMaking *making = user;
    const Rgl *rgl = making->rgl;
    int y = item / FACETS_ACROSS, x = item % FACETS_ACROSS;
    (void)thread;
    *table_cell(&rgl->sigma, y, x) = (float)projected(making, &rgl->ndf, making->facet[y][x]);
}

/* f cos of light that comes straight back, the mean of the channels. */
static double straight_back(const RglSource *source, Dir w) {
    const float o[3] = {w.x, w.y, (float)(fmax)((double)w.z, 1e-3)};
    float f[1][3];
    source->f(source->user, o, 1, (const float(*)[3])o, f);
    return ((double)f[0][0] + (double)f[0][1] + (double)f[0][2]) / 3.0 * (double)o[2];
}

/* Scales D so that sigma is 1 at the normal. */
static void ndf_scale(const RglMaking *making) {
    const RglTable *ndf = &making->rgl->ndf;
    double whole = projected(making, ndf, dir(0.0f, 0.0f, 1.0f));
    for (int k = 0; k < ndf->width * ndf->height; k++) ndf->value[k] /= (float)whole;
}

static bool facets_solve(RglMaking *making, int threads) {
    Rgl *rgl = making->rgl;
    const int rows = making->source->isotropic ? 1 : FACETS_AROUND, high = rows == 1 ? 2 : rows;
    const size_t n = (size_t)high * FACETS_ACROSS;
    rgl->ndf = (RglTable){FACETS_ACROSS, high, alloc_array(n, sizeof(float))};
    rgl->sigma = (RglTable){FACETS_ACROSS, high, alloc_array(n, sizeof(float))};
    double *back = alloc_array(n, sizeof *back), most = 0.0;
    if (!rgl->ndf.value || !rgl->sigma.value || !back) {
        free(back);
        return false;
    }
    for (int y = 0; y < high; y++)
        for (int x = 0; x < FACETS_ACROSS; x++) {
            double *b = &back[(size_t)y * FACETS_ACROSS + (size_t)x];
            *b = straight_back(making->source, making->facet[rows == 1 ? FACETS_AROUND / 2 : y][x]);
            *table_cell(&rgl->ndf, y, x) = 1.0f;
            most = (fmax)(most, *b);
        }
    for (int round = 0; round < ROUNDS; round++) {
        ndf_scale(making);
        parallel_for(threads, high * FACETS_ACROSS, sigma_set, making);
        double peak = 0.0;
        for (size_t k = 0; k < n; k++) peak = (fmax)(peak, back[k] * (double)rgl->sigma.value[k]);
        for (size_t k = 0; k < n && peak > 0.0; k++)
            rgl->ndf.value[k] =
                (float)(even_share + (1.0 - even_share) * back[k] * (double)rgl->sigma.value[k] / peak);
    }
    ndf_scale(making);
    parallel_for(threads, high * FACETS_ACROSS, sigma_set, making);
    free(back);
    return true;
}

/* Direction of wo of a slice. */
static Dir slice_direction(const Rgl *rgl, int slice) {
    return direction((double)rgl->theta[slice % rgl->thetas], (double)rgl->phi[slice / rgl->thetas]);
}

/* k and q of one m. */
typedef struct Spread {
    double k, q;
} Spread;
static Spread spread_at(const Rgl *rgl, Dir o, SquarePoint u) {
    double theta, phi;
    rgl_angles_of(u, &theta, &phi);
    Dir m = direction(theta, phi + (rgl_isotropic(rgl) ? (double)rgl->phi[0] : 0.0));
    double cosine = (fmax)((double)dir_dot(o, m), 0.0), height = (double)dir_mirror(o, m).z;
    double q2 = cosine * rgl_table_at(&rgl->ndf, u) * u.x * (sin)(theta);
    return (Spread){(fmin)((fmax)(1.0 + 10.0 * height, 0.1), 1.0), (sqrt)((fmax)(q2, 0.0))};
}

/* W's density over u. */
static void normals_fill(const Rgl *rgl, int slice, float *density) {
    const Dir o = slice_direction(rgl, slice);
    const int side = rgl->side;
    double sum = 0.0, of_k = 0.0;
    for (int round = 0; round < 2; round++)
        for (int at = 0; at < side * side; at++) {
            const int column = at % side, row = at / side;
            Spread s =
                spread_at(rgl, o, (SquarePoint){(double)column / (side - 1), (double)row / (side - 1)});
            if (round == 0)
                sum += s.k * s.q, of_k += s.k;
            else
                density[at] = (float)(s.k * (s.q + sum / of_k));
        }
}

/* R of a slice at all s, and the luminance there of f cos_i over the pdf of W, by which samples have even weights.
 * Below the horizon, where nothing is asked for, R goes on as if f were the same on both sides, below 0: so it is
 * straight where f cos_i crosses 0, and its steps do not show there. */
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
        SquarePoint u =
            square_warp_point(&rgl->normals, &own, (double)column / (side - 1), (double)row / (side - 1));
        rgl_angles_of(u, &theta, &phi);
        if (rgl_isotropic(rgl)) phi += azimuth;
        Dir m = direction(theta, phi), i = dir_mirror(o, m);
        const float wi[1][3] = {{i.x, i.y, (float)(fabs)((double)i.z)}};
        float f[1][3];
        making->source->f(making->source->user, wo, 1, wi, f);
        double scale = sigma * (double)i.z / rgl_table_at(&rgl->ndf, u);
        for (size_t c = 0; c < 3; c++) color[c * n + k] = (float)((double)f[0][c] * scale);
        double area = u.x * (sin)(theta) *
                      (fmax)((double)dir_dot(o, m), 0.0); /* of wi for one of u, times a constant */
        double bright = 0.2126 * (double)f[0][0] + 0.7152 * (double)f[0][1] + 0.0722 * (double)f[0][2];
        luminance[k] =
            (float)((fmax)(bright * (double)i.z * area, 0.0) / square_warp_density(&rgl->normals, &own, u));
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
    for (int k = 0; k < rgl->thetas; k++)
        rgl->theta[k] = (float)(89.0 / 180.0 * PI_DOUBLE * k / (rgl->thetas - 1));
    for (int k = 0; k < rgl->phis && rgl->phis > 1; k++)
        rgl->phi[k] = (float)(PI_DOUBLE * (2.0 * k / (rgl->parts * (rgl->phis - 1)) - 1.0));
    return true;
}

bool rgl_make(const RglSource *source, const RglDesc *desc, Rgl *out) {
    *out = (Rgl){0};
    RglMaking *making = alloc_array(1, sizeof *making);
    bool made = making && axes_make(out, source, desc);
    const int slices = out->phis * out->thetas;
    const size_t n = (size_t)out->side * (size_t)out->side;
    if (made) {
        making->source = source;
        making->rgl = out;
        facets_make(making);
        made = facets_solve(making, desc->threads);
    }
    float *normals = made ? alloc_array((size_t)slices * n, sizeof *normals) : NULL;
    for (int slice = 0; normals && slice < slices; slice++)
        normals_fill(out, slice, normals + (size_t)slice * n);
    made = normals && square_warp_create(&out->normals, out->side, out->side, (size_t)slices, normals);
    out->color = made ? alloc_array((size_t)slices * 3 * n, sizeof *out->color) : NULL;
    if (made) making->luminance = alloc_array((size_t)slices * n, sizeof *making->luminance);
    made = made && out->color && making->luminance;
    if (made) {
        parallel_for(desc->threads, slices, colors_fill, making);
        made = square_warp_create(&out->luminance, out->side, out->side, (size_t)slices, making->luminance);
    } else if (making) {
        free(making->luminance);
    }
    free(making);
    return made;
}
