/* kernel.h - separable filters: weighted sums over neighbours along one axis */
#pragma once

#include <stddef.h>

/* The largest radius, and the neighbours that are summed in one pass. */
enum { KERNEL_RADIUS = 70, KERNEL_STEP = 4, KERNEL_TAPS = 2 * KERNEL_RADIUS + KERNEL_STEP };

/* weight[k] belongs to the neighbour k - radius away; all others are 0. */
typedef struct Kernel {
    int radius;
    float weight[KERNEL_TAPS];
} Kernel;

/* Lists the rows of a plane that a sum for row y needs, from y - radius on. Beyond the plane its edge repeats. */
static inline void kernel_rows(const float *plane, int width, int height, int y, int radius,
                               const float *rows[KERNEL_TAPS]) {
    for (int k = 0; k <= 2 * radius; k++) {
        const int row = y + k - radius;
        rows[k] = plane + (size_t)(row < 0 ? 0 : row < height ? row : height - 1) * (size_t)width;
    }
}

/* Lists copies of a row shifted pixel by pixel, so that a sum runs along it. The row is row[0] .. row[width - 1]; the
 * radius values before and after it are set to its ends. */
static inline void kernel_shifts(float *row, int width, int radius, const float *rows[KERNEL_TAPS]) {
    for (int k = 1; k <= radius; k++) {
        row[-k] = row[0];
        row[width - 1 + k] = row[width - 1];
    }
    for (int k = 0; k <= 2 * radius; k++) rows[k] = row + k - radius;
}

/* Computes to[x] = sum over k of weight[k] rows[k][x] for x in [first, end). */
static inline void kernel_sum(const Kernel *kernel, const float *const *rows, int first, int end, float *restrict to) {
    const int taps = 2 * kernel->radius + 1;
    for (int x = first; x < end; x++) to[x] = 0.0f;
    for (int k = 0; k < taps; k += KERNEL_STEP) {
        const float *w = kernel->weight + k, *r[KERNEL_STEP]; /* weights are 0 from taps on */
        for (int i = 0; i < KERNEL_STEP; i++) r[i] = rows[k + i < taps ? k + i : k];
#pragma omp simd
        for (int x = first; x < end; x++) {
            float sum = to[x];
            for (int i = 0; i < KERNEL_STEP; i++) sum += w[i] * r[i][x];
            to[x] = sum;
        }
    }
}
