/* cholesky.h - small systems of linear equations with a symmetric positive definite matrix */
#ifndef WEFT_BASE_CHOLESKY_H
#define WEFT_BASE_CHOLESKY_H

/* Solves A x = b for each of `columns` columns of b at once: A is n x n and b n x columns, both row by row. Of A only the
 * lower half is read, which L of A = L L^T overwrites; x takes the place of b. */
void cholesky_solve(int n, double *a, int columns, double *b);

#endif
