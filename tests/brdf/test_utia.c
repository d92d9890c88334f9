/* UTIA's raw files: layout, interpolation in four angles, and bad files */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "base/memory.h"
#include "base/pi.h"
#include "brdf/utia.h"
#include "scratch.h"
#include "weft/weft.h"

#undef sin /* of the dialect, which is single precision */
#undef cos

enum { SIZE = 3 * 8 * UTIA_SIDE * UTIA_SIDE };
static unsigned char *file;

static void put_double(size_t k, double value) {
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    for (size_t b = 0; b < 8; b++) file[8 * k + b] = (unsigned char)(bits >> 8 * b);
}

/* f that is linear in each angle, in degrees, between the measured ones; azimuths rise and fall again. */
static double tent(double phi) { return fabs(180.0 - phi) / 180.0; }
static double known(int c, double ti, double pi, double tv, double pv) {
    return (c + 1) * (1.0 + ti / 75.0) * (0.5 + tent(pi)) * (2.0 - tv / 75.0) * (1.0 + 2.0 * tent(pv));
}

static void fill(void) {
    size_t k = 0;
    for (int c = 0; c < 3; c++)
        for (int ti = 0; ti < UTIA_THETAS; ti++)
            for (int pi = 0; pi < UTIA_PHIS; pi++)
                for (int tv = 0; tv < UTIA_THETAS; tv++)
                    for (int pv = 0; pv < UTIA_PHIS; pv++)
                        put_double(k++, known(c, 15.0 * ti, 7.5 * pi, 15.0 * tv, 7.5 * pv));
}

static Dir direction(double theta, double phi) {
    return dir((float)(sin(theta * RADIANS) * cos(phi * RADIANS)), (float)(sin(theta * RADIANS) * sin(phi * RADIANS)),
               (float)cos(theta * RADIANS));
}

static void numbers_are_found_between_angles(void **state) {
    (void)state;
    Utia utia;
    WeftError error;
    fill();
    assert_int_equal(utia_read_memory(file, SIZE, "file", &utia, &error), WEFT_OK);
    uint32_t seed = 3;
    for (int n = 0; n < 20000; n++) {
        double a[4];
        for (int k = 0; k < 4; k++) {
            seed = seed * 1664525u + 1013904223u;
            a[k] = (seed >> 8) * 0x1p-24 * (k % 2 ? 360.0 : n % 4 ? 75.0 : 89.0);
        }
        float f[3];
        utia_at(&utia, direction(a[2], a[3]), direction(a[0], a[1]), f);
        for (int c = 0; c < 3; c++) {
            double expected = known(c, fmin(a[0], 75.0), a[1], fmin(a[2], 75.0), a[3]);
            if (!(fabs((double)f[c] - expected) <= 1e-4 * expected)) fail_msg("%.7g, not %.7g", (double)f[c], expected);
        }
    }
    float f[3];
    utia_at(&utia, dir(0.6f, 0.0f, 0.8f), dir(0.6f, 0.0f, -0.8f), f);
    assert_true(!(f[0] > 0.0f));
    utia_free(&utia);
}

static void refused(size_t size, const char *word) {
    Utia utia;
    WeftError error;
    assert_int_equal(utia_read_memory(file, size, "file", &utia, &error), WEFT_INPUT);
    assert_int_equal(error.message, WEFT_MESSAGE_UTIA);
    if (!strstr(error.text, word)) fail_msg("%s", error.text);
    assert_null(strchr(error.text, '\n'));
    utia_free(&utia);
}

static void bad_files_end_in_one_line(void **state) {
    (void)state;
    fill();
    refused(SIZE - 8, "would be right");
    refused(0, "0 bytes");
    put_double(9, (double)INFINITY);
    refused(SIZE, "finite");
    for (size_t k = 0; k < (size_t)SIZE / 8; k++) put_double(k, -1.0);
    refused(SIZE, "above 0");
}

/* A file of a lobe is data that the lobe fits, and a reflection. */
static void a_lobe_is_found_again(void **state) {
    (void)state;
    char folder[SCRATCH_SIZE], path[SCRATCH_SIZE + 16];
    WeftLobe lobe;
    WeftError error;
    size_t k = 0;
    assert_int_equal(weft_lobe_init("body", &lobe, &error), WEFT_OK);
    for (int c = 0; c < 3; c++)
        for (int light = 0; light < UTIA_SIDE; light++)
            for (int view = 0; view < UTIA_SIDE; view++) {
                Dir i = direction(15.0 * (light / UTIA_PHIS), 7.5 * (light % UTIA_PHIS)),
                    o = direction(15.0 * (view / UTIA_PHIS), 7.5 * (view % UTIA_PHIS));
                const float wi[3] = {i.x, i.y, i.z}, wo[3] = {o.x, o.y, o.z};
                float f[3];
                weft_lobe_eval(&lobe, wo, wi, f);
                put_double(k++, (double)f[0] * (1.0 - 0.3 * c));
            }
    assert_true(scratch_make(folder));
    snprintf(path, sizeof path, "%s/lobe.bin", folder);
    FILE *stream = fopen(path, "wb");
    assert_non_null(stream);
    assert_int_equal(fwrite(file, 1, SIZE, stream), SIZE);
    fclose(stream);
    WeftData *data;
    WeftReflection *reflection;
    if (weft_data_read(path, &data, &error) != WEFT_OK) fail_msg("%s", error.text);
    assert_int_equal(weft_reflection_read(path, &reflection, &error), WEFT_OK);
    unlink(path);
    assert_true(scratch_remove_empty(folder));
    int all = 0;
    assert_true(weft_data_count(data, &all) > 3000 && all == 24 * 24 * 12);
    float e[3], expected[3];
    weft_reflection_albedo(reflection, WEFT_PART_ALL, 0.8f, e);
    weft_lobe_albedo(&lobe, 0.8f, expected);
    for (int c = 0; c < 3; c++) assert_float_equal(e[c], expected[0] * (1.0f - 0.3f * (float)c), 0.02f * expected[0]);
    weft_reflection_free(reflection);
    weft_data_free(data);
}

static int begin(void **state) {
    (void)state;
    file = alloc_array(SIZE, 1);
    return file ? 0 : 1;
}

static int end(void **state) {
    (void)state;
    free(file);
    return 0;
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(numbers_are_found_between_angles),
        cmocka_unit_test(bad_files_end_in_one_line),
        cmocka_unit_test(a_lobe_is_found_again),
    };
    return cmocka_run_group_tests(tests, begin, end);
}
