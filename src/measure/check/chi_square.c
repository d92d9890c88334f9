#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "measure/check/chi_square.h"

#include "base/memory.h"
#include "measure/bsdf/draw.h"

/* Approximates the tail: Edwin B. Wilson, Margaret M. Hilferty, "The Distribution of Chi-square", 1931. */
double chi_square_tail(double statistic, int freedom) {
    double v = 2.0 / (9.0 * freedom), z = (cbrt(statistic / freedom) - (1.0 - v)) / (sqrt)(v);
    return 0.5 * erfc(z / (sqrt)(2.0));
}

static int by_expectation(const void *a, const void *b) {
    double x = ((const Bin *)a)->expected, y = ((const Bin *)b)->expected;
    return (x > y) - (x < y);
}

/* Returns p of the sum of (seen - expected)^2 over the variance: that of a count, which is the expected
 * number, plus the square of the error. */
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

/* Bins along a side of the grid; the last of all counts samples that are none. */
enum { BINS = 20, ALL_BINS = BINS * BINS + 1, LINES_MOST = BINS * GRID_MAX };

/* The points of a bin: n by n, one in each cell, and no two of them in one row or one column of the n^2 into which a
 * side of the bin is cut. With only n rows of points an edge of the pdf along a row or a column could pass between two
 * of them undetected, in all bins that it crosses.
 *
 *   s = (i + (p_j + 1/2) / n) / n,  t = (j + (n - 1/2 - p_i) / n) / n,  i, j = 0 .. n - 1,  p_k = m k mod n
 *
 * m is the first number from n / golden ratio^2 up that is coprime to n, so that neighbours lie far apart: a rank-1
 * lattice in each row. The shifts of columns cancel what the shifts of rows add to the integral of s t. */
typedef struct Net {
    int n, place[GRID_MAX]; /* p */
    GridLine rows[LINES_MOST], columns[LINES_MOST];
} Net;

static int common_divisor(int a, int b) { return b ? common_divisor(b, a % b) : a; }

static void net_make(Net *net, const Grid *grid, int n) {
    int step = (int)(0.381966 * n + 0.5), lines = BINS * n * n;
    while (step > 1 && common_divisor(step, n) > 1) step++;
    net->n = n;
    for (int k = 0; k < n; k++) net->place[k] = step * k % n;
    for (int k = 0; k < lines; k++) {
        double place = -1.0 + 2.0 * (k + 0.5) / lines;
        net->rows[k] = grid_row(grid, place), net->columns[k] = grid_column(grid, place);
    }
}

/* Fills `points` with those of a bin, each with its share of the bin's solid angle. */
static Dirs net_points(const Net *net, int bin, Ring *points) {
    int n = net->n, up = bin / BINS * n * n, across = bin % BINS * n * n;
    double area = 4.0 / ((double)BINS * BINS * n * n);
    for (int k = 0; k < n * n; k++) {
        int i = k / n, j = k % n;
        const GridLine *row = &net->rows[up + i * n + net->place[j]];
        const GridLine *column = &net->columns[across + j * n + n - 1 - net->place[i]];
        points->x[k] = row->sine * column->cosine;
        points->y[k] = row->sine * column->sine;
        points->z[k] = row->cosine;
        points->area[k] = area * row->slope * column->slope;
    }
    return (Dirs){(size_t)(n * n), points->x, points->y, points->z};
}

/* Integrates the pdf over each bin by n by n points; returns the integral over all. */
static double integrate(const BsdfView *view, Net *net, const Grid *grid, int n, double shares[BINS * BINS]) {
    Ring points;
    float pdf[GRID_MAX];
    double all = 0.0;
    net_make(net, grid, n);
    for (int bin = 0; bin < BINS * BINS; bin++) {
        Dirs dirs = net_points(net, bin, &points);
        view->bsdf->pdf(view, dirs, pdf);
        shares[bin] = 0.0;
        for (size_t k = 0; k < dirs.n; k++) shares[bin] += (double)pdf[k] * points.area[k];
        all += shares[bin];
    }
    return all;
}

/* Fills the bins with what `count` samples are expected to be. Returns the integral of the pdf.
 *
 * The error e of n points at a side is a third of how far n / 2 are from them, whichever is integrated:
 *   a smooth pdf   e = C / n^2, so that of n / 2 is 4 e, of the same sign, and they differ by 3 e;
 *   an edge        crosses about n cells, each off by 1 / n^2 of the bin and either sign: e^2 goes as n / n^4, so
 *                  that of n / 2 is 8 e^2, and the square of the difference is (8 + 1) e^2 on average. */
static double expect(const BsdfView *view, Net *net, const Grid *grid, int n, int count, Bin bins[ALL_BINS]) {
    double fine[BINS * BINS], coarse[BINS * BINS], part = count / 3.0;
    double all = integrate(view, net, grid, n, fine), about = integrate(view, net, grid, n / 2, coarse);
    for (int k = 0; k + 1 < ALL_BINS; k++)
        bins[k] = (Bin){.expected = fine[k] * count, .error = fabs(fine[k] - coarse[k]) * part};
    bins[ALL_BINS - 1] = (Bin){.expected = fmax(1.0 - all, 0.0) * count, .error = fabs(all - about) * part};
    return all;
}

/* Counts a block of samples, whose pdf is evaluated at once. */
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
    Net *net = alloc_array(1, sizeof *net);
    Bin *bins = alloc_array(ALL_BINS, sizeof *bins);
    bool allocated = net && bins;
    if (allocated) {
        grid_make(&grid, view->o, BINS);
        *out = (ChiSquare){.integral = expect(view, net, &grid, cells, count, bins)};
    }
    Draw draw = draw_start(seed, 1);
    int above = 0, waiting = 0;
    for (int k = 0; allocated && k < count; k++) {
        float u = draw_unit(&draw), v = draw_unit(&draw);
        Dir i = view->bsdf->sample(view, u, v);
        if (i.z > 0.0f) {
            block.x[waiting] = i.x, block.y[waiting] = i.y, block.z[waiting] = i.z;
            waiting++, above++;
        }
        if (waiting == GRID_MAX || k + 1 == count) {
            count_block(view, &grid, (Dirs){(size_t)waiting, block.x, block.y, block.z}, bins, out);
            waiting = 0;
        }
    }
    if (allocated) {
        bins[ALL_BINS - 1].seen = (double)(count - above);
        out->p = chi_square_bins(bins, ALL_BINS);
    }
    free(bins);
    free(net);
    return allocated;
}
