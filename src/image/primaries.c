/* primaries.c - the algebra of primaries: SMPTE RP 177, "Derivation of Basic Television Color Equations", 1993
 *
 * Another white is adapted as in King Lam, "Metamerism and Colour Constancy", 1985 (the Bradford transform). */
#include "image/primaries.h"

#include <float.h>
#include <math.h>
#include <stddef.h>

static const Primaries rec709 = {{0.64, 0.33, 0.3, 0.6, 0.15, 0.06, 0.3127, 0.329}};

static ColorConversion product(const ColorConversion *a, const ColorConversion *b) {
    ColorConversion c = {{0}};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            for (int k = 0; k < 3; k++) c.m[3 * i + j] += a->m[3 * i + k] * b->m[3 * k + j];
    return c;
}

static void apply(const ColorConversion *a, const double v[3], double to[3]) {
    for (int i = 0; i < 3; i++) to[i] = a->m[3 * i] * v[0] + a->m[3 * i + 1] * v[1] + a->m[3 * i + 2] * v[2];
}

/* Inverts by cofactors; returns false if the determinant is next to none. */
static bool invert(const ColorConversion *a, ColorConversion *to) {
    const double *m = a->m;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            const int r = (j + 1) % 3, s = (j + 2) % 3, c = (i + 1) % 3, d = (i + 2) % 3;
            to->m[3 * i + j] = m[3 * r + c] * m[3 * s + d] - m[3 * r + d] * m[3 * s + c];
        }
    const double determinant = m[0] * to->m[0] + m[1] * to->m[3] + m[2] * to->m[6];
    if (!(fabs(determinant) > 1e-9)) return false;
    for (int k = 0; k < 9; k++) to->m[k] /= determinant;
    return true;
}

/* Fills X, Y, Z of a chromaticity where Y is 1; returns false for one without light. */
static bool xyz_of(const double xy[2], double xyz[3]) {
    if (!(fabs(xy[1]) > 1e-6) || !isfinite(xy[0])) return false;
    xyz[0] = xy[0] / xy[1];
    xyz[1] = 1.0;
    xyz[2] = (1.0 - xy[0] - xy[1]) / xy[1];
    return true;
}

/* Fills the matrix from R, G, B of primaries to X, Y, Z. */
static bool to_xyz(const Primaries *primaries, ColorConversion *to) {
    double white[3], amounts[3];
    ColorConversion columns, inverse;
    for (int c = 0; c < 3; c++) {
        double xyz[3];
        if (!xyz_of(primaries->xy + 2 * c, xyz)) return false;
        for (int i = 0; i < 3; i++) columns.m[3 * i + c] = xyz[i];
    }
    if (!xyz_of(primaries->xy + 6, white) || !invert(&columns, &inverse)) return false;
    apply(&inverse, white, amounts);
    for (int k = 0; k < 9; k++) to->m[k] = columns.m[k] * amounts[k % 3];
    return true;
}

ColorConversion xyz_matrix(void) {
    ColorConversion own, inverse = {{0}};
    if (to_xyz(&rec709, &own)) invert(&own, &inverse);
    return inverse;
}

/* Fills the matrix that takes the white of primaries to Rec. 709's, in X, Y, Z. */
static bool adaptation(const Primaries *primaries, ColorConversion *to) {
    static const ColorConversion bradford = {
        {0.8951, 0.2664, -0.1614, -0.7502, 1.7135, 0.0367, 0.0389, -0.0685, 1.0296}};
    double from[3], own[3], a[3], b[3];
    ColorConversion back, scaled = bradford;
    if (!xyz_of(primaries->xy + 6, from) || !xyz_of(rec709.xy + 6, own) || !invert(&bradford, &back)) return false;
    apply(&bradford, from, a);
    apply(&bradford, own, b);
    for (int k = 0; k < 9; k++) scaled.m[k] *= b[k / 3] / a[k / 3];
    *to = product(&back, &scaled);
    return true;
}

bool primaries_rec709(const Primaries *primaries) {
    double most = 0.0;
    for (int k = 0; k < 8; k++) most = fmax(most, fabs(primaries->xy[k] - rec709.xy[k]));
    return most < 2e-3;
}

bool primaries_adapted(const double white[2], ColorConversion *matrix) {
    ColorConversion own, taken;
    Primaries lit = rec709;
    lit.xy[6] = white[0], lit.xy[7] = white[1];
    if (!to_xyz(&rec709, &own) || !adaptation(&lit, &taken)) return false;
    const ColorConversion back = xyz_matrix(), there = product(&taken, &own);
    *matrix = product(&back, &there);
    return true;
}

bool primaries_chromaticity(const double rgb[3], double xy[2]) {
    ColorConversion own;
    double xyz[3] = {0};
    if (to_xyz(&rec709, &own)) apply(&own, rgb, xyz);
    const double sum = xyz[0] + xyz[1] + xyz[2];
    if (!(sum > 0.0) || !isfinite(sum)) return false;
    xy[0] = xyz[0] / sum, xy[1] = xyz[1] / sum;
    return true;
}

bool primaries_matrix(const Primaries *primaries, ColorConversion *matrix) {
    ColorConversion own, adapted, last = xyz_matrix();
    if (!to_xyz(primaries, &own) || !adaptation(primaries, &adapted)) return false;
    const ColorConversion both = product(&adapted, &own);
    *matrix = product(&last, &both);
    for (int k = 0; k < 9; k++)
        if (!(fabs(matrix->m[k]) < 1e3)) return false;
    return true;
}

void image_convert_colors(WeftImage *image, const ColorConversion *matrix) {
    float *pixel = image->pixels;
    const size_t count = (size_t)image->width * (size_t)image->height;
    for (size_t n = 0; n < count; n++, pixel += image->channels) {
        const double from[3] = {(double)pixel[0], (double)pixel[1], (double)pixel[2]};
        double to[3];
        apply(matrix, from, to);
        for (int c = 0; c < 3; c++) pixel[c] = (float)fmin(fmax(to[c], -(double)FLT_MAX), (double)FLT_MAX);
    }
}
