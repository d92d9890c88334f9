#include "measure/check/weight.h"

#include "base/pi.h"

double weight_albedo(const BsdfView *view, int cells) {
    Grid grid;
    Ring ring;
    float f[GRID_MAX];
    double sum = 0.0;
    grid_make(&grid, view->o, cells);
    for (int row = 0; row < cells; row++) {
        Dirs dirs = grid_ring(&grid, row, &ring);
        view->bsdf->f(view, dirs, f);
        for (int c = 0; c < cells; c++) sum += (double)f[c] * (double)ring.z[c] * ring.area[c];
    }
    return sum;
}

/* Measures the variance. With w = f cos / pdf and P the integral of the pdf:
 *
 *   variance = integral of pdf (w - E)^2 + (1 - P) E^2
 *
 * The fraction 1 - P of the samples finds nothing. In this form a constant w gives exactly 0, not a difference. */
Weight weight_measure(const BsdfView *view, int cells) {
    Grid grid;
    Ring ring;
    float f[GRID_MAX], pdf[GRID_MAX];
    Weight sum = {.albedo = weight_albedo(view, cells)};
    double found = 0.0, e = sum.albedo;
    grid_make(&grid, view->o, cells);
    for (int row = 0; row < cells; row++) {
        Dirs dirs = grid_ring(&grid, row, &ring);
        view->bsdf->f(view, dirs, f);
        view->bsdf->pdf(view, dirs, pdf);
        for (int c = 0; c < cells; c++) {
            double p = (double)pdf[c], f_cos = (double)f[c] * (double)ring.z[c], q = (double)ring.z[c] / PI_DOUBLE;
            double d = p > 0.0 ? f_cos / p - e : 0.0, b = f_cos / q - e;
            sum.own += p * d * d * ring.area[c];
            sum.by_cosine += q * b * b * ring.area[c];
            found += p * ring.area[c];
            if (!(p > 0.0)) sum.missed += f_cos * ring.area[c];
        }
    }
    sum.own += fmax(1.0 - found, 0.0) * e * e;
    return sum;
}
