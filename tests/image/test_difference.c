/* Metrics against the papers' formulas, written out here in double precision and without separating a filter.
 */
#include "base/pi.h"
#include "fixture.h"

#include <float.h>

#include "image/pair.h"
#include "image/power.h"
#include "weft/diff.h"
#include "weft/sheet.h"

/* Pictures. */

static unsigned noise_state;

/* Evenly in [0, 1). */
static float noise(void) {
    noise_state = noise_state * 1664525u + 1013904223u;
    return (float)(noise_state >> 8) / 16777216.0f;
}

/* Edges, slopes, points and colours, linear in [0, 1]. */
static WeftImage scenery(int width, int height, unsigned seed) {
    WeftImage image = make_image(width, height, 3, WEFT_PIXEL_F32);
    float *p = image.pixels;
    noise_state = seed;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            const float disc = hypotf((float)x - 9.0f, (float)y - 8.0f) < 6.0f ? 0.6f : 0.0f;
            const float point = noise() > 0.97f ? 0.5f : 0.0f;
            *p++ = fminf(1.0f, disc + 0.3f * (float)x / (float)width + point);
            *p++ = fminf(1.0f, 0.5f * disc + 0.4f * (float)y / (float)height + 0.1f * noise());
            *p++ = fminf(1.0f, (x / 7 + y / 5) % 2 ? 0.7f : 0.05f + 0.2f * noise());
        }
    return image;
}

/* values + amount (noise - 1/2), within [0, 1] if bounded. */
static WeftImage noisy(const WeftImage *image, float amount, unsigned seed) {
    WeftImage out = make_image(image->width, image->height, image->channels, WEFT_PIXEL_F32);
    const float *from = image->pixels;
    noise_state = seed;
    for (size_t k = 0; k < value_total(image); k++)
        ((float *)out.pixels)[k] = fminf(1.0f, fmaxf(0.0f, from[k] + amount * (noise() - 0.5f)));
    return out;
}

static WeftImage flat(int width, int height, float r, float g, float b) {
    WeftImage image = make_image(width, height, 3, WEFT_PIXEL_F32);
    for (size_t k = 0; k < value_total(&image); k += 3) {
        float *p = (float *)image.pixels + k;
        p[0] = r, p[1] = g, p[2] = b;
    }
    return image;
}

/* What a display shows of linear values in [0, 1], at 16 bits: F32 pictures become display-referred. */
static WeftImage displayed(const WeftImage *image) {
    WeftImage out = make_image(image->width, image->height, 3, WEFT_PIXEL_U16);
    for (size_t k = 0; k < value_total(image); k++) {
        const double v = (double)((const float *)image->pixels)[k];
        const double code = v <= 0.0031308 ? 12.92 * v : 1.055 * pow(v, 1.0 / 2.4) - 0.055;
        ((uint16_t *)out.pixels)[k] = (uint16_t)(code * 65535.0 + 0.5);
    }
    return out;
}

static double decoded(double code) { return code <= 0.04045 ? code / 12.92 : pow((code + 0.055) / 1.055, 2.4); }

static WeftDiff compare(const WeftDiffDesc *desc, WeftImage *map) {
    WeftDiff found;
    WeftError error = {0};
    if (weft_diff(desc, &found, map, &error) != WEFT_OK) fail_msg("%s", error.text);
    return found;
}

static double value_of(WeftMetric metric, const WeftImage *a, const WeftImage *b) {
    return compare(&(WeftDiffDesc){.image = a, .reference = b, .metric = metric}, NULL).value;
}

/* FLIP once more. */

static double xyz_of_rgb[3][3], white[3];

static void solve(const double m[3][3], const double v[3], double x[3]) {
    for (int k = 0; k < 3; k++) {
        double n[3][3], det[2];
        memcpy(n, m, sizeof n);
        for (int pass = 0; pass < 2; pass++) {
            det[pass] = n[0][0] * (n[1][1] * n[2][2] - n[1][2] * n[2][1]) -
                        n[0][1] * (n[1][0] * n[2][2] - n[1][2] * n[2][0]) +
                        n[0][2] * (n[1][0] * n[2][1] - n[1][1] * n[2][0]);
            for (int i = 0; i < 3; i++) n[i][k] = v[i];
        }
        x[k] = det[1] / det[0];
    }
}

/* From the chromaticities of Rec. 709 and D65. */
static void make_matrix(void) {
    static const double xy[4][2] = {{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}, {0.3127, 0.3290}};
    double primaries[3][3], amount[3];
    for (int k = 0; k < 4; k++) {
        const double xyz[3] = {xy[k][0] / xy[k][1], 1.0, (1.0 - xy[k][0] - xy[k][1]) / xy[k][1]};
        for (int i = 0; i < 3; i++) *(k < 3 ? &primaries[i][k] : &white[i]) = xyz[i];
    }
    solve((const double(*)[3])primaries, white, amount);
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) xyz_of_rgb[i][k] = primaries[i][k] * amount[k];
}

/* Pixels as y, cx, cz: YCxCz. */
typedef struct Plane {
    int width, height;
    double (*pixel)[3];
} Plane;

static Plane plane_of(const WeftImage *image, double gain, bool bright) {
    Plane plane = {image->width, image->height, calloc(value_total(image) / 3, sizeof *plane.pixel)};
    assert_non_null(plane.pixel);
    for (size_t k = 0; k < value_total(image) / 3; k++) {
        double rgb[3], xyz[3];
        for (int c = 0; c < 3; c++) {
            const size_t at = 3 * k + (size_t)c;
            if (!bright) {
                rgb[c] = decoded((double)((const uint16_t *)image->pixels)[at] / 65535.0);
                continue;
            }
            const double x = 0.6 * gain * (double)((const float *)image->pixels)[at];
            rgb[c] = fmin(1.0, (2.51 * x * x + 0.03 * x) / (2.43 * x * x + 0.59 * x + 0.14));
        }
        for (int i = 0; i < 3; i++)
            xyz[i] = (xyz_of_rgb[i][0] * rgb[0] + xyz_of_rgb[i][1] * rgb[1] + xyz_of_rgb[i][2] * rgb[2]) / white[i];
        plane.pixel[k][0] = 116.0 * xyz[1] - 16.0;
        plane.pixel[k][1] = 500.0 * (xyz[0] - xyz[1]);
        plane.pixel[k][2] = 200.0 * (xyz[1] - xyz[2]);
    }
    return plane;
}

static const double *pixel_at(const Plane *plane, int x, int y) {
    x = x < 0 ? 0 : x < plane->width ? x : plane->width - 1;
    y = y < 0 ? 0 : y < plane->height ? y : plane->height - 1;
    return plane->pixel[y * plane->width + x];
}

static double lab_f(double t) {
    const double d = 6.0 / 29.0;
    return t > d * d * d ? cbrt(t) : t / (3.0 * d * d) + 4.0 / 29.0;
}

static void hunt(const double rgb[3], double lab[3]) {
    double f[3];
    for (int i = 0; i < 3; i++)
        f[i] = lab_f((xyz_of_rgb[i][0] * rgb[0] + xyz_of_rgb[i][1] * rgb[1] + xyz_of_rgb[i][2] * rgb[2]) / white[i]);
    lab[0] = 116.0 * f[1] - 16.0;
    lab[1] = 0.01 * lab[0] * 500.0 * (f[0] - f[1]);
    lab[2] = 0.01 * lab[0] * 200.0 * (f[1] - f[2]);
}

/* What is seen about a pixel: Hunt-adjusted L*a*b*, edge and point. */
static void see(const Plane *plane, int x, int y, double ppd, double seen[5]) {
    static const double a[3][2] = {{1.0, 0.0}, {1.0, 0.0}, {34.1, 13.5}},
                        b[3][2] = {{0.0047, 1e-5}, {0.0053, 1e-5}, {0.04, 0.025}};
    const int radius = (int)ceil(3.0 * sqrt(0.04 / (2.0 * PI_DOUBLE * PI_DOUBLE)) * ppd);
    double sum[3] = {0}, weights[3] = {0}, rgb[3];
    for (int j = -radius; j <= radius; j++)
        for (int i = -radius; i <= radius; i++)
            for (int c = 0; c < 3; c++) {
                const double t2 = (i * i + j * j) / (ppd * ppd);
                double w = 0.0;
                for (int k = 0; k < 2; k++)
                    w += a[c][k] * sqrt(PI_DOUBLE / b[c][k]) * exp(-PI_DOUBLE * PI_DOUBLE * t2 / b[c][k]);
                weights[c] += w;
                sum[c] += w * pixel_at(plane, x + i, y + j)[c];
            }
    const double luma = (sum[0] / weights[0] + 16.0) / 116.0, cx = sum[1] / weights[1] / 500.0,
                 cz = sum[2] / weights[2] / 200.0;
    const double xyz[3] = {(luma + cx) * white[0], luma * white[1], (luma - cz) * white[2]};
    solve((const double(*)[3])xyz_of_rgb, xyz, rgb);
    for (int c = 0; c < 3; c++) rgb[c] = fmin(1.0, fmax(0.0, rgb[c]));
    hunt(rgb, seen);

    const double sigma = 0.5 * 0.082 * ppd;
    const int reach = (int)ceil(3.0 * sigma);
    double part[4][2] = {{0}}, total[4][2] = {{0}}; /* slope and curve along x and y, by the weight's sign */
    for (int j = -reach; j <= reach; j++)
        for (int i = -reach; i <= reach; i++) {
            const double g = exp(-(i * i + j * j) / (2.0 * sigma * sigma)),
                         value = (pixel_at(plane, x + i, y + j)[0] + 16.0) / 116.0;
            const double w[4] = {-i * g, -j * g, (i * i / (sigma * sigma) - 1.0) * g,
                                 (j * j / (sigma * sigma) - 1.0) * g};
            for (int k = 0; k < 4; k++) {
                total[k][w[k] > 0.0] += fabs(w[k]);
                part[k][w[k] > 0.0] += w[k] * value;
            }
        }
    double f[4];
    for (int k = 0; k < 4; k++) f[k] = part[k][0] / total[k][0] + part[k][1] / total[k][1];
    seen[3] = hypot(f[0], f[1]);
    seen[4] = hypot(f[2], f[3]);
}

static double hyab(const double p[3], const double q[3]) { return fabs(p[0] - q[0]) + hypot(p[1] - q[1], p[2] - q[2]); }

static double most_difference(void) {
    double green[3], blue[3];
    hunt((const double[]){0.0, 1.0, 0.0}, green);
    hunt((const double[]){0.0, 0.0, 1.0}, blue);
    return pow(hyab(green, blue), 0.7);
}

static double color_difference(double distance) {
    const double c = pow(distance, 0.7), most = most_difference(), middle = 0.4 * most;
    return c < middle ? 0.95 * c / middle : 0.95 + (c - middle) / (most - middle) * 0.05;
}

static double flip_at(const Plane *a, const Plane *b, int x, int y, double ppd) {
    double p[5], q[5];
    see(a, x, y, ppd, p);
    see(b, x, y, ppd, q);
    const double features = sqrt(fmax(fabs(p[3] - q[3]), fabs(p[4] - q[4])) / sqrt(2.0));
    return pow(color_difference(hyab(p, q)), 1.0 - features);
}

static void flip_is_its_formula(void **state) {
    (void)state;
    static const struct {
        int width, height;
        float ppd;
    } cases[] = {{40, 28, 67.0f}, {31, 33, 30.0f}, {300, 2, 67.0f}, {3, 30, 90.0f}, {1, 1, 67.0f}, {12, 9, 5.0f}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        WeftImage one = scenery(cases[k].width, cases[k].height, 1), two = noisy(&one, 0.4f, 9);
        WeftImage a = displayed(&two), b = displayed(&one), map;
        const WeftDiff found = compare(
            &(WeftDiffDesc){
                .image = &a, .reference = &b, .metric = WEFT_METRIC_FLIP, .pixels_per_degree = cases[k].ppd},
            &map);
        Plane p = plane_of(&a, 1.0, false), q = plane_of(&b, 1.0, false);
        double sum = 0.0;
        for (int y = 0; y < a.height; y++)
            for (int x = 0; x < a.width; x++) {
                const double want = flip_at(&p, &q, x, y, (double)cases[k].ppd);
                assert_near(((const float *)map.pixels)[y * a.width + x], (float)want, 5e-5f);
                sum += want;
            }
        assert_near((float)found.value, (float)(sum / (a.width * a.height)), 5e-5f);
        assert_int_equal(found.exposures, 0);
        free(p.pixel), free(q.pixel);
        weft_image_free(&one), weft_image_free(&two), weft_image_free(&a), weft_image_free(&b);
        weft_image_free(&map);
    }
}

/* Radiance over 17 stops, a corner of it black. */
static void bright_flip_is_the_largest_over_exposures(void **state) {
    (void)state;
    enum { WIDTH = 24, HEIGHT = 18, COUNT = WIDTH * HEIGHT };
    WeftImage b = scenery(WIDTH, HEIGHT, 3), a = make_image(WIDTH, HEIGHT, 3, WEFT_PIXEL_F32), map;
    float *pa = a.pixels, *pb = b.pixels;
    double luminance[COUNT], most = 0.0;
    int lit = 0;
    for (int k = 0; k < COUNT; k++)
        for (int c = 0; c < 3; c++) {
            pb[3 * k + c] *= k % WIDTH < 5 ? 0.0f : exp2f(17.0f * noise() - 8.0f);
            pa[3 * k + c] = pb[3 * k + c] * (0.7f + 0.6f * noise()) + 0.001f * noise();
        }
    for (int k = 0; k < COUNT; k++) {
        const double y = 0.2126 * (double)pb[3 * k] + 0.7152 * (double)pb[3 * k + 1] + 0.0722 * (double)pb[3 * k + 2];
        most = fmax(most, y);
        if (!(y > 0.0)) continue;
        int place = lit++;
        for (; place > 0 && luminance[place - 1] > y; place--) luminance[place] = luminance[place - 1];
        luminance[place] = y;
    }
    const double median = 0.5 * (luminance[(lit - 1) / 2] + luminance[lit / 2]);
    /* 0.85 of the curve, by bisection */
    double low = 0.0, high = 100.0;
    for (int k = 0; k < 100; k++) {
        const double x = 0.6 * 0.5 * (low + high), y = (2.51 * x * x + 0.03 * x) / (2.43 * x * x + 0.59 * x + 0.14);
        *(y < 0.85 ? &low : &high) = 0.5 * (low + high);
    }
    const double start = log2(low / most), stop = log2(low / median);
    const int count = (int)fmax(2.0, ceil(stop - start));
    assert_true(count >= 4);

    const WeftDiff found = compare(&(WeftDiffDesc){.image = &a, .reference = &b, .metric = WEFT_METRIC_FLIP}, &map);
    assert_int_equal(found.exposures, count);
    assert_near(found.exposure_low, (float)start, 1e-4f);
    assert_near(found.exposure_high, (float)stop, 1e-4f);
    double want[COUNT] = {0};
    for (int k = 0; k < count; k++) {
        const double gain = exp2(start + (stop - start) * k / (count - 1));
        Plane p = plane_of(&a, gain, true), q = plane_of(&b, gain, true);
        for (int i = 0; i < COUNT; i++) want[i] = fmax(want[i], flip_at(&p, &q, i % WIDTH, i / WIDTH, 67.0));
        free(p.pixel), free(q.pixel);
    }
    for (int i = 0; i < COUNT; i++) assert_near(((const float *)map.pixels)[i], (float)want[i], 2e-4f);
    weft_image_free(&a), weft_image_free(&b), weft_image_free(&map);
}

/* Even pictures have no features, and what is left can be said in closed form. */
static void flip_of_even_pictures_is_the_colour_difference(void **state) {
    (void)state;
    WeftImage linear[4] = {flat(30, 20, 0.0f, 0.0f, 0.0f), flat(30, 20, 1.0f, 1.0f, 1.0f),
                           flat(30, 20, 0.0f, 1.0f, 0.0f), flat(30, 20, 0.0f, 0.0f, 1.0f)};
    WeftImage shown[4];
    for (int k = 0; k < 4; k++) shown[k] = displayed(&linear[k]);
    assert_near((float)value_of(WEFT_METRIC_FLIP, &shown[0], &shown[1]), (float)color_difference(100.0), 1e-5f);
    assert_near((float)value_of(WEFT_METRIC_FLIP, &shown[2], &shown[3]), 1.0f, 1e-5f);
    for (int k = 0; k < 4; k++) {
        assert_true(value_of(WEFT_METRIC_FLIP, &shown[k], &shown[k]) <= 0.0);
        assert_true(value_of(WEFT_METRIC_FLIP, &linear[k], &linear[k]) <= 0.0);
        weft_image_free(&linear[k]), weft_image_free(&shown[k]);
    }
}

static WeftImage blurred(const WeftImage *image) {
    WeftImage out = make_image(image->width, image->height, 3, WEFT_PIXEL_F32);
    const float *p = image->pixels;
    for (int y = 0; y < image->height; y++)
        for (int x = 0; x < image->width; x++)
            for (int c = 0; c < 3; c++) {
                float sum = 0.0f;
                for (int k = 0; k < 9; k++) {
                    const int i = x + k % 3 - 1, j = y + k / 3 - 1;
                    const int u = i < 0              ? 0
                                  : i < image->width ? i
                                                     : image->width - 1,
                              v = j < 0               ? 0
                                  : j < image->height ? j
                                                      : image->height - 1;
                    sum += p[3 * (v * image->width + u) + c];
                }
                ((float *)out.pixels)[3 * (y * image->width + x) + c] = sum / 9.0f;
            }
    return out;
}

/* More noise and more blur are further off; two pictures are as far from each other as the other way round.
 */
static void metrics_are_monotone_and_symmetric(void **state) {
    (void)state;
    WeftImage linear = scenery(64, 48, 5), truth = displayed(&linear), soft = noisy(&linear, 0.0f, 1);
    double noise_before[2] = {0.0, 1.0}, blur_before[2] = {0.0, 1.0};
    for (int step = 1; step <= 4; step++) {
        WeftImage grain = noisy(&linear, 0.1f * (float)step, 7), next = blurred(&soft);
        weft_image_free(&soft);
        soft = next;
        const WeftImage shown[2] = {displayed(&grain), displayed(&soft)};
        for (int k = 0; k < 2; k++) {
            double *before = k ? blur_before : noise_before;
            const double flip = value_of(WEFT_METRIC_FLIP, &shown[k], &truth),
                         ssim = value_of(WEFT_METRIC_SSIM, &shown[k], &truth);
            assert_true(flip > before[0] + 1e-3);
            if (k == 0) assert_true(ssim < before[1] - 1e-3); /* a pattern may come back in a blur, inverted */
            assert_true(flip <= value_of(WEFT_METRIC_FLIP, &truth, &shown[k]) &&
                        flip >= value_of(WEFT_METRIC_FLIP, &truth, &shown[k]));
            assert_near((float)ssim, (float)value_of(WEFT_METRIC_SSIM, &truth, &shown[k]), 1e-6f);
            before[0] = flip, before[1] = ssim;
            WeftImage gone = shown[k];
            weft_image_free(&gone);
        }
        weft_image_free(&grain);
    }
    weft_image_free(&linear), weft_image_free(&truth), weft_image_free(&soft);
}

/* A pattern of single pixels dissolves into its mean for one who stands far away. */
static void flip_depends_on_the_viewing_distance(void **state) {
    (void)state;
    WeftImage fine = flat(64, 64, 0.0f, 0.0f, 0.0f), even = flat(64, 64, 0.5f, 0.5f, 0.5f);
    for (size_t k = 0; k < 64 * 64; k++)
        for (size_t c = 0; c < 3; c++) ((float *)fine.pixels)[3 * k + c] = (k + k / 64) % 2 ? 1.0f : 0.0f;
    WeftImage a = displayed(&fine), b = displayed(&even);
    double before = 1.0;
    for (float ppd = 10.0f; ppd < 100.0f; ppd *= 2.0f) {
        const WeftDiff found = compare(
            &(WeftDiffDesc){.image = &a, .reference = &b, .metric = WEFT_METRIC_FLIP, .pixels_per_degree = ppd}, NULL);

        assert_true(found.value < before);
        before = found.value;
    }
    assert_true(before < 0.02);
    weft_image_free(&fine), weft_image_free(&even), weft_image_free(&a), weft_image_free(&b);
}

/* SSIM once more, by the deviations from the mean rather than by the mean of squares. */

static double luma_at(const WeftImage *image, int x, int y) {
    x = x < 0 ? 0 : x < image->width ? x : image->width - 1;
    y = y < 0 ? 0 : y < image->height ? y : image->height - 1;
    const uint16_t *p = (const uint16_t *)image->pixels + 3 * (y * image->width + x);
    return (0.2126 * p[0] + 0.7152 * p[1] + 0.0722 * p[2]) / 65535.0;
}

static double ssim_at(const WeftImage *a, const WeftImage *b, int x, int y) {
    double total = 0.0, mean[2] = {0}, square[3] = {0};
    for (int pass = 0; pass < 2; pass++)
        for (int j = -5; j <= 5; j++)
            for (int i = -5; i <= 5; i++) {
                const double w = exp(-(i * i + j * j) / (2.0 * 1.5 * 1.5));
                const double p = luma_at(a, x + i, y + j), q = luma_at(b, x + i, y + j);
                if (pass == 0) {
                    total += w, mean[0] += w * p, mean[1] += w * q;
                } else {
                    const double dp = p - mean[0] / total, dq = q - mean[1] / total;
                    square[0] += w * dp * dp, square[1] += w * dq * dq, square[2] += w * dp * dq;
                }
            }
    for (int k = 0; k < 2; k++) mean[k] /= total;
    for (int k = 0; k < 3; k++) square[k] /= total;
    const double c1 = 0.0001, c2 = 0.0009;
    return (2.0 * mean[0] * mean[1] + c1) * (2.0 * square[2] + c2) /
           ((mean[0] * mean[0] + mean[1] * mean[1] + c1) * (square[0] + square[1] + c2));
}

static void ssim_is_its_formula(void **state) {
    (void)state;
    static const int sizes[][2] = {{40, 28}, {11, 12}, {300, 3}, {10, 40}, {1, 1}};
    for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
        WeftImage one = scenery(sizes[k][0], sizes[k][1], 2), two = noisy(&one, 0.3f, 11);
        WeftImage a = displayed(&two), b = displayed(&one), map;
        const WeftDiff found = compare(&(WeftDiffDesc){.image = &a, .reference = &b, .metric = WEFT_METRIC_SSIM}, &map);
        double inner = 0.0, all = 0.0;
        int count = 0;
        for (int y = 0; y < a.height; y++)
            for (int x = 0; x < a.width; x++) {
                const double want = ssim_at(&a, &b, x, y);
                assert_near(((const float *)map.pixels)[y * a.width + x], (float)want, 5e-4f);
                all += want;
                if (x < 5 || y < 5 || x + 5 >= a.width || y + 5 >= a.height) continue;
                inner += want;
                count++;
            }
        assert_near((float)found.value, (float)(count ? inner / count : all / (a.width * a.height)), 1e-4f);
        assert_true(value_of(WEFT_METRIC_SSIM, &b, &b) >= 1.0);
        weft_image_free(&one), weft_image_free(&two), weft_image_free(&a), weft_image_free(&b);
        weft_image_free(&map);
    }
}

/* Of even pictures only brightness counts; a negative has the structure turned round. */
static void ssim_of_even_pictures_and_negatives_is_known(void **state) {
    (void)state;
    WeftImage dark = make_image(20, 20, 1, WEFT_PIXEL_U8), light = make_image(20, 20, 1, WEFT_PIXEL_U8);
    WeftImage image = make_image(20, 20, 1, WEFT_PIXEL_U8), negative = make_image(20, 20, 1, WEFT_PIXEL_U8);
    memset(dark.pixels, 51, 400);
    memset(light.pixels, 204, 400);
    for (int k = 0; k < 400; k++) {
        ((uint8_t *)image.pixels)[k] = (uint8_t)(96 + 63 * ((k + k / 20) % 2));
        ((uint8_t *)negative.pixels)[k] = (uint8_t)(255 - ((uint8_t *)image.pixels)[k]);
    }
    assert_near((float)value_of(WEFT_METRIC_SSIM, &dark, &light),
                (float)((2.0 * 0.2 * 0.8 + 1e-4) / (0.04 + 0.64 + 1e-4)), 1e-4f);
    assert_true(value_of(WEFT_METRIC_SSIM, &image, &negative) < -0.9);
    weft_image_free(&dark), weft_image_free(&light), weft_image_free(&image), weft_image_free(&negative);
}

static void relmse_is_its_formula(void **state) {
    (void)state;
    WeftImage b = scenery(20, 10, 4), a = noisy(&b, 0.5f, 2), map;
    const WeftDiff found = compare(&(WeftDiffDesc){.image = &a, .reference = &b}, &map);
    const float *pa = a.pixels, *pb = b.pixels;
    double sum = 0.0;
    for (int k = 0; k < 200; k++) {
        double pixel = 0.0;
        for (int c = 0; c < 3; c++) {
            const double x = (double)pa[3 * k + c], y = (double)pb[3 * k + c];
            pixel += (x - y) * (x - y) / (y * y + 0.01) / 3.0;
        }
        assert_near(((float *)map.pixels)[k], (float)pixel, 1e-5f);
        sum += pixel;
    }
    assert_near((float)found.value, (float)(sum / 200.0), 1e-6f);
    WeftDifference all;
    assert_int_equal(weft_difference(&a, &b, &all, NULL), WEFT_OK);
    assert_near((float)found.value, (float)all.relmse, 1e-6f);
    weft_image_free(&a), weft_image_free(&b), weft_image_free(&map);
}

/* Pictures of different kinds. */

/* A linear picture beside one of it, both of all kinds of channels, is the same picture. */
static void linear_picture_compares_as_its_tone_mapped_form(void **state) {
    (void)state;
    WeftImage linear = make_image(32, 24, 4, WEFT_PIXEL_F32), shown;
    noise_state = 12;
    for (size_t k = 0; k < value_total(&linear); k++)
        ((float *)linear.pixels)[k] = k % 4 == 3 ? noise() : exp2f(6.0f * noise() - 4.0f);
    assert_int_equal(weft_image_tonemap(&linear, WEFT_TONEMAP_ACES, 1.0f, &shown, NULL), WEFT_OK);
    for (int metric = 0; metric < WEFT_METRIC_COUNT; metric++)
        for (int turned = 0; turned < 2; turned++) {
            WeftDiffDesc desc = {.image = turned ? &shown : &linear,
                                 .reference = turned ? &linear : &shown,
                                 .metric = (WeftMetric)metric,
                                 .tonemap = WEFT_TONEMAP_ACES,
                                 .exposure = 1.0f};
            const double best = metric == WEFT_METRIC_SSIM ? 1.0 : 0.0;
            assert_true(compare(&desc, NULL).value >= best && compare(&desc, NULL).value <= best);
            desc.exposure = 0.0f;
            assert_true(fabs(compare(&desc, NULL).value - best) > 1e-3);
        }
    /* exposed: as if both had been shown */
    WeftImage other = noisy(&linear, 0.2f, 3), other_shown;
    assert_int_equal(weft_image_tonemap(&other, WEFT_TONEMAP_ACES, 1.0f, &other_shown, NULL), WEFT_OK);
    const WeftDiffDesc desc = {.image = &other,
                               .reference = &linear,
                               .metric = WEFT_METRIC_FLIP,
                               .tonemap = WEFT_TONEMAP_ACES,
                               .exposure = 1.0f,
                               .exposed = 1};
    assert_near((float)compare(&desc, NULL).value, (float)value_of(WEFT_METRIC_FLIP, &other_shown, &shown), 0.0f);
    weft_image_free(&linear), weft_image_free(&shown), weft_image_free(&other), weft_image_free(&other_shown);
}

static void pictures_of_other_channels_compare_as_their_colours(void **state) {
    (void)state;
    WeftImage grey = make_image(16, 16, 1, WEFT_PIXEL_U8), grey_alpha = make_image(16, 16, 2, WEFT_PIXEL_U8),
              color = make_image(16, 16, 3, WEFT_PIXEL_U16), both = make_image(16, 16, 4, WEFT_PIXEL_U8),
              linear = make_image(16, 16, 1, WEFT_PIXEL_F32), veil = make_image(16, 16, 2, WEFT_PIXEL_F32);
    for (int k = 0; k < 256; k++) {
        const uint8_t v = (uint8_t)(k * 5);
        ((uint8_t *)grey.pixels)[k] = ((uint8_t *)grey_alpha.pixels)[2 * k] = v;
        ((uint8_t *)grey_alpha.pixels)[2 * k + 1] = ((uint8_t *)both.pixels)[4 * k + 3] = 255;
        for (int c = 0; c < 3; c++) {
            ((uint16_t *)color.pixels)[3 * k + c] = (uint16_t)(257 * v);
            ((uint8_t *)both.pixels)[4 * k + c] = v;
        }
        ((float *)linear.pixels)[k] = 0.25f * (float)k / 255.0f;
        ((float *)veil.pixels)[2 * k] = (float)k / 255.0f;
        ((float *)veil.pixels)[2 * k + 1] = 0.25f;
    }
    const WeftImage *same[] = {&grey, &grey_alpha, &color, &both};
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++) {
            assert_true(value_of(WEFT_METRIC_RELMSE, same[i], same[j]) < 1e-12);
            assert_true(value_of(WEFT_METRIC_FLIP, same[i], same[j]) < 1e-4);
            assert_true(value_of(WEFT_METRIC_SSIM, same[i], same[j]) > 1.0 - 1e-6);
        }
    /* a quarter there is a quarter of the light */
    assert_true(value_of(WEFT_METRIC_RELMSE, &linear, &veil) < 1e-12);
    /* what is not there does not count */
    for (int k = 0; k < 256; k++)
        for (int c = 0; c < 4; c++) ((uint8_t *)both.pixels)[4 * k + c] = c == 3 ? 0 : (uint8_t)k;
    memset(grey.pixels, 0, 256);
    for (int metric = 0; metric < WEFT_METRIC_COUNT; metric++) {
        const double best = metric == WEFT_METRIC_SSIM ? 1.0 : 0.0, value = value_of((WeftMetric)metric, &both, &grey);
        assert_true(value >= best && value <= best);
    }
    weft_image_free(&grey), weft_image_free(&grey_alpha), weft_image_free(&color), weft_image_free(&both);
    weft_image_free(&linear), weft_image_free(&veil);
}

/* What is told of a map. */

static void mean_percentiles_and_largest_are_those_of_the_map(void **state) {
    (void)state;
    WeftImage b = flat(20, 20, 0.5f, 0.5f, 0.5f), a = flat(20, 20, 0.5f, 0.5f, 0.5f), map;
    for (int k = 0; k < 8; k++) ((float *)a.pixels)[3 * (50 + 7 * k)] += 0.01f * (float)(8 - k);
    const WeftDiff found = compare(&(WeftDiffDesc){.image = &a, .reference = &b}, &map);
    const float worst = 0.08f * 0.08f / 0.26f / 3.0f, fourth = 0.05f * 0.05f / 0.26f / 3.0f;
    assert_shape(&map, 20, 20, 1, WEFT_PIXEL_F32);
    assert_near(found.worst, worst, 1e-7f);
    assert_int_equal(found.worst_x, 10);
    assert_int_equal(found.worst_y, 2);
    assert_near(found.high, fourth, 1e-7f); /* three of 400 are worse */
    assert_near((float)weft_diff_beyond(&map, WEFT_METRIC_RELMSE, (double)fourth + 1e-6), 3.0f / 400.0f, 1e-7f);
    assert_near((float)weft_diff_beyond(&map, WEFT_METRIC_SSIM, 1.0), 1.0f, 0.0f);
    assert_near((float)weft_diff_beyond(&map, WEFT_METRIC_SSIM, 0.0), 0.0f, 0.0f);
    weft_image_free(&map);
    const WeftDiff alike = compare(&(WeftDiffDesc){.image = &a, .reference = &b, .metric = WEFT_METRIC_SSIM}, &map);
    const float *s = map.pixels;
    for (int k = 0; k < 400; k++) assert_true(s[k] >= alike.worst);
    assert_near(s[20 * alike.worst_y + alike.worst_x], alike.worst, 0.0f);
    assert_true(alike.high >= alike.worst && (double)alike.high < 1.0);
    weft_image_free(&a), weft_image_free(&b), weft_image_free(&map);
}

static int ascending(const void *a, const void *b) {
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

static void ranks_are_those_of_sorting(void **state) {
    (void)state;
    enum { COUNT = 500 };
    float values[COUNT], sorted[COUNT], found;
    noise_state = 77;
    for (int k = 0; k < COUNT; k++) values[k] = k % 5 ? ldexpf(noise(), (int)(80.0f * noise()) - 40) : 0.25f;
    values[3] = 0.0f, values[4] = FLT_MAX, values[6] = 1e-42f;
    memcpy(sorted, values, sizeof values);
    qsort(sorted, COUNT, sizeof *sorted, ascending);
    for (size_t k = 0; k < COUNT; k++) {
        assert_true(value_ranked(values, COUNT, k, &found));
        assert_near(found, sorted[k], 0.0f);
    }
}

static void fast_power_is_near_pow(void **state) {
    (void)state;
    static const float exponents[] = {1.0f / 3.0f, 0.7f, 1.0f / 2.4f, 0.01f, 1.0f, 3.0f, -0.5f};
    noise_state = 5;
    for (int k = 0; k < 20000; k++) {
        const float x = exp2f(50.0f * noise() - 25.0f), y = exponents[k % 7];
        const double want = pow((double)x, (double)y), part = fabs((double)y * log2((double)x));
        const double off = fabs((double)power(x, y) - want) / want;
        if (off > 2e-7 * (1.0 + part)) fail_msg("%g ^ %g: off by %g", (double)x, (double)y, off);
    }
    assert_near(power(0.0f, 0.3f), 0.0f, 0.0f);
    assert_near(power(1.0f, 0.3f), 1.0f, 0.0f);
}

static void metrics_with_any_number_of_threads_are_the_same(void **state) {
    (void)state;
    WeftImage b = scenery(300, 40, 6), a = noisy(&b, 0.2f, 8);
    for (int metric = 0; metric < WEFT_METRIC_COUNT; metric++) {
        WeftImage maps[3];
        for (int k = 0; k < 3; k++)
            compare(&(WeftDiffDesc){.image = &a, .reference = &b, .metric = (WeftMetric)metric, .threads = 1 + 3 * k},
                    &maps[k]);
        for (int k = 1; k < 3; k++) assert_memory_equal(maps[0].pixels, maps[k].pixels, 300 * 40 * sizeof(float));
        for (int k = 0; k < 3; k++) weft_image_free(&maps[k]);
    }
    weft_image_free(&a), weft_image_free(&b);
}

/* Whatever the pixels hold, what comes out is finite. */
static void metrics_of_odd_numbers_are_finite(void **state) {
    (void)state;
    static const float odd[] = {NAN, INFINITY, -INFINITY, FLT_MAX, -FLT_MAX, 1e-45f, -1.0f, 0.0f, 1e30f, 1e-20f};
    enum { COUNT = sizeof odd / sizeof *odd, SIDE = 16 };
    WeftImage a = make_image(SIDE, SIDE, 4, WEFT_PIXEL_F32), b = make_image(SIDE, SIDE, 4, WEFT_PIXEL_F32), map;
    for (int round = 0; round < 4; round++) {
        noise_state = (unsigned)round;
        for (size_t k = 0; k < value_total(&a); k++) {
            ((float *)a.pixels)[k] = odd[(size_t)(noise() * COUNT)];
            ((float *)b.pixels)[k] = round == 1 ? 0.0f : round == 2 ? 1e-38f : odd[(size_t)(noise() * COUNT)];
        }
        for (int metric = 0; metric < WEFT_METRIC_COUNT; metric++) {
            const WeftDiff found =
                compare(&(WeftDiffDesc){.image = &a, .reference = &b, .metric = (WeftMetric)metric}, &map);
            assert_true(isfinite(found.value) && isfinite(found.worst) && isfinite(found.high) &&
                        isfinite(found.exposure_low) && isfinite(found.exposure_high));
            for (size_t k = 0; k < SIDE * SIDE; k++) assert_true(isfinite(((float *)map.pixels)[k]));
            weft_image_free(&map);
        }
    }
    weft_image_free(&a), weft_image_free(&b);
}

static void pictures_that_do_not_match_are_refused(void **state) {
    (void)state;
    WeftImage a = flat(4, 3, 0.0f, 0.0f, 0.0f), b = flat(3, 4, 0.0f, 0.0f, 0.0f), none = {0};
    const WeftDiffDesc wrong[] = {{.image = &a},
                                  {.reference = &a},
                                  {.image = &a, .reference = &none},
                                  {.image = &a, .reference = &b},
                                  {.image = &a, .reference = &a, .metric = WEFT_METRIC_COUNT},
                                  {.image = &a, .reference = &a, .threads = -1},
                                  {.image = &a, .reference = &a, .exposure = NAN},
                                  {.image = &a, .reference = &a, .tonemap = (WeftTonemap)7},
                                  {.image = &a, .reference = &a, .pixels_per_degree = 0.5f},
                                  {.image = &a, .reference = &a, .pixels_per_degree = 501.0f},
                                  {.image = &a, .reference = &a, .pixels_per_degree = NAN}};
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        WeftDiff found;
        WeftImage map = {.width = 7};
        WeftError error = {0};
        assert_int_equal(weft_diff(&wrong[k], &found, &map, &error), WEFT_USAGE);
        assert_int_equal(error.message, WEFT_MESSAGE_DESC);
        assert_null(map.pixels);
        assert_int_equal(map.width, 0);
    }
    /* the ends of the range are not */
    for (int k = 0; k < 2; k++)
        assert_near((float)compare(&(WeftDiffDesc){.image = &a,
                                                   .reference = &a,
                                                   .metric = WEFT_METRIC_FLIP,
                                                   .pixels_per_degree = k ? 500.0f : 1.0f},
                                   NULL)
                        .value,
                    0.0f, 0.0f);
    assert_string_equal(weft_metric_name(WEFT_METRIC_SSIM), "ssim");
    assert_string_equal(weft_metric_name(WEFT_METRIC_COUNT), "");
    weft_image_free(&a), weft_image_free(&b);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(flip_is_its_formula),
        cmocka_unit_test(bright_flip_is_the_largest_over_exposures),
        cmocka_unit_test(flip_of_even_pictures_is_the_colour_difference),
        cmocka_unit_test(metrics_are_monotone_and_symmetric),
        cmocka_unit_test(flip_depends_on_the_viewing_distance),
        cmocka_unit_test(ssim_is_its_formula),
        cmocka_unit_test(ssim_of_even_pictures_and_negatives_is_known),
        cmocka_unit_test(relmse_is_its_formula),
        cmocka_unit_test(linear_picture_compares_as_its_tone_mapped_form),
        cmocka_unit_test(pictures_of_other_channels_compare_as_their_colours),
        cmocka_unit_test(mean_percentiles_and_largest_are_those_of_the_map),
        cmocka_unit_test(ranks_are_those_of_sorting),
        cmocka_unit_test(fast_power_is_near_pow),
        cmocka_unit_test(metrics_with_any_number_of_threads_are_the_same),
        cmocka_unit_test(metrics_of_odd_numbers_are_finite),
        cmocka_unit_test(pictures_that_do_not_match_are_refused),
    };
    make_matrix();
    return cmocka_run_group_tests_name("difference", tests, NULL, NULL);
}
