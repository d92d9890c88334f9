/* Wang, Bovik, Sheikh, Simoncelli, "Image Quality Assessment: From Error Visibility to Structural
 * Similarity", IEEE Transactions on Image Processing 13 (4), 2004. With the weights w of a window,
 *
 *   mu_x      = sum w x                                        (14)
 *   sigma_x^2 = sum w (x - mu_x)^2 = sum w x^2 - mu_x^2        (15)
 *   sigma_xy  = sum w (x - mu_x) (y - mu_y) = sum w x y - mu_x mu_y       (16)
 *
 *           2 mu_x mu_y + C1            2 sigma_xy + C2
 *   SSIM = ----------------------  ---------------------------  (13)
 *          mu_x^2 + mu_y^2 + C1    sigma_x^2 + sigma_y^2 + C2
 *
 * C1 = (0.01 L)^2, C2 = (0.03 L)^2 and L = 1; w is a Gaussian of sigma 1.5 on 11 x 11 pixels, whose sum is 1.
 * Either factor is computed as 1 - (denominator - numerator) / denominator; the differences are (mu_x - mu_y)^2 and the
 * variance of x - y, so that equal pictures give exactly 1. x and y are luma: 0.2126 r + 0.7152 g + 0.0722 b of
 * sRGB-encoded values. Beyond the picture its outermost pixels repeat. */
#include "image/ssim.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "base/thread.h"
#include "image/kernel.h"
#include "image/power.h"

/* The quantities summed over windows: x, y, x^2 + y^2, (x - y)^2. */
enum { QUANTITIES = 4, LINES = QUANTITIES + 1 };

typedef struct Ssim {
    const Pair *pair;
    Kernel kernel;
    float *planes[QUANTITIES];
    float *lines; /* of each thread: one with a margin of the radius, and one for each quantity */
    size_t stride;
    float *map;
} Ssim;

static inline float encode(float linear) {
    const float low = 12.92f * linear, high = 1.055f * power(linear, 1.0f / 2.4f) - 0.055f;
    return linear <= 0.0031308f ? low : high;
}

static void luma_row(const float *const linear[3], int width, float *to) {
    const float *r = linear[0], *g = linear[1], *b = linear[2];
#pragma omp simd
    for (int k = 0; k < width; k++) to[k] = 0.2126f * encode(r[k]) + 0.7152f * encode(g[k]) + 0.0722f * encode(b[k]);
}

static void quantities_row(void *user, int row, int thread) {
    const Ssim *ssim = user;
    (void)thread;
    const int width = ssim->pair->width;
    const size_t at = (size_t)row * (size_t)width;
    float *x = ssim->planes[0] + at, *y = ssim->planes[1] + at, *sum = ssim->planes[2] + at,
          *off = ssim->planes[3] + at;
    for (int i = 0; i < 2; i++) {
        float *const *planes = ssim->pair->linear[i];
        luma_row((const float *[]){planes[0] + at, planes[1] + at, planes[2] + at}, width, i ? y : x);
    }
    for (int k = 0; k < width; k++) {
        sum[k] = x[k] * x[k] + y[k] * y[k];
        off[k] = (x[k] - y[k]) * (x[k] - y[k]);
    }
}

static void map_row(void *user, int row, int thread) {
    const Ssim *ssim = user;
    const Kernel *kernel = &ssim->kernel;
    const int width = ssim->pair->width;
    float *line = ssim->lines + (size_t)thread * LINES * ssim->stride + SSIM_RADIUS, *mean[QUANTITIES];
    for (int k = 0; k < QUANTITIES; k++) {
        const float *rows[KERNEL_TAPS];
        mean[k] = line + (size_t)(1 + k) * ssim->stride;
        kernel_rows(ssim->planes[k], width, ssim->pair->height, row, kernel->radius, rows);
        kernel_sum(kernel, rows, 0, width, line);
        kernel_shifts(line, width, kernel->radius, rows);
        kernel_sum(kernel, rows, 0, width, mean[k]);
    }
    const float c1 = 0.01f * 0.01f, c2 = 0.03f * 0.03f;
    const float *x = mean[0], *y = mean[1], *sum = mean[2], *off = mean[3];
    float *to = ssim->map + (size_t)row * (size_t)width;
#pragma omp simd
    for (int k = 0; k < width; k++) {
        const float squares = x[k] * x[k] + y[k] * y[k], squared_error = (x[k] - y[k]) * (x[k] - y[k]);
        to[k] = (1.0f - squared_error / (squares + c1)) * (1.0f - (off[k] - squared_error) / (sum[k] - squares + c2));
    }
}

static Kernel window(void) {
    const double sigma = 1.5;
    double weight[2 * SSIM_RADIUS + 1], sum = 0.0;
    Kernel kernel = {.radius = SSIM_RADIUS};
    for (int k = 0; k <= 2 * SSIM_RADIUS; k++) {
        const double t = (k - SSIM_RADIUS) / sigma;
        sum += weight[k] = exp(-0.5 * t * t);
    }
    for (int k = 0; k <= 2 * SSIM_RADIUS; k++) kernel.weight[k] = (float)(weight[k] / sum);
    return kernel;
}

bool ssim_map(const Pair *pair, float *map) {
    Ssim ssim = {.pair = pair, .kernel = window(), .stride = (size_t)pair->width + 2 * SSIM_RADIUS, .map = map};
    float *planes = alloc_array(pair_pixels(pair), QUANTITIES * sizeof *planes);
    ssim.lines = alloc_array(ssim.stride * LINES * (size_t)pair->threads, sizeof *ssim.lines);
    const bool ready = planes && ssim.lines;
    if (ready) {
        for (int k = 0; k < QUANTITIES; k++) ssim.planes[k] = planes + (size_t)k * pair_pixels(pair);
        parallel_for(pair->threads, pair->height, quantities_row, &ssim);
        parallel_for(pair->threads, pair->height, map_row, &ssim);
    }
    free(planes);
    free(ssim.lines);
    return ready;
}
