#include "base/matrix.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

/* A tile of C, TALL x WIDE sums, stays in registers while k runs over a column of A's panel and a row of B's at a
 * time. Panels are copied first, so that the loop reads consecutive memory. Kazushige Goto, Robert van de Geijn,
 * "Anatomy of High-Performance Matrix Multiplication", ACM TOMS 34(3), 2008. */
enum { TALL = 8, WIDE = 6, LANES = 4, BLOCK = 48 };
typedef double MatrixLanes __attribute__((vector_size(LANES * sizeof(double))));

static void tile(int k, const double *restrict a, const double *restrict b, double sums[WIDE][TALL]) {
    MatrixLanes sum[WIDE][2] = {0};
    for (int p = 0; p < k; p++, a += TALL, b += WIDE) {
        MatrixLanes low, high;
        memcpy(&low, a, sizeof low);
        memcpy(&high, a + LANES, sizeof high);
        for (int j = 0; j < WIDE; j++) {
            sum[j][0] += low * b[j];
            sum[j][1] += high * b[j];
        }
    }
    memcpy(sums, sum, sizeof sum);
}

/* Copies rows first .. first + height into a panel, side by side for each p; rows past the end are 0. */
static void pack(int first, int count, int height, int k, const double *at, int along, int across, double *out) {
    for (int p = 0; p < k; p++)
        for (int r = 0; r < height; r++)
            *out++ = first + r < count ? at[(long)(first + r) * along + (long)p * across] : 0.0;
}

bool matrix_product(int m, int n, int k, double factor, Matrix a, Matrix b, double keep, double *c, int stride) {
    int panels = (m + TALL - 1) / TALL;
    double *block = alloc_array((size_t)k * ((size_t)panels * TALL + WIDE), sizeof *block);
    if (!block) return false;
    double *right = block + (size_t)k * (size_t)panels * TALL;
    for (int i = 0; i < panels; i++)
        pack(i * TALL, m, TALL, k, a.at, a.row, a.column, block + (size_t)k * TALL * (size_t)i);
    for (int j = 0; j < n; j += WIDE) {
        pack(j, n, WIDE, k, b.at, b.column, b.row, right);
        for (int i = 0; i < panels; i++) {
            double sums[WIDE][TALL];
            tile(k, block + (size_t)k * TALL * (size_t)i, right, sums);
            int tall = m - i * TALL < TALL ? m - i * TALL : TALL, wide = n - j < WIDE ? n - j : WIDE;
            for (int q = 0; q < wide; q++) {
                double *column = c + (size_t)(j + q) * (size_t)stride + (size_t)i * TALL;
                for (int r = 0; r < tall; r++) column[r] = (keep != 0.0 ? keep * column[r] : 0.0) + factor * sums[q][r];
            }
        }
    }
    free(block);
    return true;
}

/* Factors blocks of columns from the left: subtracts the contribution of earlier columns, factors the square on the
 * diagonal, and solves below it. */
bool matrix_factor(int n, double *a, int stride) {
    for (int first = 0; first < n; first += BLOCK) {
        int width = n - first < BLOCK ? n - first : BLOCK;
        double *corner = a + (size_t)first * (size_t)stride + first;
        if (first > 0 && !matrix_product(n - first, width, first, -1.0, (Matrix){a + first, 1, stride},
                                         (Matrix){a + first, stride, 1}, 1.0, corner, stride))
            return false;
        for (int j = 0; j < width; j++) {
            double *column = corner + (size_t)j * (size_t)stride;
            for (int p = 0; p < j; p++) {
                const double *left = corner + (size_t)p * (size_t)stride;
                for (int i = j; i < n - first; i++) column[i] -= left[i] * left[j];
            }
            if (!(column[j] > 0.0)) return false;
            double root = sqrt(column[j]);
            for (int i = j; i < n - first; i++) column[i] /= root;
        }
    }
    return true;
}

/* Solves L Y = X from the top and L^T Z = Y from the bottom, a block of rows at a time. */
bool matrix_solve(int n, const double *l, int stride, int count, double *x, int x_stride) {
    for (int first = 0; first < n; first += BLOCK) {
        int height = n - first < BLOCK ? n - first : BLOCK;
        if (first > 0 && !matrix_product(height, count, first, -1.0, (Matrix){l + first, 1, stride},
                                         (Matrix){x, 1, x_stride}, 1.0, x + first, x_stride))
            return false;
        for (int c = 0; c < count; c++) {
            double *y = x + (size_t)c * (size_t)x_stride + first;
            for (int j = 0; j < height; j++) {
                const double *column = l + (size_t)(first + j) * (size_t)stride + first;
                y[j] /= column[j];
                for (int i = j + 1; i < height; i++) y[i] -= column[i] * y[j];
            }
        }
    }
    for (int first = (n - 1) / BLOCK * BLOCK; first >= 0; first -= BLOCK) {
        int height = n - first < BLOCK ? n - first : BLOCK, below = n - first - height;
        const double *under = l + (size_t)first * (size_t)stride + first + height;
        if (below > 0 && !matrix_product(height, count, below, -1.0, (Matrix){under, stride, 1},
                                         (Matrix){x + first + height, 1, x_stride}, 1.0, x + first, x_stride))
            return false;
        for (int c = 0; c < count; c++) {
            double *y = x + (size_t)c * (size_t)x_stride + first;
            for (int j = height - 1; j >= 0; j--) {
                const double *column = l + (size_t)(first + j) * (size_t)stride + first;
                for (int i = j + 1; i < height; i++) y[j] -= column[i] * y[i];
                y[j] /= column[j];
            }
        }
    }
    return true;
}
