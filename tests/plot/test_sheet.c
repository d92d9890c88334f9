/* Sheets and differences: pixels stay pixels, labels are there, figures are those of a formula. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "weft/weft.h"

static WeftImage image_of(int width, int height, int channels, WeftPixelType type) {
    WeftImage image;
    assert_int_equal(weft_image_create(width, height, channels, type, &image, NULL), WEFT_OK);
    return image;
}

/* A picture that no label could be taken for: pixel (x, y) is (x, y, 77). */
static WeftImage pattern(int width, int height, int channels) {
    WeftImage image = image_of(width, height, channels, WEFT_PIXEL_U8);
    uint8_t *p = image.pixels;
    for (int k = 0; k < width * height; k++, p += channels) {
        p[0] = (uint8_t)(k % width);
        p[1] = (uint8_t)(k / width);
        p[2] = 77;
        if (channels == 4) p[3] = 255;
    }
    return image;
}

static const uint8_t *at(const WeftImage *sheet, int x, int y) {
    return (const uint8_t *)sheet->pixels + 3 * ((size_t)y * (size_t)sheet->width + (size_t)x);
}

/* Where the pattern lies, from the place (x, y) on in reading order; false: nowhere. */
static bool find(const WeftImage *sheet, const WeftImage *image, int *x, int *y) {
    for (; *y + image->height <= sheet->height; *y += 1, *x = 0)
        for (; *x + image->width <= sheet->width; *x += 1) {
            bool same = true;
            for (int r = 0; r < image->height && same; r++)
                for (int c = 0; c < image->width && same; c++)
                    same = memcmp(at(sheet, *x + c, *y + r),
                                  (const uint8_t *)image->pixels + (size_t)(image->channels * (r * image->width + c)),
                                  3) == 0;
            if (same) return true;
        }
    return false;
}

/* Pixels of a rectangle that differ from the sheet's corner. */
static int inked(const WeftImage *sheet, int x, int y, int width, int height) {
    int count = 0;
    for (int r = y; r < y + height && r < sheet->height; r++)
        for (int c = x; c < x + width && c < sheet->width; c++)
            count += memcmp(at(sheet, c, r), at(sheet, 0, 0), 3) != 0;
    return count;
}

static WeftImage compose(const WeftSheetDesc *desc) {
    WeftImage sheet;
    WeftError error;
    if (weft_sheet_compose(desc, &sheet, &error) != WEFT_OK) fail_msg("%s", error.text);
    assert_int_equal(sheet.channels, 3);
    assert_int_equal(sheet.type, WEFT_PIXEL_U8);
    return sheet;
}

static void pictures_on_a_sheet_are_unchanged(void **state) {
    (void)state;
    WeftImage one = pattern(250, 60, 3), two = pattern(250, 60, 4);
    WeftPanel panels[3] = {{.image = &one}, {.image = &two, .title = "charlie"}, {.image = &one}};
    WeftImage sheet = compose(&(WeftSheetDesc){.panels = panels, .count = 3, .columns = 2});
    int x = 0, y = 0, first_x, first_y;
    assert_true(find(&sheet, &one, &x, &y));
    first_x = x++;
    first_y = y;
    assert_true(find(&sheet, &one, &x, &y)); /* its neighbour, opaque */
    assert_true(y == first_y && x >= first_x + 250);
    assert_true(inked(&sheet, x, y + 60, 250, 30) > 50); /* the title */
    assert_int_equal(inked(&sheet, first_x, first_y + 60, 250, 20), 0);
    x++;
    assert_true(find(&sheet, &one, &x, &y)); /* the second row begins where the first does */
    assert_true(x == first_x && y >= first_y + 60);
    weft_image_free(&sheet);
    weft_image_free(&one);
    weft_image_free(&two);
}

static void transparent_picture_shows_the_sheet(void **state) {
    (void)state;
    WeftImage image = pattern(240, 20, 4);
    for (int k = 0; k < 240 * 20; k++) ((uint8_t *)image.pixels)[4 * k + 3] = 0;
    WeftPanel panel = {.image = &image};
    WeftImage sheet = compose(&(WeftSheetDesc){.panels = &panel, .count = 1, .columns = 1});
    assert_int_equal(inked(&sheet, 0, 0, sheet.width, sheet.height), 0);
    weft_image_free(&sheet);
    weft_image_free(&image);
}

/* Type never leaves the place of its panel, whatever the text. */
static void long_labels_stay_inside_their_panel(void **state) {
    (void)state;
    char longest[2000];
    memset(longest, 'M', sizeof longest - 1);
    longest[sizeof longest - 1] = '\0';
    static const char damaged[] = "caf\xc3\xa9 \xff\xc3 \xed\xa0\x80 \xf8\x88 tab\tbell\a";
    const char *const texts[] = {longest, damaged, "", "\xe2\x88\x92 minus"};
    for (size_t t = 0; t < sizeof texts / sizeof *texts; t++) {
        WeftImage image = pattern(240, 20, 3);
        WeftPanel panels[2] = {{.image = &image, .title = texts[t], .note = texts[t]}, {.image = &image}};
        WeftImage sheet = compose(&(WeftSheetDesc){.caption = texts[t], .panels = panels, .count = 2, .columns = 2});
        int x = 0, y = 0, second;
        assert_true(find(&sheet, &image, &x, &y));
        second = ++x;
        assert_true(find(&sheet, &image, &second, &y));
        /* nothing in the gap, below the neighbour, in the margins */
        assert_int_equal(inked(&sheet, x + 239, y + 20, sheet.width - x - 239, sheet.height), 0);
        assert_int_equal(inked(&sheet, 0, 0, x - 1, sheet.height), 0);
        assert_int_equal(inked(&sheet, 0, sheet.height - 10, sheet.width, 10), 0);
        if (texts[t][0]) assert_true(inked(&sheet, x, y + 20, 239, 40) > 20);
        weft_image_free(&sheet);
        weft_image_free(&image);
    }
}

/* The rows below the pictures in which there is type, as bands with nothing between. */
static int lines_of_type(const char *title, int *below) {
    WeftImage image = pattern(240, 20, 3);
    WeftPanel panel = {.image = &image, .title = title};
    WeftImage sheet = compose(&(WeftSheetDesc){.panels = &panel, .count = 1, .columns = 1});
    int x = 0, y = 0, bands = 0;
    assert_true(find(&sheet, &image, &x, &y));
    *below = sheet.height - y - 20;
    bool before = false;
    for (int row = y + 20; row < sheet.height; row++) {
        bool type = inked(&sheet, 0, row, sheet.width, 1) > 0;
        bands += type && !before;
        before = type;
    }
    assert_int_equal(inked(&sheet, x + 240, y + 20, sheet.width, sheet.height), 0);
    weft_image_free(&sheet);
    weft_image_free(&image);
    return bands;
}

/* Two long ids with a minus between stand one below the other; one word that is too long stays one line. */
static void long_titles_take_two_lines(void **state) {
    (void)state;
    int one, two;
    assert_int_equal(lines_of_type("seed \xe2\x88\x92 additive", &one), 1);
    assert_int_equal(lines_of_type("MMMMMMMMMMMMMMM \xe2\x88\x92 NNNNNNNNNNNNNNN", &two), 2);
    assert_true(two > one + 8);
    assert_int_equal(lines_of_type("MMMMMMMMMMMMMMMMMMMMMMMMMMMMMMMMMMMMMMMMMMMM", &two), 1);
    assert_int_equal(two, one);
}

static void sheet_descriptors_without_sense_are_refused(void **state) {
    (void)state;
    WeftImage image = pattern(8, 8, 3), linear = image_of(8, 8, 3, WEFT_PIXEL_F32), sheet;
    WeftImage wide = image_of(20000, 1, 3, WEFT_PIXEL_U8);
    WeftPanel good = {.image = &image}, floats = {.image = &linear}, two[2] = {{.image = &wide}, {0}};
    const WeftSheetDesc wrong[] = {
        {.panels = &good, .count = 0, .columns = 1},     {.panels = &good, .count = 1, .columns = 2},
        {.panels = &good, .count = 1, .columns = 0},     {.panels = NULL, .count = 1, .columns = 1},
        {.panels = &floats, .count = 1, .columns = 1},   {.panels = two, .count = 2, .columns = 2},
        {.panels = &good, .count = 100000, .columns = 1}};
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        WeftError error;
        assert_int_equal(weft_sheet_compose(&wrong[k], &sheet, &error), WEFT_USAGE);
        assert_int_equal(error.message, WEFT_MESSAGE_DESC);
        assert_null(sheet.pixels);
    }
    weft_image_free(&image);
    weft_image_free(&linear);
    weft_image_free(&wide);
}

/* A grey reference of 0.5, and an image that is 0.1 off in green of one pixel in four. */
static void figures_below_a_picture_follow_their_formula(void **state) {
    (void)state;
    enum { COUNT = 400 };
    WeftImage a = image_of(20, 20, 4, WEFT_PIXEL_F32), b = image_of(20, 20, 4, WEFT_PIXEL_F32);
    float *pa = a.pixels, *pb = b.pixels;
    for (int k = 0; k < 4 * COUNT; k++) pa[k] = pb[k] = k % 4 == 3 ? 1.0f : 0.5f;
    for (int k = 0; k < COUNT; k += 4) pa[4 * k + 1] += 0.1f;
    WeftDifference found;
    assert_int_equal(weft_difference(&a, &b, &found, NULL), WEFT_OK);
    assert_true(fabs(found.mean - 0.1 / 12.0) < 1e-7);
    assert_true(fabs(found.relmse - 0.01 / 0.26 / 12.0) < 1e-7);
    assert_true(fabsf(found.high - 0.1f) < 1e-6f);
    assert_int_equal(weft_difference(&b, &b, &found, NULL), WEFT_OK);
    assert_true(found.mean <= 0.0 && found.relmse <= 0.0 && found.high <= 0.0f);
    /* three of 400 pixels are less than one in a hundred */
    memcpy(pa, pb, 4 * COUNT * sizeof *pa);
    for (int k = 0; k < 3; k++) pa[4 * k] += 2.0f;
    assert_int_equal(weft_difference(&a, &b, &found, NULL), WEFT_OK);
    assert_true(found.high <= 0.0f);
    /* what is not there cannot differ */
    for (int k = 0; k < COUNT; k++) pa[4 * k + 3] = pb[4 * k + 3] = 0.0f;
    assert_int_equal(weft_difference(&a, &b, &found, NULL), WEFT_OK);
    assert_true(found.mean <= 0.0);
    weft_image_free(&b);
    b = image_of(20, 19, 4, WEFT_PIXEL_F32);
    WeftError error;
    assert_int_equal(weft_difference(&a, &b, &found, &error), WEFT_USAGE);
    assert_int_equal(error.message, WEFT_MESSAGE_DESC);
    weft_image_free(&a);
    weft_image_free(&b);
}

static float luma(const uint8_t *p) { return 0.2126f * (float)p[0] + 0.7152f * (float)p[1] + 0.0722f * (float)p[2]; }

/* Brighter is red before blue, darker blue before red; both lighter the more, and the ends stay. */
static void difference_colours_show_sign_and_size(void **state) {
    (void)state;
    enum { STEPS = 41 };
    WeftImage a = image_of(STEPS, 1, 3, WEFT_PIXEL_F32), b = image_of(STEPS, 1, 3, WEFT_PIXEL_F32), map;
    for (int k = 0; k < 3 * STEPS; k++) {
        ((float *)a.pixels)[k] = 1.0f + 0.1f * (float)(k / 3 - STEPS / 2);
        ((float *)b.pixels)[k] = 1.0f;
    }
    assert_int_equal(weft_difference_image(&a, &b, 1.0f, &map, NULL), WEFT_OK);
    const uint8_t *p = map.pixels, *middle = p + 3 * (STEPS / 2);
    assert_true(luma(middle) < 24.0f);
    for (int k = 1; k <= STEPS / 2; k++) {
        const uint8_t *up = middle + 3 * k, *down = middle - 3 * k;
        assert_true(up[0] > up[2] && down[2] > down[0]);
        assert_true(luma(up) >= luma(up - 3) && luma(down) >= luma(down + 3));
        if (k <= 10) assert_true(luma(up) > luma(up - 3) && luma(down) > luma(down + 3));
        if (k > 10) assert_memory_equal(up, middle + 30, 3);
    }
    weft_image_free(&map);
    WeftError error;
    const float wrong[] = {0.0f, -1.0f, NAN, INFINITY};
    for (int k = 0; k < 4; k++) assert_int_equal(weft_difference_image(&a, &b, wrong[k], &map, &error), WEFT_USAGE);
    weft_image_free(&a);
    weft_image_free(&b);
}

/* The scale of a sheet shows the colours of the maps, from one end to the other. */
static void scale_of_the_map_is_drawn(void **state) {
    (void)state;
    WeftImage image = pattern(300, 80, 3);
    WeftPanel panels[2] = {{.scale = 0.5f, .title = "difference"}, {.image = &image}};
    WeftImage sheet = compose(&(WeftSheetDesc){.panels = panels, .count = 2, .columns = 2});
    int blue = 0, red = 0;
    for (int y = 0; y < sheet.height; y++)
        for (int x = 0; x < sheet.width / 2; x++) {
            const uint8_t *p = at(&sheet, x, y);
            blue += p[2] > p[0] + 60;
            red += p[0] > p[2] + 60;
        }
    assert_true(blue > 300 && red > 300);
    weft_image_free(&sheet);
    weft_image_free(&image);
}

/* A map's colours begin at `none` with black and end at `most`, whichever is larger; so do those of its
 * legend, which stands below. */
static void map_is_drawn_with_heat_colours(void **state) {
    (void)state;
    static const float ends[][2] = {{0.0f, 0.5f}, {1.0f, 0.5f}, {-1.0f, 3.0f}};
    WeftImage map = image_of(300, 40, 1, WEFT_PIXEL_F32), heat;
    for (size_t t = 0; t < sizeof ends / sizeof *ends; t++) {
        const float none = ends[t][0], most = ends[t][1];
        for (int k = 0; k < 300 * 40; k++)
            ((float *)map.pixels)[k] = none + (most - none) * (1.5f * (float)(k % 300) / 300.0f - 0.25f);
        assert_int_equal(weft_heat_image(&map, none, most, &heat, NULL), WEFT_OK);
        const uint8_t *p = heat.pixels;
        for (int x = 1; x < 300; x++) assert_true(luma(p + 3 * x) >= luma(p + 3 * x - 3));
        assert_memory_equal(p, p + 3 * 49, 3);
        assert_memory_equal(p + 3 * 299, p + 3 * 251, 3);
        assert_true(luma(p) < 24.0f && luma(p + 3 * 299) > 220.0f);
        WeftPanel panel = {.image = &heat, .title = "a map", .none = none, .most = most};
        WeftImage with = compose(&(WeftSheetDesc){.panels = &panel, .count = 1, .columns = 1});
        panel.most = none;
        WeftImage without = compose(&(WeftSheetDesc){.panels = &panel, .count = 1, .columns = 1});
        assert_int_equal(with.width, without.width);
        assert_true(with.height > without.height + 12);
        int last = 0, x = 0, y = 0;
        assert_true(find(&with, &heat, &x, &y));
        for (int row = y + 40; row < with.height; row++) last += memcmp(at(&with, x + 299, row), p + 3 * 299, 3) == 0;
        assert_true(last > 4);
        weft_image_free(&heat), weft_image_free(&with), weft_image_free(&without);
    }
    const float wrong[][2] = {{0.0f, 0.0f}, {NAN, 1.0f}, {0.0f, INFINITY}};
    for (int k = 0; k < 3; k++)
        assert_int_equal(weft_heat_image(&map, wrong[k][0], wrong[k][1], &heat, NULL), WEFT_USAGE);
    weft_image_free(&map);
    map = image_of(4, 4, 3, WEFT_PIXEL_F32);
    assert_int_equal(weft_heat_image(&map, 0.0f, 1.0f, &heat, NULL), WEFT_USAGE);
    weft_image_free(&map);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(map_is_drawn_with_heat_colours),
        cmocka_unit_test(pictures_on_a_sheet_are_unchanged),
        cmocka_unit_test(transparent_picture_shows_the_sheet),
        cmocka_unit_test(long_labels_stay_inside_their_panel),
        cmocka_unit_test(sheet_descriptors_without_sense_are_refused),
        cmocka_unit_test(figures_below_a_picture_follow_their_formula),
        cmocka_unit_test(difference_colours_show_sign_and_size),
        cmocka_unit_test(scale_of_the_map_is_drawn),
        cmocka_unit_test(long_titles_take_two_lines),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
