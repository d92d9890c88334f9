/* Smaller copies: the mean stays, light is averaged as light, and every texel is the integral over what it
 * covers */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "image/halve.h"

#include <math.h>

static const int sides[][2] = {{8, 8}, {7, 5}, {1, 6}, {9, 1}, {2, 3}, {13, 4}, {1, 1}};
enum { SIDES = sizeof sides / sizeof sides[0], MOST = 4 * 13 * 13 };

static float noise(uint32_t *state) {
    *state = *state * 1664525u + 1013904223u;
    return (float)(*state >> 8) * 0x1p-24f;
}

/* Channel 0 over the rectangle, in parts of texels, by counting points. */
static double counted(const float *from, int width, double x0, double x1, double y0, double y1) {
    enum { STEPS = 840 }; /* divisible by all the sides in question */
    double sum = 0.0;
    for (int j = 0; j < STEPS; j++)
        for (int k = 0; k < STEPS; k++) {
            int x = (int)(x0 + (x1 - x0) * (k + 0.5) / STEPS), y = (int)(y0 + (y1 - y0) * (j + 0.5) / STEPS);
            sum += (double)from[4 * (y * width + x)];
        }
    return sum / STEPS / STEPS;
}

static void halved_texels_are_means_of_what_they_cover(void **state) {
    (void)state;
    for (int n = 0; n < SIDES; n++) {
        int w = sides[n][0], h = sides[n][1], v = halved(w), u = halved(h);
        float from[MOST], to[MOST];
        uint32_t seed = 1u;
        for (int k = 0; k < 4 * w * h; k++) from[k] = noise(&seed);
        halve_f32(from, w, h, to);
        for (int y = 0; y < u; y++)
            for (int x = 0; x < v; x++) {
                double wanted = counted(from, w, (double)w * x / v, (double)w * (x + 1) / v, (double)h * y / u,
                                        (double)h * (y + 1) / u);
                assert_float_equal(to[4 * (y * v + x)], (float)wanted, 2e-3f);
            }
    }
}

/* The transfer function anew, in double precision. */
static double light(double code) {
    double d = code / 255.0;
    return d <= 0.04045 ? d / 12.92 : pow((d + 0.055) / 1.055, 2.4);
}
static double code(double linear) {
    return 255.0 * (linear <= 0.0031308 ? 12.92 * linear : 1.055 * pow(linear, 1.0 / 2.4) - 0.055);
}

static void halved_colours_are_averaged_as_light(void **state) {
    (void)state;
    uint32_t seed = 3u;
    for (int n = 0; n < 2000; n++) {
        uint8_t from[16], to[4];
        for (int k = 0; k < 16; k++) from[k] = (uint8_t)(noise(&seed) * (n % 2 ? 256.0f : 12.0f));
        for (int srgb = 0; srgb < 2; srgb++) {
            halve_u8(from, 2, 2, srgb, to);
            for (int c = 0; c < 4; c++) {
                double plain = 0.0, lit = 0.0;
                for (int k = c; k < 16; k += 4) plain += from[k] / 4.0, lit += light(from[k]) / 4.0;
                double wanted = srgb && c < 3 ? code(lit) : plain;
                assert_true(fabs(to[c] - wanted) < 0.51);
            }
        }
    }
}

static void even_picture_halves_to_the_same_value(void **state) {
    (void)state;
    for (int n = 0; n < SIDES; n++)
        for (int value = 0; value < 256; value++)
            for (int srgb = 0; srgb < 2; srgb++) {
                uint8_t from[MOST], to[MOST];
                for (int k = 0; k < 4 * sides[n][0] * sides[n][1]; k++) from[k] = (uint8_t)value;
                halve_u8(from, sides[n][0], sides[n][1], srgb, to);
                for (int k = 0; k < 4 * halved(sides[n][0]) * halved(sides[n][1]); k++) assert_int_equal(to[k], value);
            }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(halved_texels_are_means_of_what_they_cover),
                                       cmocka_unit_test(halved_colours_are_averaged_as_light),
                                       cmocka_unit_test(even_picture_halves_to_the_same_value)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
