/* meter.c - metering of pictures: exposure and white */
#include <math.h>
#include <stdbool.h>
#include <stddef.h>

#include "image/primaries.h"
#include "weft/image.h"

enum { STOPS = 64, BINS_A_STOP = 32, BINS = STOPS * BINS_A_STOP };
static const double TRIMMED = 0.05; /* of what is covered, at either end */
static const double MIDDLE_GREY = 0.18;

/* The part of a picture that counts, by the logarithm of its luminance. */
typedef struct Metered {
    double weight[BINS], sum[BINS]; /* of coverage, and of coverage times the logarithm */
    int first, last;                /* bins that count, after the darkest and the brightest are left out */
} Metered;

/* Returns the bin of a pixel; -1: it has no light that counts. *stop becomes the base-2 logarithm of the luminance. */
static int bin_of(const float *pixel, double *stop) {
    const double light = 0.2126 * (double)pixel[0] + 0.7152 * (double)pixel[1] + 0.0722 * (double)pixel[2];
    *stop = light > 0.0 && isfinite(light) ? log2(light) : -STOPS;
    const double bin = (*stop + 0.5 * STOPS) * BINS_A_STOP;
    return bin >= 0.0 && bin < BINS ? (int)bin : -1;
}

static double coverage(const WeftImage *linear, const float *pixel) {
    const double alpha = linear->channels == 4 ? (double)pixel[3] : 1.0;
    return alpha > 0.0 ? fmin(alpha, 1.0) : 0.0;
}

/* Returns false if there is no light. */
static bool meter(const WeftImage *linear, Metered *m) {
    *m = (Metered){.last = BINS - 1};
    if (linear->type != WEFT_PIXEL_F32 || linear->channels < 3) return false;
    const float *pixel = linear->pixels;
    double all = 0.0, stop;
    for (size_t k = 0; k < (size_t)linear->width * (size_t)linear->height; k++, pixel += linear->channels) {
        const int bin = bin_of(pixel, &stop);
        if (bin < 0) continue;
        m->weight[bin] += coverage(linear, pixel);
        m->sum[bin] += coverage(linear, pixel) * stop;
        all += coverage(linear, pixel);
    }
    for (double dark = 0.0; m->first < BINS - 1; m->first++)
        if ((dark += m->weight[m->first]) > TRIMMED * all) break;
    for (double bright = 0.0; m->last > m->first; m->last--)
        if ((bright += m->weight[m->last]) > TRIMMED * all) break;
    return all > 0.0;
}

float weft_image_meter(const WeftImage *linear) {
    Metered m;
    double weight = 0.0, sum = 0.0;
    if (!meter(linear, &m)) return 0.0f;
    for (int k = m.first; k <= m.last; k++) weight += m.weight[k], sum += m.sum[k];
    return (float)fmin(fmax(log2(MIDDLE_GREY) - sum / weight, -32.0), 32.0);
}

void weft_image_find_white(const WeftImage *linear, float white[2]) {
    Metered m;
    double sums[3] = {0}, xy[2], stop;
    white[0] = white[1] = 0.0f;
    if (!meter(linear, &m)) return;
    const float *pixel = linear->pixels;
    const double scale = exp2(-((double)m.last / BINS_A_STOP - 0.5 * STOPS)); /* keeps sixth powers in range */
    for (size_t k = 0; k < (size_t)linear->width * (size_t)linear->height; k++, pixel += linear->channels) {
        const int bin = bin_of(pixel, &stop);
        if (bin < m.first || bin > m.last) continue;
        for (int c = 0; c < 3; c++) sums[c] += coverage(linear, pixel) * pow(fmax((double)pixel[c], 0.0) * scale, 6.0);
    }
    for (int c = 0; c < 3; c++) sums[c] = pow(sums[c], 1.0 / 6.0);
    if (!primaries_chromaticity(sums, xy)) return;
    white[0] = (float)xy[0], white[1] = (float)xy[1];
}
