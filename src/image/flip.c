/* Andersson, Nilsson, Akenine-Moeller, Oskarsson, Astroem, Fairchild, "FLIP: A Difference Evaluator for
 * Alternating Images", Proceedings of the ACM on Computer Graphics and Interactive Techniques 3 (2), 2020.
 *
 * Colour. The opponent space is Y = 116 y - 16, Cx = 500 (x - y), Cz = 200 (y - z), where x, y, z are the tristimulus
 * values over those of white. Each channel is blurred by the contrast sensitivity of the eye, a sum of Gaussians over
 * the distance t in degrees, truncated at three times the widest standard deviation and normalised to a sum of 1:
 *
 *   g(t) = a1 sqrt(pi / b1) exp(-pi^2 t^2 / b1) + a2 sqrt(pi / b2) exp(-pi^2 t^2 / b2)
 *
 * The result is clamped to the RGB cube and converted to L* a* b* with the Hunt effect, chroma that grows with
 * lightness: a_h = a* L* / 100, b_h alike. With c = HyAB^0.7 and c_max that of green and blue,
 *
 *   HyAB = |L - L'| + sqrt((a_h - a_h')^2 + (b_h - b_h')^2)
 *   dE_c = 0.95 c / (0.4 c_max)                                  for c < 0.4 c_max, else
 *   dE_c = 0.95 + 0.05 (c - 0.4 c_max) / (c_max - 0.4 c_max)
 *
 * Features. y is filtered by the first and second derivatives of a Gaussian of sigma = 0.082 / 2 degrees, whose
 * positive weights sum to 1 and whose negative ones sum to -1. e and p are the lengths of the two gradients along the
 * image's axes:
 *
 *   dE_f = (max(|e - e'|, |p - p'|) / sqrt(2))^0.5
 *   FLIP = dE_c^(1 - dE_f)
 *
 * All filters are separable, or sums of separable ones. Filters of sum 1 commute with scale and offset of the opponent
 * space, so its channels here are y, x - y and y - z.
 *
 * Radiance: Andersson, Nilsson, Shirley, Akenine-Moeller, "Visualizing Errors in Rendered High Dynamic Range
 * Images", Eurographics Short Papers, 2021. The map is the largest FLIP of 2^c I, tone-mapped and clamped, over evenly
 * spaced exposures c from c_start to c_stop. Where x_p is the radiance that is displayed as 0.85 and Y the reference's
 * luminance,
 *
 *   c_start = log2(x_p / max Y), c_stop = log2(x_p / median Y), max(2, ceil(c_stop - c_start)) exposures
 *
 * Here the median is over pixels with light; otherwise a picture on black would have no c_stop. */
#include "image/flip.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "base/pi.h"
#include "base/thread.h"
#include "image/kernel.h"
#include "image/power.h"

/* Rec. 709 primaries, D65. */
static const double xyz_of_rgb[3][3] = {
    {0.4123866, 0.3575915, 0.1804505}, {0.2126368, 0.7151830, 0.0721802}, {0.0193306, 0.1191972, 0.9503726}};

typedef struct ColorMatrix {
    float m[3][3];
} ColorMatrix;

/* Filters: the contrast sensitivity for y, for x - y and (in two terms) for y - z; a Gaussian and its derivatives. */
enum { SIGHT_Y, SIGHT_X, SIGHT_Z, SIGHT_Z_TOO, SMOOTH, SLOPE, CURVE, FILTERS };

/* Rows of a thread: a picture filtered along y, four sums along x, and the filtered values of both pictures. */
enum { DOWN = 0, ALONG = FILTERS, SEEN = ALONG + 4, SEEN_LINES = 5, LINES = SEEN + 2 * SEEN_LINES };

typedef struct Flip {
    const Pair *pair;
    Kernel filters[FILTERS];
    ColorMatrix to_xyz, to_rgb; /* x, y, z over white */
    float most;                 /* c_max */
    float *opponent[2][3];
    float *lines;          /* of all threads: rows of width pixels with a margin on either side */
    size_t margin, stride; /* of a line */
    bool bright;           /* the pair is radiance */
    float gain, white;     /* 2^c, and a radiance on the flat part of the tone curve */
    float *map;            /* the largest value so far, from 0 on */
} Flip;

/* Normalises positive weights to a sum of 1 and negative ones to -1. */
static void normalise(Kernel *kernel, int radius, const double *weight) {
    double up = 0.0, down = 0.0;
    kernel->radius = radius;
    for (int k = 0; k <= 2 * radius; k++) *(weight[k] > 0.0 ? &up : &down) += fabs(weight[k]);
    for (int k = 0; k <= 2 * radius; k++)
        if (weight[k] < 0.0 || weight[k] > 0.0) kernel->weight[k] = (float)(weight[k] / (weight[k] > 0.0 ? up : down));
}

static void set_sight(Flip *flip, double pixels_per_degree) {
    static const double a[4] = {1.0, 1.0, 34.1, 13.5}, b[4] = {0.0047, 0.0053, 0.04, 0.025};
    const int radius = (int)ceil(3.0 * sqrt(0.04 / (2.0 * PI_DOUBLE * PI_DOUBLE)) * pixels_per_degree);
    double weight[4][KERNEL_TAPS], sum[4] = {0};
    for (int i = 0; i < 4; i++)
        for (int k = 0; k <= 2 * radius; k++) {
            const double t = (k - radius) / pixels_per_degree;
            sum[i] += weight[i][k] = sqrt(a[i] * sqrt(PI_DOUBLE / b[i])) * exp(-PI_DOUBLE * PI_DOUBLE * t * t / b[i]);
        }
    /* for y - z the squares of both terms sum to 1 */
    sum[SIGHT_Z] = sum[SIGHT_Z_TOO] = hypot(sum[SIGHT_Z], sum[SIGHT_Z_TOO]);
    for (int i = 0; i < 4; i++) {
        flip->filters[SIGHT_Y + i].radius = radius;
        for (int k = 0; k <= 2 * radius; k++) flip->filters[SIGHT_Y + i].weight[k] = (float)(weight[i][k] / sum[i]);
    }
}

static void set_features(Flip *flip, double pixels_per_degree) {
    const double sigma = 0.5 * 0.082 * pixels_per_degree;
    const int radius = (int)ceil(3.0 * sigma);
    double gauss[KERNEL_TAPS], slope[KERNEL_TAPS], curve[KERNEL_TAPS];
    for (int k = 0; k <= 2 * radius; k++) {
        const double t = k - radius;
        gauss[k] = exp(-0.5 * t * t / (sigma * sigma));
        slope[k] = -t * gauss[k];
        curve[k] = (t * t / (sigma * sigma) - 1.0) * gauss[k];
    }
    normalise(&flip->filters[SMOOTH], radius, gauss);
    normalise(&flip->filters[SLOPE], radius, slope);
    normalise(&flip->filters[CURVE], radius, curve);
}

/* Colours. */

/* Makes the matrix from RGB to x, y, z over white, and its inverse by Cramer's rule. */
static void set_colors(Flip *flip) {
    double m[3][3], determinant = 0.0;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) {
            m[i][k] = xyz_of_rgb[i][k] / (xyz_of_rgb[i][0] + xyz_of_rgb[i][1] + xyz_of_rgb[i][2]);
            flip->to_xyz.m[i][k] = (float)m[i][k];
        }
    for (int k = 0; k < 3; k++)
        determinant += m[0][k] * (m[1][(k + 1) % 3] * m[2][(k + 2) % 3] - m[1][(k + 2) % 3] * m[2][(k + 1) % 3]);
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) {
            const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, k1 = (k + 1) % 3, k2 = (k + 2) % 3;
            flip->to_rgb.m[k][i] = (float)((m[i1][k1] * m[i2][k2] - m[i1][k2] * m[i2][k1]) / determinant);
        }
}

typedef struct Triple {
    float x, y, z;
} Triple;

static inline Triple times(const ColorMatrix *a, Triple v) {
    return (Triple){a->m[0][0] * v.x + a->m[0][1] * v.y + a->m[0][2] * v.z,
                    a->m[1][0] * v.x + a->m[1][1] * v.y + a->m[1][2] * v.z,
                    a->m[2][0] * v.x + a->m[2][1] * v.y + a->m[2][2] * v.z};
}

static inline float unit(float x) { return x > 0.0f ? x < 1.0f ? x : 1.0f : 0.0f; }

/* Evaluates the function f of L* a* b* in CIE 15: the cube root, and a line below (6 / 29)^3. */
static inline float lab_root(float t) {
    const float root = power(t, 1.0f / 3.0f), line = t * (841.0f / 108.0f) + 4.0f / 29.0f;
    return t > 216.0f / 24389.0f ? root : line;
}

/* Returns L*, a_h, b_h of linear RGB in [0, 1]. */
static inline Triple hunt_lab(const ColorMatrix *to_xyz, Triple rgb) {
    const Triple v = times(to_xyz, rgb);
    const float x = lab_root(v.x), y = lab_root(v.y), z = lab_root(v.z), lightness = 116.0f * y - 16.0f;
    return (Triple){lightness, 5.0f * (x - y) * lightness, 2.0f * (y - z) * lightness};
}

static inline float hyab(Triple p, Triple q) {
    const float a = p.y - q.y, b = p.z - q.z;
    return fabsf(p.x - q.x) + sqrtf(a * a + b * b);
}

/* A tone curve, (k0 x^2 + k1 x) / (k3 x^2 + k4 x + k5). */
typedef struct Curve {
    float k0, k1, k3, k4, k5;
} Curve;

/* Krzysztof Narkowicz, "ACES Filmic Tone Mapping Curve", 2015, applied to 0.6 x. */
static const Curve aces = {0.6f * 0.6f * 2.51f, 0.6f * 0.03f, 0.6f * 0.6f * 2.43f, 0.6f * 0.59f, 0.14f};
static const Curve same = {.k1 = 1.0f, .k5 = 1.0f};

/* Returns the displayed value of a radiance, clamped to `white` from above. */
static inline float shown(Curve k, float gain, float white, float radiance) {
    const float x = gain * (radiance > 0.0f ? radiance < white ? radiance : white : 0.0f);
    return unit((k.k0 * x * x + k.k1 * x) / (k.k3 * x * x + k.k4 * x + k.k5));
}

/* Converts one row of both pictures, as displayed, to opponent space. */
static void opponent_row(void *user, int y, int thread) {
    const Flip *flip = user;
    (void)thread;
    const ColorMatrix to_xyz = flip->to_xyz;
    const Curve curve = flip->bright ? aces : same;
    const float gain = flip->gain, white = flip->white;
    const int width = flip->pair->width;
    const size_t at = (size_t)y * (size_t)width;
    for (int i = 0; i < 2; i++) {
        float *const *linear = flip->pair->linear[i], *const *opponent = flip->opponent[i];
        const float *r = linear[0] + at, *g = linear[1] + at, *b = linear[2] + at;
        float *to_y = opponent[0] + at, *to_x = opponent[1] + at, *to_z = opponent[2] + at;
#pragma omp simd
        for (int x = 0; x < width; x++) {
            const Triple rgb = {shown(curve, gain, white, r[x]), shown(curve, gain, white, g[x]),
                                shown(curve, gain, white, b[x])},
                         v = times(&to_xyz, rgb);
            to_y[x] = v.y;
            to_x[x] = v.x - v.y;
            to_z[x] = v.y - v.z;
        }
    }
}

/* The map. */

/* Applies every filter along y to row y of a picture's planes, in pieces whose neighbours fit the L1 cache. */
static void filter_down(const Flip *flip, float *const *planes, int y, float *const *to) {
    static const struct {
        int filter, plane;
    } passes[FILTERS] = {{SIGHT_Y, 0}, {SMOOTH, 0},  {SLOPE, 0},      {CURVE, 0},
                         {SIGHT_X, 1}, {SIGHT_Z, 2}, {SIGHT_Z_TOO, 2}};
    enum { PIECE = 256 };
    const int width = flip->pair->width;
    for (int x = 0; x < width; x += PIECE)
        for (int k = 0; k < FILTERS; k++) {
            const Kernel *kernel = &flip->filters[passes[k].filter];
            const float *rows[KERNEL_TAPS];
            kernel_rows(planes[passes[k].plane], width, flip->pair->height, y, kernel->radius, rows);
            kernel_sum(kernel, rows, x, x + PIECE < width ? x + PIECE : width, to[passes[k].filter]);
        }
}

static void filter_along(const Flip *flip, int filter, float *line, float *to) {
    const Kernel *kernel = &flip->filters[filter];
    const float *rows[KERNEL_TAPS];
    kernel_shifts(line, flip->pair->width, kernel->radius, rows);
    kernel_sum(kernel, rows, 0, flip->pair->width, to);
}

/* The filtered values of an image in one row. */
typedef struct Seen {
    float *lightness, *a, *b, *edge, *point;
} Seen;

static void seen_row(const Flip *flip, float *const *planes, int y, float *const *lines, const Seen *seen) {
    const ColorMatrix to_xyz = flip->to_xyz, to_rgb = flip->to_rgb;
    const int width = flip->pair->width;
    float *const *down = lines + DOWN;
    float *w0 = lines[ALONG], *w1 = lines[ALONG + 1], *w2 = lines[ALONG + 2], *w3 = lines[ALONG + 3];
    float *lightness = seen->lightness, *a = seen->a, *b = seen->b, *edge = seen->edge, *point = seen->point;
    filter_down(flip, planes, y, down);
    filter_along(flip, SIGHT_Y, down[SIGHT_Y], w0);
    filter_along(flip, SIGHT_X, down[SIGHT_X], w1);
    filter_along(flip, SIGHT_Z, down[SIGHT_Z], w2);
    filter_along(flip, SIGHT_Z_TOO, down[SIGHT_Z_TOO], w3);
#pragma omp simd
    for (int x = 0; x < width; x++) {
        const Triple v = {w0[x] + w1[x], w0[x], w0[x] - (w2[x] + w3[x])}, rgb = times(&to_rgb, v),
                     lab = hunt_lab(&to_xyz, (Triple){unit(rgb.x), unit(rgb.y), unit(rgb.z)});
        lightness[x] = lab.x;
        a[x] = lab.y;
        b[x] = lab.z;
    }
    filter_along(flip, SLOPE, down[SMOOTH], w0);
    filter_along(flip, SMOOTH, down[SLOPE], w1);
    filter_along(flip, CURVE, down[SMOOTH], w2);
    filter_along(flip, SMOOTH, down[CURVE], w3);
#pragma omp simd
    for (int x = 0; x < width; x++) {
        edge[x] = sqrtf(w0[x] * w0[x] + w1[x] * w1[x]);
        point[x] = sqrtf(w2[x] * w2[x] + w3[x] * w3[x]);
    }
}

static void map_row(void *user, int y, int thread) {
    const Flip *flip = user;
    float *lines[LINES], *const *seen = lines + SEEN;
    for (int k = 0; k < LINES; k++)
        lines[k] = flip->lines + ((size_t)thread * LINES + (size_t)k) * flip->stride + flip->margin;
    const Seen p = {seen[0], seen[1], seen[2], seen[3], seen[4]}, q = {seen[5], seen[6], seen[7], seen[8], seen[9]};
    seen_row(flip, flip->opponent[0], y, lines, &p);
    seen_row(flip, flip->opponent[1], y, lines, &q);
    const float most = flip->most, middle = 0.4f * most;
    const int width = flip->pair->width;
    float *to = flip->map + (size_t)y * (size_t)width;
#pragma omp simd
    for (int x = 0; x < width; x++) {
        const float c =
            power(hyab((Triple){p.lightness[x], p.a[x], p.b[x]}, (Triple){q.lightness[x], q.a[x], q.b[x]}), 0.7f);
        const float low = c * (0.95f / middle), high = 0.95f + 0.05f * (c - middle) / (most - middle);
        const float edge = fabsf(p.edge[x] - q.edge[x]), point = fabsf(p.point[x] - q.point[x]);
        const float de_c = c < middle ? low : high, de_f = sqrtf(0.707106781f * (edge > point ? edge : point));
        const float value = unit(power(de_c, 1.0f - de_f)), before = to[x];
        to[x] = before > value ? before : value;
    }
}

static void add_exposure(Flip *flip, float stops) {
    flip->gain = exp2f(stops);
    flip->white = exp2f(fminf(30.0f - stops, 120.0f));
    parallel_for(flip->pair->threads, flip->pair->height, opponent_row, flip);
    parallel_for(flip->pair->threads, flip->pair->height, map_row, flip);
}

/* Sets the range of exposures from the reference; returns false if memory is short. */
static bool set_exposures(const Pair *pair, WeftDiff *out) {
    const double t = 0.85, a = (double)aces.k0 - t * (double)aces.k3, b = (double)aces.k1 - t * (double)aces.k4,
                 x_p = (-b + sqrt(b * b + 4.0 * a * t * (double)aces.k5)) / (2.0 * a);
    const size_t pixels = pair_pixels(pair);
    float *luminance = alloc_array(pixels, sizeof *luminance), most = 0.0f, low = 0.0f, high = 0.0f;
    if (!luminance) return false;
    size_t count = 0;
    for (size_t i = 0; i < pixels; i++) {
        float *const *rgb = pair->linear[1];
        const float y = 0.2126f * rgb[0][i] + 0.7152f * rgb[1][i] + 0.0722f * rgb[2][i];
        if (y > 1e-30f) luminance[count++] = y;
        most = y > most ? y : most;
    }
    bool ranked = true;
    if (count > 0) {
        ranked =
            value_ranked(luminance, count, (count - 1) / 2, &low) && value_ranked(luminance, count, count / 2, &high);
        out->exposure_low = (float)log2(x_p / (double)most);
        out->exposure_high = (float)log2(x_p / (0.5 * ((double)low + (double)high)));
    }
    free(luminance);
    out->exposures = (int)fmaxf(2.0f, ceilf(out->exposure_high - out->exposure_low));
    return ranked;
}

bool flip_map(const Pair *pair, float pixels_per_degree, bool bright, WeftDiff *out, float *map) {
    Flip flip = {.pair = pair, .bright = bright, .map = map};
    set_sight(&flip, (double)pixels_per_degree);
    set_features(&flip, (double)pixels_per_degree);
    set_colors(&flip);
    const Triple green = hunt_lab(&flip.to_xyz, (Triple){0.0f, 1.0f, 0.0f}),
                 blue = hunt_lab(&flip.to_xyz, (Triple){0.0f, 0.0f, 1.0f});
    flip.most = power(hyab(green, blue), 0.7f);
    flip.margin = KERNEL_RADIUS;
    flip.stride = (size_t)pair->width + 2 * flip.margin;
    float *planes = alloc_array(pair_pixels(pair), 6 * sizeof *planes);
    flip.lines = alloc_array(flip.stride * LINES * (size_t)pair->threads, sizeof *flip.lines);
    bool ready = planes && flip.lines && (!bright || set_exposures(pair, out));
    if (ready) {
        for (int k = 0; k < 6; k++) flip.opponent[k / 3][k % 3] = planes + (size_t)k * pair_pixels(pair);
        const int last = bright ? out->exposures - 1 : 0;
        for (int k = 0; k <= last; k++)
            add_exposure(&flip,
                         last ? out->exposure_low + (out->exposure_high - out->exposure_low) * (float)k / (float)last
                              : 0.0f);
    }
    free(planes);
    free(flip.lines);
    return ready;
}
