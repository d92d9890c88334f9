/* matrix.h - products and solutions of dense matrices, on one thread
 *
 * OpenBLAS does not serve here: the packaged one without threads must not be called from two threads at the same
 * time, and the one with threads makes its own for the whole process. */
#pragma once

#include <stdbool.h>

typedef struct Matrix {
    const double *at; /* first element */
    int row, column;  /* strides from row to row and from column to column */
} Matrix;

/* Computes C = keep C + factor A B, where A is m x k, B k x n and C m x n with columns `stride` apart. Returns false
 * if memory is short. */
bool matrix_product(int m, int n, int k, double factor, Matrix a, Matrix b, double keep, double *c, int stride);

/* Factors a symmetric positive definite A = L L^T in place in its lower half, columns `stride` apart. Returns false if
 * A is not positive definite or memory is short. */
bool matrix_factor(int n, double *a, int stride);

/* Computes X = (L L^T)^-1 X for `count` columns, `x_stride` apart. Returns false if memory is short. */
bool matrix_solve(int n, const double *l, int stride, int count, double *x, int x_stride);
