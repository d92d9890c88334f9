/* Numbers as people type them, and random ones */
#include <locale.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/number.h"
#include "base/random.h"

static void number_text_gives_its_float(void **state) {
    (void)state;
    static const struct {
        const char *text;
        float value;
    } good[] = {{"0", 0.0f}, {"-1.5", -1.5f}, {"+2", 2.0f}, {"1e-3", 1e-3f}, {".5", 0.5f}, {"3.4e38", 3.4e38f}};
    for (size_t k = 0; k < sizeof good / sizeof good[0]; k++) {
        float value = -9.0f;
        assert_true(parse_number(good[k].text, &value));
        assert_true(!(value != good[k].value));
    }
    float three[3], color[3];
    assert_true(parse_numbers("1;-2;3.5", ';', 3, three));
    assert_true(!(three[0] != 1.0f) && !(three[1] != -2.0f) && !(three[2] != 3.5f));
    assert_true(parse_color("0.25", color));
    assert_true(!(color[0] != 0.25f) && !(color[1] != 0.25f) && !(color[2] != 0.25f));
    assert_true(parse_color("0.1,0.2,0.3", color));
    assert_true(!(color[2] != 0.3f));
}

static void number_reads_alike_in_any_locale(void **state) {
    (void)state;
    static const char *const commas[] = {"de_DE.UTF-8", "de_DE.utf8", "de_DE", "fr_FR.UTF-8", "fr_FR.utf8"};
    const char *set = NULL;
    for (size_t k = 0; !set && k < sizeof commas / sizeof commas[0]; k++) set = setlocale(LC_NUMERIC, commas[k]);
    if (!set) {
        print_message("no locale with a decimal comma is installed\n");
        skip();
    }
    char *end;
    float value = 0.0f, color[3] = {0};
    bool comma = strtof("1,5", &end) > 1.0f;
    bool number = parse_number("1.5", &value), three = parse_color("1,5,0.25", color);
    setlocale(LC_NUMERIC, "C");
    assert_true(comma);
    assert_true(number && !(value != 1.5f));
    assert_true(three && !(color[0] != 1.0f) && !(color[1] != 5.0f) && !(color[2] != 0.25f));
}

static void text_that_is_no_number_is_refused(void **state) {
    (void)state;
    static const char *const bad[] = {"",    " ",         "x",    "1x",  "1 ", "1,2", "nan", "NAN(1)",
                                      "inf", "-infinity", "1e39", "--1", "1e", "0x",  "1,"};
    float value, color[3];
    for (size_t k = 0; k < sizeof bad / sizeof bad[0]; k++)
        if (parse_number(bad[k], &value)) fail_msg("\"%s\" passed for a number", bad[k]);
    static const char *const colors[] = {"", "1,2", "1,2,3,4", "1,,3", "1,2,", ",2,3", "1;2;3", "1,2,nan", "1,2,3 "};
    for (size_t k = 0; k < sizeof colors / sizeof colors[0]; k++)
        if (parse_color(colors[k], color)) fail_msg("\"%s\" passed for a colour", colors[k]);
}

static void hash32_flips_each_bit_half_the_time(void **state) {
    (void)state;
    enum { SAMPLES = 200000 };
    /* each input bit flips each output bit half of the time */
    for (int in = 0; in < 32; in++) {
        int flips[32] = {0};
        for (uint32_t n = 0; n < SAMPLES / 32; n++) {
            uint32_t d = hash32(n * 2654435761u) ^ hash32((n * 2654435761u) ^ (1u << in));
            for (int out = 0; out < 32; out++) flips[out] += (int)(d >> out & 1);
        }
        for (int out = 0; out < 32; out++) assert_true(abs(flips[out] - SAMPLES / 64) < 6 * 40);
    }
    /* it is bijective on a small range, and keys differ in both arguments */
    for (uint32_t a = 0; a < 300; a++)
        for (uint32_t b = a + 1; b < 300; b++) assert_int_not_equal(hash32(a), hash32(b));
    assert_int_not_equal(hash_combine(1, 2), hash_combine(2, 1));
    assert_int_not_equal(hash_combine(1, 2), hash_combine(1, 3));
}

static void unit_floats_are_below_one_and_evenly_spread(void **state) {
    (void)state;
    assert_true(!(unit_float(0) != 0.0f));
    assert_true(unit_float(UINT32_MAX) < 1.0f);
    enum { BINS = 64, SAMPLES = 640000 };
    int counts[BINS] = {0};
    double mean = 0.0;
    for (uint32_t n = 0; n < SAMPLES; n++) {
        float u = unit_float(hash_combine(n, 5));
        mean += (double)u / SAMPLES;
        counts[(int)(u * BINS)]++;
    }
    assert_true(fabs(mean - 0.5) < 0.002);
    for (int k = 0; k < BINS; k++) assert_true(abs(counts[k] - SAMPLES / BINS) < 600); /* 6 sigma */
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(number_text_gives_its_float),
        cmocka_unit_test(number_reads_alike_in_any_locale),
        cmocka_unit_test(text_that_is_no_number_is_refused),
        cmocka_unit_test(hash32_flips_each_bit_half_the_time),
        cmocka_unit_test(unit_floats_are_below_one_and_evenly_spread),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
