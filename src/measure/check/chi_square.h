/* chi_square.h - chi-square test of samples against their pdf */
#pragma once

#include "measure/bsdf/grid.h"

typedef struct ChiSquare {
    double integral; /* of the pdf over the hemisphere */
    double p;        /* of the counts; 1 if there is only one bin to count */
    int stray;       /* samples above the horizon with a pdf of 0 */
} ChiSquare;

/* Draws `count` samples and compares them with the pdf, which is integrated by `cells` by `cells` points in
 * each of 20 by 20 bins, and by half as many at a side to estimate the error. cells is even and at most 20.
 * Returns false if memory is short. */
bool chi_square_measure(const BsdfView *view, int count, int cells, uint32_t seed, ChiSquare *out);

/* Returns the upper tail of the chi-square distribution. */
double chi_square_tail(double statistic, int freedom);

/* A bin: the expected number of samples, its error, and the counted number. */
typedef struct Bin {
    double expected, error, seen;
} Bin;

/* Returns p of the counts. Bins that expect few samples are counted together. Sorts the bins. */
double chi_square_bins(Bin *bins, int count);
