#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "measure/chi_square.h"

#include "base/memory.h"
#include "measure/draw.h"

/* Edwin B. Wilson, Margaret M. Hilferty, "The Distribution of Chi-square", 1931. */
double chi_square_tail(double statistic, int freedom) {
    double v = 2.0 / (9.0 * freedom), z = (cbrt(statistic / freedom) - (1.0 - v)) / (sqrt)(v);
    return 0.5 * erfc(z / (sqrt)(2.0));
}

static int by_expectation(const void *a, const void *b) {
    double x = ((const Bin *)a)->expected, y = ((const Bin *)b)->expected;
    return (x > y) - (x < y);
}

/* The statistic is the sum of (seen - expected)^2 over the variance: of a count, which is what is expected, and the square
 * of the error. */
double chi_square_bins(Bin *bins, int count) {
    const double least = 8.0; /* expected in a bin, for the distribution to hold */
    qsort(bins, (size_t)count, sizeof *bins, by_expectation);
    double statistic = 0.0;
    int used = 0;
    Bin pool = {0};
    for (int k = 0; k < count; k++) {
        pool.expected += bins[k].expected;
        pool.error += bins[k].error;
        pool.seen += bins[k].seen;
        if (pool.expected < least && k + 1 < count) continue;
        double d = pool.seen - pool.expected;
        if (pool.expected > 0.0)
            statistic += d * d / (pool.expected + pool.error * pool.error);
        else if (pool.seen > 0.0)
            return 0.0;
        used++;
        pool = (Bin){0};
    }
    return used > 1 ? chi_square_tail(statistic, used - 1) : 1.0;
}

/* Bins along a side of the grid; the last of all counts "no sample". */
enum { BINS = 20, ALL_BINS = BINS * BINS + 1 };

/* Integrates the pdf over each bin by that many points along a side; returns the integral over all. */
static double integrate(const BsdfView *view, int cells, double shares[BINS * BINS]) {
    Grid grid;
    Ring ring;
    float pdf[GRID_MAX];
    double all = 0.0;
    grid_make(&grid, view->o, BINS * cells);
    memset(shares, 0, BINS * BINS * sizeof *shares);
    for (int row = 0; row < grid.cells; row++) {
        Dirs dirs = grid_ring(&grid, row, &ring);
        view->bsdf->pdf(view, dirs, pdf);
        for (int c = 0; c < grid.cells; c++) {
            double share = (double)pdf[c] * ring.area[c];
            shares[row / cells * BINS + c / cells] += share;
            all += share;
        }
    }
    return all;
}

/* Fills the bins with what `count` samples are expected to be. Returns the integral of the pdf. */
static double expect(const BsdfView *view, int cells, int count, Bin bins[ALL_BINS]) {
    double fine[BINS * BINS], coarse[BINS * BINS];
    double all = integrate(view, cells, fine), about = integrate(view, cells / 2, coarse);
    for (int k = 0; k + 1 < ALL_BINS; k++)
        bins[k] = (Bin){.expected = fine[k] * count, .error = fabs(fine[k] - coarse[k]) * count};
    bins[ALL_BINS - 1] = (Bin){.expected = fmax(1.0 - all, 0.0) * count, .error = fabs(all - about) * count};
    return all;
}

/* A block of samples' pdf at once. */
static void count_block(const BsdfView *view, const Grid *grid, Dirs dirs, Bin *bins, ChiSquare *out) {
    float pdf[GRID_MAX];
    view->bsdf->pdf(view, dirs, pdf);
    for (size_t k = 0; k < dirs.n; k++) {
        bins[grid_bin(grid, dir(dirs.x[k], dirs.y[k], dirs.z[k]), BINS)].seen += 1.0;
        out->stray += !(pdf[k] > 0.0f);
    }
}

bool chi_square_measure(const BsdfView *view, int count, int cells, uint32_t seed, ChiSquare *out) {
    Grid grid;
    Ring block;
    Bin *bins = alloc_array(ALL_BINS, sizeof *bins);
    if (!bins) return false;
    grid_make(&grid, view->o, BINS);
    *out = (ChiSquare){.integral = expect(view, cells, count, bins)};
    Draw draw = draw_start(seed, 1);
    int above = 0, held = 0;
    for (int k = 0; k < count; k++) {
        float u = draw_unit(&draw), v = draw_unit(&draw);
        Dir i = view->bsdf->sample(view, u, v);
        if (i.z > 0.0f) {
            block.x[held] = i.x, block.y[held] = i.y, block.z[held] = i.z;
            held++, above++;
        }
        if (held == GRID_MAX || k + 1 == count) {
            count_block(view, &grid, (Dirs){(size_t)held, block.x, block.y, block.z}, bins, out);
            held = 0;
        }
    }
    bins[ALL_BINS - 1].seen = (double)(count - above);
    out->p = chi_square_bins(bins, ALL_BINS);
    free(bins);
    return true;
}
