/* `weft diff`: what it prints and writes, and how it ends. */
#include "run.h"

#include <math.h>

#include <jansson.h>

#include "weft/weft.h"

/* A picture of 40 x 30 greys that rise from the left; one pixel in ten is off by `off`. */
static void picture_make(const char *path, int width, int height, float off) {
    WeftImage image, display;
    assert_int_equal(weft_image_create(width, height, 3, WEFT_PIXEL_F32, &image, NULL), WEFT_OK);
    for (int k = 0; k < width * height; k++)
        for (int c = 0; c < 3; c++)
            ((float *)image.pixels)[3 * k + c] =
                0.1f + 0.5f * (float)(k % width) / (float)width + (k % 10 == 7 ? off : 0.0f);
    if (!weft_image_suffix_linear(path)) {
        assert_int_equal(weft_image_tonemap(&image, WEFT_TONEMAP_PBR_NEUTRAL, 0.0f, &display, NULL), WEFT_OK);
        weft_image_free(&image);
        image = display;
    }
    assert_int_equal(weft_image_write(path, &image, NULL), WEFT_OK);
    weft_image_free(&image);
}

static int pictures_begin(void **state) {
    if (work_begin(state) != 0) return -1;
    picture_make("a.exr", 40, 30, 0.1f);
    picture_make("b.exr", 40, 30, 0.0f);
    picture_make("a.png", 40, 30, 0.1f);
    picture_make("b.png", 40, 30, 0.0f);
    picture_make("small.png", 30, 40, 0.0f);
    return 0;
}

/* The object that `weft diff --json` prints; release with json_decref. */
static json_t *figures(const char *const *arguments, int code) {
    Ran ran = run_with(NULL, arguments);
    assert_int_equal(ran.code, code);
    json_error_t error;
    json_t *json = json_loads(ran.out, JSON_REJECT_DUPLICATES, &error);
    if (!json) fail_msg("%s: %.200s", error.text, ran.out);
    ran_free(&ran);
    return json;
}

static double number(const json_t *json, const char *key) {
    const json_t *value = json_object_get(json, key);
    if (!json_is_number(value)) fail_msg("\"%s\" is no number", key);
    return json_number_value(value);
}

/* The program says what the library finds. */
static void json_has_the_values_of_the_library(void **state) {
    (void)state;
    static const char *const pairs[][2] = {{"a.exr", "b.exr"}, {"a.png", "b.png"}, {"a.exr", "b.png"}};
    for (int metric = 0; metric < WEFT_METRIC_COUNT; metric++)
        for (int k = 0; k < 3; k++) {
            WeftImage images[2], map;
            WeftDiff found;
            for (int i = 0; i < 2; i++) assert_int_equal(weft_image_read(pairs[k][i], &images[i], NULL, NULL), WEFT_OK);
            const WeftDiffDesc desc = {.image = &images[0], .reference = &images[1], .metric = (WeftMetric)metric};
            assert_int_equal(weft_diff(&desc, &found, &map, NULL), WEFT_OK);
            json_t *json = figures(LIST("diff", pairs[k][0], pairs[k][1], "--metric",
                                        weft_metric_name((WeftMetric)metric), "--json", "--max", "0.5"),
                                   (metric == WEFT_METRIC_SSIM) == (found.value < 0.5) ? 1 : 0);
            const json_t *worst = json_object_get(json, "worst"), *range = json_object_get(json, "exposures");
            assert_true(fabs(number(json, "value") - found.value) < 1e-8);
            assert_true(fabs(number(json, "high") - (double)found.high) < 1e-6);
            assert_true(fabs(number(worst, "value") - (double)found.worst) < 1e-6);
            assert_true((int)number(worst, "x") == found.worst_x && (int)number(worst, "y") == found.worst_y);
            assert_true(fabs(number(json, "beyond") - weft_diff_beyond(&map, (WeftMetric)metric, 0.5)) < 1e-8);
            assert_int_equal((int)number(json, "width"), 40);
            assert_string_equal(json_string_value(json_object_get(json, "metric")),
                                weft_metric_name((WeftMetric)metric));
            assert_int_equal(range != NULL, metric == WEFT_METRIC_FLIP && k == 0);
            if (range) assert_int_equal((int)number(range, "count"), found.exposures);
            json_decref(json);
            weft_image_free(&images[0]), weft_image_free(&images[1]), weft_image_free(&map);
        }
}

/* 1 when the number is on the wrong side of --max, after the figures; equal pictures are never. */
static void max_decides_the_exit_code(void **state) {
    (void)state;
    static const struct {
        const char *metric, *passed, *failed, *equal;
    } bounds[] = {{"relmse", "1", "1e-6", "0"}, {"flip", "0.9", "1e-6", "0"}, {"ssim", "0.1", "0.9999", "1"}};
    for (size_t k = 0; k < sizeof bounds / sizeof *bounds; k++) {
        const char *metric = bounds[k].metric;
        Ran ran = RUN("diff", "a.png", "b.png", "--metric", metric, "--max", bounds[k].passed);
        assert_int_equal(ran.code, 0);
        assert_string_equal(ran.err, "");
        assert_non_null(strstr(ran.out, metric));
        ran_free(&ran);
        ran = RUN("diff", "a.png", "b.png", "--metric", metric, "--max", bounds[k].failed);
        assert_int_equal(ran.code, 1);
        assert_true(one_complaint(ran.err) && strstr(ran.err, metric));
        assert_non_null(strstr(ran.out, "beyond"));
        ran_free(&ran);
        ran = RUN("diff", "a.exr", "a.exr", "--metric", metric, "--max", bounds[k].equal);
        assert_int_equal(ran.code, 0);
        ran_free(&ran);
    }
    Ran ran = RUN("diff", "a.png", "b.png");
    assert_int_equal(ran.code, 0);
    assert_null(strstr(ran.out, "beyond"));
    ran_free(&ran);
}

/* What was rendered and what it was saved as are the same picture, but for half floats. */
static void linear_picture_equals_its_tone_mapped_form(void **state) {
    (void)state;
    json_t *json = figures(LIST("diff", "a.png", "a.exr", "--metric", "flip", "--json"), 0);
    assert_true(number(json, "value") < 0.01);
    json_decref(json);
    json = figures(LIST("diff", "a.png", "a.exr", "--metric", "flip", "--exposure", "1", "--json"), 0);
    assert_true(number(json, "value") > 0.1);
    json_decref(json);
    /* with --exposure two linear pictures are one picture each */
    json = figures(LIST("diff", "a.exr", "b.exr", "--metric", "flip", "--exposure", "0", "--json"), 0);
    json_t *shown = figures(LIST("diff", "a.png", "b.png", "--metric", "flip", "--json"), 0);
    assert_null(json_object_get(json, "exposures"));
    assert_true(fabs(number(json, "value") - number(shown, "value")) < 5e-3);
    json_decref(json), json_decref(shown);
}

static void difference_map_is_written_as_exr(void **state) {
    (void)state;
    static const char *const names[] = {"map.exr", "map.npy"};
    for (int k = 0; k < 2; k++) {
        WeftImage map;
        json_t *json = figures(LIST("diff", "a.exr", "b.exr", "-o", names[k], "--metric", "ssim", "--json"), 0);
        const json_t *worst = json_object_get(json, "worst");
        assert_int_equal(weft_image_read(names[k], &map, NULL, NULL), WEFT_OK);
        assert_true(map.width == 40 && map.height == 30 && map.channels == 1 && map.type == WEFT_PIXEL_F32);
        const size_t at = (size_t)(40.0 * number(worst, "y") + number(worst, "x"));
        assert_true(fabs((double)((float *)map.pixels)[at] - number(worst, "value")) < 1e-6);
        weft_image_free(&map);
        json_decref(json);
    }
}

/* How many pixels of a .png have nearly this colour. */
static int count_color(const char *path, int r, int g, int b) {
    WeftImage image;
    int count = 0;
    assert_int_equal(weft_image_read(path, &image, NULL, NULL), WEFT_OK);
    assert_int_equal(image.channels, 3);
    const uint8_t *p = image.pixels;
    for (int k = 0; k < image.width * image.height; k++, p += 3)
        count += abs(p[0] - r) + abs(p[1] - g) + abs(p[2] - b) < 12;
    weft_image_free(&image);
    return count;
}

/* The colours' ends are in its scale; with a short scale much of the picture has the last colour, with a long
 * one none. */
static void heat_map_is_written_as_png(void **state) {
    (void)state;
    Ran ran = RUN("diff", "a.png", "b.png", "--metric", "flip", "-o", "short.png", "--scale", "0.001");
    assert_int_equal(ran.code, 0);
    ran_free(&ran);
    ran = RUN("diff", "a.png", "b.png", "--metric", "flip", "-o", "long.png", "--scale", "1");
    assert_int_equal(ran.code, 0);
    ran_free(&ran);
    ran = RUN("diff", "a.png", "a.png", "--metric", "ssim", "-o", "same.png");
    assert_int_equal(ran.code, 0);
    ran_free(&ran);
    const int scale = count_color("long.png", 255, 242, 158);
    assert_true(scale > 5);
    assert_true(count_color("short.png", 255, 242, 158) > scale + 400);
    assert_true(count_color("same.png", 18, 18, 20) > 1200);
}

static void diff_commands_without_sense_are_refused(void **state) {
    (void)state;
    assert_complaint(NULL, LIST("diff", "a.png"), 2, "lacks an operand");
    assert_complaint(NULL, LIST("diff", "a.png", "b.png", "c.png"), 2, "one operand too many");
    assert_complaint(NULL, LIST("diff", "none.png", "b.png"), 3, "none.png: cannot be opened");
    assert_complaint(NULL, LIST("diff", "a.png", "none.png"), 3, "none.png: cannot be opened");
    file_make("text.png", "not a picture", 13);
    assert_complaint(NULL, LIST("diff", "text.png", "b.png"), 3, "text.png: ");
    assert_complaint(NULL, LIST("diff", "a.png", "small.png"), 2, "a.png: is 40 x 30 pixels, but small.png 30 x 40");
    assert_complaint(NULL, LIST("diff", "a.png", "b.png", "--metric", "psnr"), 2,
                     "\"psnr\" is not one of relmse, flip, ssim");
    assert_complaint(NULL, LIST("diff", "a.png", "b.png", "--tonemap", "filmic"), 2, "--tonemap");
    assert_complaint(NULL, LIST("diff", "a.png", "b.png", "--ppd", "0"), 2, "--ppd");
    assert_complaint(NULL, LIST("diff", "a.png", "b.png", "--max", "x"), 2, "--max");
    assert_complaint(NULL, LIST("diff", "a.png", "b.png", "--scale", "0"), 2, "--scale");
    assert_complaint(NULL, LIST("diff", "a.png", "b.png", "-o", "map.jpg"), 2, "map.jpg: ");
    assert_complaint(NULL, LIST("diff", "a.png", "b.png", "-o", "map.hdr"), 2, "map.hdr: ");
    assert_complaint(NULL, LIST("diff", "a.png", "b.png", "-o", "x.png", "-o", "y.png"), 2, "given twice");
    assert_complaint(NULL, LIST("diff", "a.png", "b.png", "-o", "no/map.png"), 4, "no/map.png: cannot be written");
    size_t size;
    assert_null(file_bytes("x.png", &size));
}

static void diff_help_names_every_option(void **state) {
    (void)state;
    static const char *const words[] = {"--metric", "--ppd",  "--exposure", "--tonemap", "--max", "-o",
                                        "--scale",  "--json", "relmse",     "flip",      "ssim",  "Examples"};
    Ran ran = RUN("diff", "--help");
    assert_int_equal(ran.code, 0);
    for (size_t k = 0; k < sizeof words / sizeof *words; k++)
        if (!strstr(ran.out, words[k])) fail_msg("weft diff --help lacks %s", words[k]);
    for (const char *line = ran.out; *line; line += strcspn(line, "\n") + 1) assert_true(strcspn(line, "\n") <= 80);
    ran_free(&ran);
    ran = RUN("--help");
    assert_non_null(strstr(ran.out, "\n  diff "));
    ran_free(&ran);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(json_has_the_values_of_the_library),
        cmocka_unit_test(max_decides_the_exit_code),
        cmocka_unit_test(linear_picture_equals_its_tone_mapped_form),
        cmocka_unit_test(difference_map_is_written_as_exr),
        cmocka_unit_test(heat_map_is_written_as_png),
        cmocka_unit_test(diff_commands_without_sense_are_refused),
        cmocka_unit_test(diff_help_names_every_option),
    };
    return cmocka_run_group_tests(tests, pictures_begin, work_end);
}
