/* matrix.h - products and solutions of dense matrices, on one thread
 *
 * Here because the packaged OpenBLAS without threads may not be called from two at once, and the one with
 * threads makes its own for the whole process. A matrix is where it begins and the strides from row to row
 * and from column to column. */
#ifndef WEFT_BASE_MATRIX_H
#define WEFT_BASE_MATRIX_H

#include <stdbool.h>

typedef struct Matrix {
    const double *at;
    int row, column; /* strides */
} Matrix;

/* C (m x n, its columns `stride` apart) = keep C + factor A B, over k. False where memory is short. */
bool matrix_product(int m, int n, int k, double factor, Matrix a, Matrix b, double keep, double *c,
                    int stride);

/* A = L L^T of a symmetric positive matrix, in place in its lower half, columns `stride` apart; false where
 * it is not positive, or memory is short. */
bool matrix_factor(int n, double *a, int stride);

/* X = (L L^T)^-1 X for `count` columns, `x_stride` apart. */
bool matrix_solve(int n, const double *l, int stride, int count, double *x, int x_stride);

#endif
