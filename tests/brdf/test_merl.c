/* Measured BRDFs in MERL's format: a lobe put into bins comes back, bad files end in one line, and the
 * fabrics of the shared data are read where they are at hand. */
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
#include "brdf/merl.h"
#include "weft/weft.h"

#undef sin /* of the dialect, which is single precision */
#undef cos
#undef sqrt

enum { SIZE = 12 + 3 * MERL_BINS * 8 };
static unsigned char *file;

static void put_int(int at, unsigned value) {
    for (int k = 0; k < 4; k++) file[at + k] = (unsigned char)(value >> 8 * k);
}

static void put_double(size_t at, double value) {
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    for (int k = 0; k < 8; k++) file[at + (size_t)k] = (unsigned char)(bits >> 8 * k);
}

/* The directions of a bin's middle: wo and wi from half vector (theta_h, 0) and difference (theta_d, phi_d).
 */
static void directions(int h, int d, int p, float wo[3], float wi[3]) {
    double root = (h + 0.5) / MERL_THETA_H, th = root * root * PI_DOUBLE / 2,
           td = (d + 0.5) / MERL_THETA_D * PI_DOUBLE / 2, pd = (p + 0.5) / MERL_PHI_D * PI_DOUBLE;
    double x = sin(td) * cos(pd), y = sin(td) * sin(pd), z = cos(td);
    double i[3] = {cos(th) * x + sin(th) * z, y, cos(th) * z - sin(th) * x};
    double half[3] = {sin(th), 0.0, cos(th)}, twice = 2.0 * z;
    for (int k = 0; k < 3; k++) {
        wi[k] = (float)i[k];
        wo[k] = (float)(twice * half[k] - i[k]);
    }
}

/* A file of a lobe that is coloured. */
static void synthesise(const WeftLobe *lobe) {
    static const double unit[3] = {1.0 / 1500.0, 1.15 / 1500.0, 1.66 / 1500.0};
    put_int(0, MERL_THETA_H), put_int(4, MERL_THETA_D), put_int(8, MERL_PHI_D);
    size_t bin = 0;
    for (int h = 0; h < MERL_THETA_H; h++)
        for (int d = 0; d < MERL_THETA_D; d++)
            for (int p = 0; p < MERL_PHI_D; p++, bin++) {
                float wo[3], wi[3], f[3];
                directions(h, d, p, wo, wi);
                bool above = wo[2] > 0.0f && wi[2] > 0.0f;
                weft_lobe_eval(lobe, wo, wi, f);
                for (size_t c = 0; c < 3; c++)
                    put_double(12 + (c * MERL_BINS + bin) * 8, above ? (double)f[c] / unit[c] : -1.0);
            }
}

static WeftLobe velvet(void) {
    WeftLobe lobe;
    WeftError error;
    assert_int_equal(weft_lobe_init("ashikhmin-neubelt", &lobe, &error), WEFT_OK);
    lobe.f0[0] = 0.9f, lobe.f0[1] = 0.5f, lobe.f0[2] = 0.1f;
    return lobe;
}

static void lobe_written_as_merl_reads_as_it_was(void **state) {
    (void)state;
    const WeftLobe lobe = velvet();
    Merl merl;
    WeftError error;
    synthesise(&lobe);
    assert_int_equal(merl_read_memory(file, SIZE, "file", &merl, &error), WEFT_OK);
    double sum = 0.0, off = 0.0;
    uint32_t seed = 1;
    for (int k = 0; k < 20000; k++) {
        float w[2][3];
        for (int d = 0; d < 2; d++) {
            seed = seed * 1664525u + 1013904223u;
            double z = 0.1 + 0.9 * (seed >> 8) * 0x1p-24, r = sqrt(1.0 - z * z);
            seed = seed * 1664525u + 1013904223u;
            double phi = 2.0 * PI_DOUBLE * (seed >> 8) * 0x1p-24;
            w[d][0] = (float)(r * cos(phi)), w[d][1] = (float)(r * sin(phi)), w[d][2] = (float)z;
        }
        float f[3], g[3], back[3];
        Dir o = {.x = w[0][0], .y = w[0][1], .z = w[0][2]}, i = {.x = w[1][0], .y = w[1][1], .z = w[1][2]};
        assert_true(merl_at(&merl, o, i, f));
        merl_at(&merl, i, o, back);
        weft_lobe_eval(&lobe, w[0], w[1], g);
        for (int c = 0; c < 3; c++) {
            assert_true(fabsf(f[c] - back[c]) <= 1e-4f * f[c] + 1e-7f); /* reciprocal */
            sum += (double)g[c];
            off += fabs((double)f[c] - (double)g[c]);
        }
    }
    print_message("mean difference over mean: %.5f\n", off / sum);
    assert_true(off < 0.003 * sum);
    merl_free(&merl);
}

static void reflections_of_lobe_and_file_agree(void **state) {
    (void)state;
    const WeftLobe lobe = velvet();
    char path[] = "merl-XXXXXX";
    WeftReflection *of_lobe, *of_file;
    WeftError error;
    synthesise(&lobe);
    int fd = mkstemp(path);
    assert_true(fd >= 0);
    assert_int_equal(write(fd, file, SIZE), SIZE);
    close(fd);
    assert_int_equal(weft_reflection_read(path, &of_file, &error), WEFT_OK);
    unlink(path);
    assert_int_equal(weft_reflection_of_lobe(&lobe, &of_lobe, &error), WEFT_OK);
    for (int k = 1; k < 10; k++) {
        float a[3], b[3], part[3];
        weft_reflection_albedo(of_lobe, WEFT_PART_ALL, (float)k / 10.0f, a);
        weft_reflection_albedo(of_file, WEFT_PART_ALL, (float)k / 10.0f, b);
        weft_reflection_albedo(of_file, WEFT_PART_SHEEN, (float)k / 10.0f, part);
        for (int c = 0; c < 3; c++) {
            assert_true(fabsf(a[c] - b[c]) < 0.01f * a[c] + 0.002f);
            assert_true(!(part[c] > 0.0f));
        }
    }
    weft_reflection_free(of_lobe);
    weft_reflection_free(of_file);
    WeftLobe none = {.lobe = -1};
    assert_int_equal(weft_reflection_of_lobe(&none, &of_lobe, &error), WEFT_USAGE);
    assert_null(of_lobe);
}

/* With phi_d all around, f of swapped directions is another bin: here one half of the circle is twice the
 * other. */
static void merl_of_360_bins_goes_all_around(void **state) {
    (void)state;
    enum { BINS = 2 * MERL_BINS, WHOLE = 12 + 3 * BINS * 8 };
    unsigned char *kept = file;
    file = alloc_array(WHOLE, 1);
    assert_non_null(file);
    put_int(0, MERL_THETA_H), put_int(4, MERL_THETA_D), put_int(8, 2 * MERL_PHI_D);
    for (size_t k = 0; k < (size_t)3 * BINS; k++)
        put_double(12 + 8 * k, k % (2 * MERL_PHI_D) < MERL_PHI_D ? 1500.0 : 3000.0);
    Merl merl;
    WeftError error;
    assert_int_equal(merl_read_memory(file, WHOLE, "file", &merl, &error), WEFT_OK);
    float wo[3], wi[3], f[3], back[3];
    directions(20, 40, 60, wo, wi); /* phi_d is 60.5 degrees */
    Dir o = {.x = wo[0], .y = wo[1], .z = wo[2]}, i = {.x = wi[0], .y = wi[1], .z = wi[2]};
    assert_true(merl_at(&merl, o, i, f));
    assert_true(merl_at(&merl, i, o, back));
    assert_float_equal(f[0], 1.0f, 1e-5f);
    assert_float_equal(back[0], 2.0f, 1e-5f);
    merl_free(&merl);
    WeftData *data;
    int all = 0;
    assert_int_equal(weft_data_read_memory(file, WHOLE, "all.binary", &data, &error), WEFT_OK);
    assert_true(weft_data_count(data, &all) > 1000);
    weft_data_free(data);
    put_int(8, 359);
    assert_int_equal(merl_read_memory(file, WHOLE, "file", &merl, &error), WEFT_INPUT);
    merl_free(&merl);
    free(file);
    file = kept;
}

static void refused(size_t size, const char *word) {
    Merl merl;
    WeftError error;
    assert_int_equal(merl_read_memory(file, size, "file", &merl, &error), WEFT_INPUT);
    assert_int_equal(error.message, WEFT_MESSAGE_MEASURED);
    if (!strstr(error.text, word)) fail_msg("%s", error.text);
    assert_null(strchr(error.text, '\n'));
    merl_free(&merl);
}

static void bad_merl_file_is_an_error_of_one_line(void **state) {
    (void)state;
    const WeftLobe lobe = velvet();
    synthesise(&lobe);
    refused(3, "3 bytes");
    refused(SIZE - 8, "cut short");
    put_int(4, 91);
    refused(SIZE, "91");
    put_int(4, MERL_THETA_D);
    put_double(12, (double)NAN);
    refused(SIZE, "finite");
    for (size_t k = 0; k < (size_t)3 * MERL_BINS; k++) put_double(12 + 8 * k, -1.0);
    refused(SIZE, "above 0");
    unsigned char *longer = realloc(file, SIZE + 1);
    assert_non_null(longer);
    file = longer;
    file[SIZE] = 0;
    refused(SIZE + 1, "behind its end");
    WeftReflection *none;
    WeftError error;
    assert_int_equal(weft_reflection_read("not-there.binary", &none, &error), WEFT_INPUT);
    assert_null(none);
}

static void merl_fabrics_are_read(void **state) {
    (void)state;
    const char *folder = getenv("WEFT_DATA");
    char command[1024], path[] = "fabric-XXXXXX";
    if (!folder || !*folder) folder = WEFT_SOURCE_DIR "/../shared/data";
    int fd = mkstemp(path);
    assert_true(fd >= 0);
    close(fd);
    snprintf(command, sizeof command, "xz -dc '%s/brdf/fabric/red-fabric.resynth.binary.xz' >%s 2>/dev/null", folder,
             path);
    if (system(command) != 0) { /* NOLINT(cert-env33-c): of the test's own words */
        unlink(path);
        print_message("skipped: no measured fabrics at hand, or no xz\n");
        skip();
    }
    WeftReflection *red;
    WeftError error;
    float e[3];
    if (weft_reflection_read(path, &red, &error) != WEFT_OK) fail_msg("%s", error.text);
    unlink(path);
    weft_reflection_albedo(red, WEFT_PART_ALL, 0.8f, e);
    print_message("red fabric, E at cos 0.8: %.4f %.4f %.4f\n", (double)e[0], (double)e[1], (double)e[2]);
    assert_true(e[0] > 2.0f * e[1] && e[0] > 2.0f * e[2] && e[0] < 1.0f && e[2] > 0.0f);
    weft_reflection_free(red);
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
        cmocka_unit_test(lobe_written_as_merl_reads_as_it_was),
        cmocka_unit_test(reflections_of_lobe_and_file_agree),
        cmocka_unit_test(merl_of_360_bins_goes_all_around),
        cmocka_unit_test(bad_merl_file_is_an_error_of_one_line),
        cmocka_unit_test(merl_fabrics_are_read),
    };
    return cmocka_run_group_tests(tests, begin, end);
}
