/* Properties of the tone curves, the exposure and the dither. */
#include "image/fixture.h"

#include <math.h>

#include "image/srgb.h"
#define WEFT_LIBM /* as tonemap.c has it */
#include "shading/dialect/tone.h"

static const WeftTonemap curves[] = {WEFT_TONEMAP_PBR_NEUTRAL, WEFT_TONEMAP_ACES, WEFT_TONEMAP_NONE};

static WeftImage tonemapped(const WeftImage *image, WeftTonemap curve, float exposure) {
    WeftImage out;
    assert_int_equal(weft_image_tonemap(image, curve, exposure, &out, NULL), WEFT_OK);
    return out;
}

/* An image of one colour, large enough for a mean over the dither. */
enum { SIDE = 32 };

static WeftImage flat(float r, float g, float b) {
    WeftImage image = make_image(SIDE, SIDE, 3, WEFT_PIXEL_F32);
    float *values = image.pixels;
    for (size_t i = 0; i < value_total(&image); i += 3) {
        values[i] = r;
        values[i + 1] = g;
        values[i + 2] = b;
    }
    return image;
}

/* The mean display value, 0 .. 1, of each channel. */
static void mean(float r, float g, float b, WeftTonemap curve, float exposure, double out[3]) {
    WeftImage image = flat(r, g, b), mapped = tonemapped(&image, curve, exposure);
    const unsigned char *bytes = mapped.pixels;
    out[0] = out[1] = out[2] = 0.0;
    for (size_t i = 0; i < value_total(&mapped); i++) out[i % 3] += bytes[i] / (255.0 * SIDE * SIDE);
    weft_image_free(&mapped);
    weft_image_free(&image);
}

static void tone_curves_are_monotone_and_keep_grey(void **state) {
    (void)state;
    for (int k = 0; k < 3; k++) {
        WeftImage before = flat(0.0f, 0.0f, 0.0f), last = tonemapped(&before, curves[k], 0.0f);
        weft_image_free(&before);
        for (int step = -270; step < 240; step++) {
            const float x = powf(1.05f, (float)step); /* 2e-6 to 1e5 */
            WeftImage image = flat(x, x, x), next = tonemapped(&image, curves[k], 0.0f);
            const unsigned char *lower = last.pixels, *higher = next.pixels;
            for (size_t i = 0; i < value_total(&next); i++) {
                assert_true(higher[i] >= lower[i]);
                assert_int_equal(higher[i], higher[i - i % 3]);
            }
            weft_image_free(&image);
            weft_image_free(&last);
            last = next;
        }
        assert_int_equal(((unsigned char *)last.pixels)[0], 255);
        weft_image_free(&last);
    }
}

static void tone_mapped_background_is_unchanged(void **state) {
    (void)state;
    static const float white[3] = {1.0f, 1.0f, 1.0f}, grey[3] = {0.25f, 0.25f, 0.25f};
    float pixels[3 * 4] = {0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.5f, 0.3f, 0.3f, 0.3f, 1.0f};
    const WeftImage image = {.width = 3, .height = 1, .channels = 4, .type = WEFT_PIXEL_F32, .pixels = pixels};
    const int half = (int)(255.0f * tone_encode(0.5f)), quarter = (int)(255.0f * tone_encode(0.25f));
    WeftImage over, alone;
    for (int k = 0; k < 3; k++)
        for (float exposure = -2.0f; exposure < 3.0f; exposure += 1.0f) {
            assert_int_equal(weft_image_tonemap_over(&image, curves[k], exposure, white, &over, NULL), WEFT_OK);
            assert_int_equal(weft_image_tonemap(&image, curves[k], exposure, &alone, NULL), WEFT_OK);
            const unsigned char *p = over.pixels;
            for (int c = 0; c < 4; c++) assert_int_equal(p[c], 255);
            assert_in_range(p[4], half, half + 1); /* half the light, not half the value */
            assert_memory_equal(p + 8, (const unsigned char *)alone.pixels + 8, 4);
            weft_image_free(&over);
            assert_int_equal(weft_image_tonemap_over(&image, curves[k], exposure, grey, &over, NULL), WEFT_OK);
            assert_in_range(*(const unsigned char *)over.pixels, quarter, quarter + 1);
            weft_image_free(&over);
            weft_image_free(&alone);
        }
}

/* Khronos' aim: a base colour of 0.08 to 0.76, lit by 1, plus the 4 % of a dielectric's reflection, shows as
 * the base colour. */
static void neutral_keeps_base_colours(void **state) {
    (void)state;
    for (int i = 0; i <= 6; i++)
        for (int j = 0; j <= 5; j++) {
            const float r = 0.08f + 0.11f * (float)i, g = 0.08f + 0.13f * (float)j, b = 0.3f;
            double shown[3];
            mean(r + 0.04f, g + 0.04f, b + 0.04f, WEFT_TONEMAP_PBR_NEUTRAL, 0.0f, shown);
            const float want[] = {tone_encode(r), tone_encode(g), tone_encode(b)};
            for (int c = 0; c < 3; c++) assert_true(fabs(shown[c] - (double)want[c]) < 0.1 / 255.0);
        }
}

/* Values worked out by hand from the published formulas. */
static void tone_curves_have_their_published_values(void **state) {
    (void)state;
    double shown[3];
    mean(1.0f, 1.0f, 1.0f, WEFT_TONEMAP_ACES, 0.0f, shown);
    assert_true(fabs(shown[0] - (double)tone_encode(2.54f / 3.16f)) < 0.1 / 255.0);
    /* peak 1 - 0.04, new peak 1 - 0.24^2 / (0.96 + 0.24 - 0.76) */
    mean(1.0f, 1.0f, 1.0f, WEFT_TONEMAP_PBR_NEUTRAL, 0.0f, shown);
    assert_true(fabs(shown[0] - (double)tone_encode(1.0f - 0.0576f / 0.44f)) < 0.1 / 255.0);
    /* below the offset's knee: 0.05 - (0.05 - 6.25 * 0.05^2) */
    mean(0.05f, 0.05f, 0.05f, WEFT_TONEMAP_PBR_NEUTRAL, 0.0f, shown);
    assert_true(fabs(shown[0] - (double)tone_encode(0.015625f)) < 0.1 / 255.0);
    mean(0.5f, 0.001f, 7.0f, WEFT_TONEMAP_NONE, 0.0f, shown);
    assert_true(fabs(shown[0] - (double)tone_encode(0.5f)) < 0.1 / 255.0);
    assert_true(fabs(shown[1] - (double)tone_encode(0.001f)) < 0.1 / 255.0);
    assert_true(fabs(shown[2] - 1.0) < 1e-9);
}

/* A bright colour goes to white, and no curve gives a grey a hue. */
static void neutral_desaturates_bright_colours(void **state) {
    (void)state;
    double dim[3], bright[3];
    mean(0.5f, 0.1f, 0.1f, WEFT_TONEMAP_PBR_NEUTRAL, 0.0f, dim);
    mean(500.0f, 100.0f, 100.0f, WEFT_TONEMAP_PBR_NEUTRAL, 0.0f, bright);
    assert_true(dim[1] < 0.6 * dim[0]);
    assert_true(bright[1] > 0.97 * bright[0]);
}

static void exposure_is_in_stops(void **state) {
    (void)state;
    for (int k = 0; k < 3; k++) {
        WeftImage one = flat(0.2f, 0.05f, 0.11f), two = flat(0.4f, 0.1f, 0.22f);
        WeftImage pushed = tonemapped(&one, curves[k], 1.0f), plain = tonemapped(&two, curves[k], 0.0f);
        assert_memory_equal(pushed.pixels, plain.pixels, value_total(&plain));
        weft_image_free(&pushed);
        weft_image_free(&plain);
        weft_image_free(&one);
        weft_image_free(&two);
    }
}

/* Half way between two bytes both come up equally often; a byte's own value always gives that byte; the same
 * input gives the same output. */
static void dither_is_even_exact_and_repeatable(void **state) {
    (void)state;
    for (int byte = 1; byte < 255; byte += 23) {
        double shown[3];
        const float between = srgb_decode(((float)byte + 0.5f) / 255.0f);
        mean(between, between, between, WEFT_TONEMAP_NONE, 0.0f, shown);
        assert_true(fabs(shown[0] * 255.0 - byte - 0.5) < 0.03);
        WeftImage image = flat(between, between, between);
        WeftImage once = tonemapped(&image, WEFT_TONEMAP_NONE, 0.0f),
                  again = tonemapped(&image, WEFT_TONEMAP_NONE, 0.0f);
        assert_memory_equal(once.pixels, again.pixels, value_total(&once));
        const unsigned char *bytes = once.pixels;
        for (size_t i = 0; i < value_total(&once); i++) assert_in_range(bytes[i], byte, byte + 1);
        weft_image_free(&once);
        weft_image_free(&again);
        weft_image_free(&image);
    }
    WeftImage white = flat(1.0f, 0.0f, 1.0f), shown = tonemapped(&white, WEFT_TONEMAP_NONE, 0.0f);
    const unsigned char *bytes = shown.pixels;
    for (size_t i = 0; i < value_total(&shown); i++) assert_int_equal(bytes[i], i % 3 == 1 ? 0 : 255);
    weft_image_free(&shown);
    weft_image_free(&white);
}

static void tone_curves_of_odd_numbers_are_finite(void **state) {
    (void)state;
    static const float odd[] = {NAN, -NAN, -INFINITY, -3.0f, -1e-30f, INFINITY, 3e38f, 1e-40f};
    for (int k = 0; k < 3; k++)
        for (int stop = -200; stop <= 200; stop += 100)
            for (size_t i = 0; i < sizeof odd / sizeof *odd; i++) {
                WeftImage image = make_image(2, 1, 4, WEFT_PIXEL_F32);
                float *values = image.pixels;
                for (int c = 0; c < 4; c++) values[c] = odd[i];
                WeftImage out = tonemapped(&image, curves[k], (float)stop);
                const unsigned char *bytes = out.pixels;
                const int large = odd[i] > 1.0f;
                assert_int_equal(bytes[3], large ? 255 : 0);
                if (stop == 0)
                    for (int c = 0; c < 3; c++) assert_int_equal(bytes[c], large ? 255 : 0);
                weft_image_free(&out);
                weft_image_free(&image);
            }
}

static void tone_mapped_alpha_is_linear(void **state) {
    (void)state;
    WeftImage image = make_image(5, 1, 4, WEFT_PIXEL_F32);
    float *values = image.pixels;
    for (int x = 0; x < 5; x++) values[4 * x + 3] = (float)x / 4.0f;
    WeftImage out = tonemapped(&image, WEFT_TONEMAP_PBR_NEUTRAL, 3.0f);
    static const int want[] = {0, 64, 128, 191, 255};
    for (int x = 0; x < 5; x++) assert_int_equal(((unsigned char *)out.pixels)[4 * x + 3], want[x]);
    weft_image_free(&out);
    weft_image_free(&image);
}

static void tone_mapping_of_unsuitable_images_is_refused(void **state) {
    (void)state;
    WeftImage grey = make_image(1, 1, 2, WEFT_PIXEL_F32), bytes = make_image(1, 1, 3, WEFT_PIXEL_U8);
    WeftImage good = make_image(1, 1, 3, WEFT_PIXEL_F32), out;
    WeftError error = {0};
    assert_int_equal(weft_image_tonemap(&grey, WEFT_TONEMAP_NONE, 0.0f, &out, &error), WEFT_USAGE);
    assert_int_equal(error.message, WEFT_MESSAGE_DESC);
    assert_int_equal(weft_image_tonemap(&bytes, WEFT_TONEMAP_NONE, 0.0f, &out, NULL), WEFT_USAGE);
    assert_int_equal(weft_image_tonemap(&good, (WeftTonemap)3, 0.0f, &out, NULL), WEFT_USAGE);
    assert_int_equal(weft_image_tonemap(&good, WEFT_TONEMAP_NONE, NAN, &out, NULL), WEFT_USAGE);
    assert_null(out.pixels);
    weft_image_free(&grey);
    weft_image_free(&bytes);
    weft_image_free(&good);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tone_mapped_background_is_unchanged),
        cmocka_unit_test(tone_curves_are_monotone_and_keep_grey),
        cmocka_unit_test(neutral_keeps_base_colours),
        cmocka_unit_test(tone_curves_have_their_published_values),
        cmocka_unit_test(neutral_desaturates_bright_colours),
        cmocka_unit_test(exposure_is_in_stops),
        cmocka_unit_test(dither_is_even_exact_and_repeatable),
        cmocka_unit_test(tone_curves_of_odd_numbers_are_finite),
        cmocka_unit_test(tone_mapped_alpha_is_linear),
        cmocka_unit_test(tone_mapping_of_unsuitable_images_is_refused),
    };
    return cmocka_run_group_tests_name("tonemap", tests, NULL, NULL);
}
