#include "trace/path/lens.h"

#include "base/pi.h"
#include "shading/dialect/loop.h"
#include "trace/geometry/sampler.h"

/* Fills the filter with offsets at equal steps of the integral of the Blackman-Harris window of 1.5 pixels' radius, so
 * that a random entry is distributed by the window. Fredric J. Harris, "On the Use of Windows for Harmonic Analysis
 * with the Discrete Fourier Transform", 1978. */
void lens_make(Lens *lens) {
    enum { FINE = 16 * LENS_STEPS };
    const double radius = 1.5, total = 0.35875;
    double integral = 0.0;
    int step = 0;
    for (int k = 0; k < FINE; k++) {
        double a = 2.0 * PI_DOUBLE * (k + 0.5) / FINE;
        double w = 0.35875 - 0.48829 * (cos)(a) + 0.14128 * (cos)(2.0 * a) - 0.01168 * (cos)(3.0 * a),
               before = integral;
        integral += w / (total * FINE);
        for (; step <= LENS_STEPS && (double)step / LENS_STEPS <= integral; step++) {
            double part = ((double)step / LENS_STEPS - before) / (integral - before);
            lens->filter[step] = (float)(radius * (2.0 * (k + part) / FINE - 1.0));
        }
    }
    for (; step <= LENS_STEPS; step++) lens->filter[step] = (float)radius;
}

FN float filter_offset(const float *filter, float u) {
    float x = u * LENS_STEPS;
    int k = (int)x;
    return mix(filter[k], filter[k + 1], x - (float)k);
}

/* Makes the rays of one pixel. Pixels do not share vectors, so that a crop has the same bytes as the whole picture. */
LOOP(rays_of_pixel_n,
     (const Lens *lens, float px, float py, uint32_t pixel, const uint32_t *sample, int at, int n,
      Paths *restrict paths),
     (lens, px, py, pixel, sample, at, n, paths)) {
    const View view = lens->view;
    const float *filter = lens->filter;
    float across = 2.0f / (float)lens->width, down = 2.0f / (float)lens->height, wide = lens->centred ? 0.0f : 1.0f;
    float parallel = view.orthographic ? 1.0f : 0.0f, spread = 1.0f - parallel; /* of origins, or of directions */
    EACH(k, (size_t)n) {
        Point p = sampler_point(pixel, sample[k], SAMPLER_PIXEL);
        float x = (px + 0.5f + wide * filter_offset(filter, p.u)) * across - 1.0f;
        float y = 1.0f - (py + 0.5f + wide * filter_offset(filter, p.v)) * down;
        float ox = view.across.x * x + view.up.x * y, oy = view.across.y * x + view.up.y * y,
              oz = view.across.z * x + view.up.z * y;
        float dx = view.forward.x + spread * ox, dy = view.forward.y + spread * oy, dz = view.forward.z + spread * oz,
              r = 1.0f / sqrt(dx * dx + dy * dy + dz * dz);
        size_t j = (size_t)at + k;
        paths->origin[0][j] = view.eye.x + parallel * ox;
        paths->origin[1][j] = view.eye.y + parallel * oy;
        paths->origin[2][j] = view.eye.z + parallel * oz;
        paths->direction[0][j] = dx * r;
        paths->direction[1][j] = dy * r;
        paths->direction[2][j] = dz * r;
        paths->key[j] = hash32(pixel ^ sample[k]);
    }
}

/* Returns the number of sample k of a part. Blocks of a power of two of the sequence are stratified by themselves. */
static uint32_t number_of(const LensPart *part, int k) {
    enum { BLOCK = 1 << PATHS_SAMPLES_LOG2 };
    int n = part->first + k;
    return (uint32_t)(part->half < 0 ? n : n + (n / BLOCK + part->half) * BLOCK);
}

int lens_rays(const Lens *lens, const LensPart *part, PathKeys *keys, Paths *paths) {
    int pixels = part->width * part->height, at = 0;
    for (int k = 0; k < 1 << PATHS_SAMPLES_LOG2; k++) keys->sample[k] = sampler_index(number_of(part, k));
    for (int p = 0; p < pixels; p++, at += part->count) {
        int x = part->x + p % part->width, y = part->y + p / part->width;
        keys->pixel[p] = sampler_key((uint32_t)x, (uint32_t)y, part->seed);
        /* always ROW_LANES rays: the next pixel overwrites the surplus */
        rays_of_pixel_n(lens, (float)x, (float)y, keys->pixel[p], keys->sample, at, ROW_LANES, paths);
        for (int k = 0; k < part->count; k++) paths->id[at + k] = (uint32_t)(p << PATHS_SAMPLES_LOG2 | k);
    }
    for (int a = 0; a < 3; a++)
        for (int k = 0; k < at; k++) paths->throughput[a][k] = 1.0f;
    for (int k = 0; k < at; k++) paths->pdf[k] = 0.0f;
    return at;
}
