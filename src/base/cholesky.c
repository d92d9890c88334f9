#include "base/cholesky.h"

#include <math.h>

/* A = L L^T: l_ij = (a_ij - sum_(k<j) l_ik l_jk) / l_jj, and l_ii is the root of what is left of a_ii. */
static void split(int n, double *a) {
    for (int i = 0; i < n; i++)
        for (int j = 0; j <= i; j++) {
            double *to = &a[i * n + j];
            for (int k = 0; k < j; k++) *to -= a[i * n + k] * a[j * n + k];
            *to = i == j ? sqrt(*to) : *to / a[j * n + j];
        }
}

void cholesky_solve(int n, double *a, int columns, double *b) {
    split(n, a);
    for (int c = 0; c < columns; c++) {
        double *x = b + c;
        for (int i = 0; i < n; i++) {
            for (int k = 0; k < i; k++) x[i * columns] -= a[i * n + k] * x[k * columns];
            x[i * columns] /= a[i * n + i];
        }
        for (int i = n - 1; i >= 0; i--) {
            for (int k = i + 1; k < n; k++) x[i * columns] -= a[k * n + i] * x[k * columns];
            x[i * columns] /= a[i * n + i];
        }
    }
}
