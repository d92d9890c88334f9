#include <stdlib.h>

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

double chi_square_bins(Bin *bins, int count) {
    const double least = 8.0; /* expected in a bin, for the distribution to hold */
    qsort(bins, (size_t)count, sizeof *bins, by_expectation);
    double statistic = 0.0;
    int used = 0;
    Bin pool = {0};
    for (int k = 0; k < count; k++) {
        pool.expected += bins[k].expected;
        pool.seen += bins[k].seen;
        if (pool.expected < least && k + 1 < count) continue;
        double d = pool.seen - pool.expected;
        if (pool.expected > 0.0)
            statistic += d * d / pool.expected;
        else if (pool.seen > 0.0)
            return 0.0;
        used++;
        pool = (Bin){0};
    }
    return used > 1 ? chi_square_tail(statistic, used - 1) : 1.0;
}

/* Bins along a side of the grid; the last of all counts "no sample". */
enum { BINS = 20, ALL_BINS = BINS * BINS + 1 };

static double expect(const BsdfView *view, const Grid *grid, Bin *bins) {
    Ring ring;
    float pdf[GRID_MAX];
    double all = 0.0;
    int cells = grid->cells / BINS;
    for (int row = 0; row < grid->cells; row++) {
        Dirs dirs = grid_ring(grid, row, &ring);
        view->bsdf->pdf(view, dirs, pdf);
        for (int c = 0; c < grid->cells; c++) {
            double share = (double)pdf[c] * ring.area[c];
            bins[row / cells * BINS + c / cells].expected += share;
            all += share;
        }
    }
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
    grid_make(&grid, view->o, BINS * cells);
    *out = (ChiSquare){.integral = expect(view, &grid, bins)};
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
    for (int k = 0; k + 1 < ALL_BINS; k++) bins[k].expected *= count;
    bins[ALL_BINS - 1] = (Bin){fmax(1.0 - out->integral, 0.0) * count, (double)(count - above)};
    out->p = chi_square_bins(bins, ALL_BINS);
    free(bins);
    return true;
}
