#include "brdf/spectrum.h"

#include <math.h>
#include <stddef.h>

/* Evaluates a Gaussian with different widths on either side. */
static double hump(double x, double middle, double below, double above) {
    double t = (x - middle) / (x < middle ? below : above);
    return exp(-0.5 * t * t);
}

/* Evaluates the three colour-matching functions at a wavelength. */
static void matching(double nm, double rgb[3]) {
    double x =
        1.056 * hump(nm, 599.8, 37.9, 31.0) + 0.362 * hump(nm, 442.0, 16.0, 26.7) - 0.065 * hump(nm, 501.1, 20.4, 26.2);
    double y = 0.821 * hump(nm, 568.8, 46.9, 40.5) + 0.286 * hump(nm, 530.9, 16.3, 31.1);
    double z = 1.217 * hump(nm, 437.0, 11.8, 36.0) + 0.681 * hump(nm, 459.0, 26.0, 13.8);
    rgb[0] = 3.2406 * x - 1.5372 * y - 0.4986 * z; /* IEC 61966-2-1 */
    rgb[1] = -0.9689 * x + 1.8758 * y + 0.0415 * z;
    rgb[2] = 0.0557 * x - 0.2040 * y + 1.0570 * z;
}

/* Returns half of the distance between a wavelength's neighbours. */
static double step_at(const float *wavelength, int count, int k) {
    int low = k > 0 ? k - 1 : 0, high = k + 1 < count ? k + 1 : count - 1;
    return count > 1 ? 0.5 * ((double)wavelength[high] - (double)wavelength[low]) : 1.0;
}

bool spectrum_weights(const float *wavelength, int count, double *weights) {
    double sum[3] = {0.0}, size[3] = {0.0}, rgb[3];
    for (int k = 0; k < count; k++) {
        matching((double)wavelength[k], rgb);
        for (int c = 0; c < 3; c++) {
            double weight = rgb[c] * step_at(wavelength, count, k);
            weights[(size_t)c * (size_t)count + (size_t)k] = weight;
            sum[c] += weight;
            size[c] += fabs(weight);
        }
    }
    for (int c = 0; c < 3; c++) {
        if (!(sum[c] > 1e-6 && sum[c] > 0.1 * size[c])) return false;
        for (int k = 0; k < count; k++) weights[(size_t)c * (size_t)count + (size_t)k] /= sum[c];
    }
    return true;
}
