/* Properties of the tone curves, the exposure and the dither. */
#include "image/fixture.h"

#include <math.h>

#include "image/srgb.h"
#define WEFT_LIBM /* as tonemap.c has it */
#include "shading/dialect/tone.h"

static const WeftTonemap curves[WEFT_TONEMAP_COUNT] = {WEFT_TONEMAP_PBR_NEUTRAL, WEFT_TONEMAP_ACES, WEFT_TONEMAP_NONE,
                                                       WEFT_TONEMAP_AGX};

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
    for (int k = 0; k < WEFT_TONEMAP_COUNT; k++) {
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
    for (int k = 0; k < WEFT_TONEMAP_COUNT; k++)
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

/* AgX in double precision from its published matrices and polynomial, as light of a display. */
static void agx(const double rgb[3], double out[3]) {
    static const double inset[9] = {0.842479062253094,  0.0784335999999992, 0.0792237451477643,
                                    0.0423282422610123, 0.878468636469772,  0.0791661274605434,
                                    0.0423756549057051, 0.0784336,          0.879142973793104};
    static const double outset[9] = {1.19687900512017,    -0.0980208811401368, -0.0990297440797205,
                                     -0.0528968517574562, 1.15190312990417,    -0.0989611768448433,
                                     -0.0529716355144438, -0.0980434501171241, 1.15107367264116};
    double curved[3];
    for (int c = 0; c < 3; c++) {
        const double v = inset[3 * c] * rgb[0] + inset[3 * c + 1] * rgb[1] + inset[3 * c + 2] * rgb[2];
        const double x = (fmin(fmax((log2)(fmax(v, 1e-10)), -12.47393), 4.026069) + 12.47393) / 16.5;
        const double x2 = x * x, x4 = x2 * x2;
        curved[c] = 15.5 * x4 * x2 - 40.14 * x4 * x + 31.96 * x4 - 6.868 * x2 * x + 0.4298 * x2 + 0.1191 * x - 0.00232;
    }
    for (int c = 0; c < 3; c++) {
        const double v = outset[3 * c] * curved[0] + outset[3 * c + 1] * curved[1] + outset[3 * c + 2] * curved[2];
        out[c] = (pow)(fmin(fmax(v, 0.0), 1.0), 2.2);
    }
}

/* To a step of 8 bits: black and white are those of the display, which the published polynomial misses by 0.0023 and
 * 0.0014. */
static void agx_has_its_published_values(void **state) {
    (void)state;
    static const double colors[][3] = {{0.18, 0.18, 0.18}, {1.0, 1.0, 1.0},    {0.9, 0.1, 0.05}, {0.02, 0.3, 0.9},
                                       {4.0, 2.0, 0.5},    {0.01, 0.02, 0.01}, {0.0, 0.6, 0.0},  {12.0, 0.2, 9.0}};
    for (size_t k = 0; k < sizeof colors / sizeof *colors; k++) {
        double want[3], shown[3];
        agx(colors[k], want);
        mean((float)colors[k][0], (float)colors[k][1], (float)colors[k][2], WEFT_TONEMAP_AGX, 0.0f, shown);
        for (int c = 0; c < 3; c++) {
            const double display = (double)tone_encode((float)want[c]);
            if (fabs(shown[c] - display) > 1.0 / 255.0)
                fail_msg("colour %d, channel %d is %g, and AgX has %g", (int)k, c, shown[c], display);
        }
    }
}

static const float none[2] = {0.0f, 0.0f};

/* Fills the Rec. 709 colour, with a greatest channel of 1, of white paper in light of a chromaticity. */
static void light_of(const float white[2], float rgb[3]) {
    const double x = (double)(white[0] / white[1]), z = (double)((1.0f - white[0] - white[1]) / white[1]);
    static const double from_xyz[9] = {3.2404542, -1.5371385, -0.4985314, -0.9692660, 1.8760108,
                                       0.0415560, 0.0556434,  -0.2040259, 1.0572252};
    double most = 0.0, c[3];
    for (int k = 0; k < 3; k++) {
        c[k] = from_xyz[3 * k] * x + from_xyz[3 * k + 1] + from_xyz[3 * k + 2] * z;
        most = fmax(most, c[k]);
    }
    for (int k = 0; k < 3; k++) rgb[k] = (float)(c[k] / most);
}

/* A grey card under a lamp is grey when the lamp's light is white, by its temperature and as it is found. */
static void grey_card_under_a_lamp_is_grey(void **state) {
    (void)state;
    static const float lamps[][2] = {{2200, 0}, {2856, 0}, {2856, 12}, {4000, -8}, {5003, 0}, {6504, 5}, {20000, 0}};
    for (size_t k = 0; k < sizeof lamps / sizeof *lamps; k++) {
        float white[2], rgb[3], found[2], m[9];
        weft_white(lamps[k][0], lamps[k][1], white);
        light_of(white, rgb);
        if (rgb[0] < 0.0f || rgb[1] < 0.0f || rgb[2] < 0.0f)
            fail_msg("%g K is no colour of Rec. 709", (double)lamps[k][0]);
        WeftImage card = flat(0.3f * rgb[0], 0.3f * rgb[1], 0.3f * rgb[2]);
        weft_image_find_white(&card, found);
        assert_true(fabsf(found[0] - white[0]) < 1e-4f && fabsf(found[1] - white[1]) < 1e-4f);
        for (int way = 0; way < 2; way++) {
            weft_white_matrix(way ? found : white, m);
            float c[3];
            for (int a = 0; a < 3; a++) c[a] = m[3 * a] * rgb[0] + m[3 * a + 1] * rgb[1] + m[3 * a + 2] * rgb[2];
            if (fabsf(c[0] / c[1] - 1.0f) > 2e-3f || fabsf(c[2] / c[1] - 1.0f) > 2e-3f)
                fail_msg("under %g K grey is %g %g %g", (double)lamps[k][0], (double)c[0], (double)c[1], (double)c[2]);
        }
        WeftImage shown;
        assert_int_equal(weft_image_show(&card, &(WeftTone){.white = {white[0], white[1]}}, NULL, &shown, NULL),
                         WEFT_OK);
        const unsigned char *p = shown.pixels;
        assert_in_range(p[0], p[1] - 1, p[1] + 1);
        assert_in_range(p[2], p[1] - 1, p[1] + 1);
        weft_image_free(&shown);
        weft_image_free(&card);
    }
}

/* D65 and illuminant A by their published chromaticities; greener light is above the curve; and there is no jump. */
static void temperatures_are_those_of_lights(void **state) {
    (void)state;
    float w[2], other[2], m[9];
    weft_white(6504.0f, 0.0f, w);
    assert_true(fabsf(w[0] - 0.3127f) < 2e-4f && fabsf(w[1] - 0.3290f) < 2e-4f);
    weft_white_matrix(w, m);
    for (int k = 0; k < 9; k++) assert_true(fabsf(m[k] - (k % 4 == 0 ? 1.0f : 0.0f)) < 2e-3f);
    weft_white(2856.0f, 0.0f, w);
    assert_true(fabsf(w[0] - 0.4476f) < 5e-4f && fabsf(w[1] - 0.4074f) < 5e-4f);
    weft_white(2856.0f, 10.0f, other);
    assert_true(other[1] > w[1] + 0.005f);
    weft_white(1700.0f, 0.0f, w);
    for (float t = 1710.0f; t < 25000.0f; t += 10.0f) {
        weft_white(t, 0.0f, other);
        assert_true(other[0] < w[0] && fabsf(other[1] - w[1]) < 2e-3f);
        w[0] = other[0], w[1] = other[1];
    }
    weft_white_matrix(none, m);
    for (int k = 0; k < 9; k++) assert_true(m[k] == (k % 4 == 0 ? 1.0f : 0.0f));
}

/* Whatever the brightness of a picture, its mean is shown as middle grey; lamps and black corners in it do not count. */
static void metered_pictures_are_middle_grey(void **state) {
    (void)state;
    for (float light = 1e-6f; light < 1e7f; light *= 30.0f) {
        WeftImage image = flat(light, light, light);
        float *values = image.pixels;
        assert_true(fabsf(light * exp2f(weft_image_meter(&image)) / 0.18f - 1.0f) < 1e-3f);
        for (int k = 0; k < 3 * SIDE * SIDE / 30; k++)
            values[k] = 1e12f, values[value_total(&image) - 1 - (size_t)k] = 1e-9f;
        assert_true(fabsf(light * exp2f(weft_image_meter(&image)) / 0.18f - 1.0f) < 1e-3f);
        weft_image_free(&image);
    }
    WeftImage black = flat(0.0f, 0.0f, 0.0f);
    float white[2] = {1.0f, 1.0f};
    assert_true(weft_image_meter(&black) == 0.0f);
    weft_image_find_white(&black, white);
    assert_true(white[0] == 0.0f && white[1] == 0.0f);
    weft_image_free(&black);
    /* the geometric mean of 1 and 16 */
    WeftImage two = flat(1.0f, 1.0f, 1.0f);
    for (int k = 0; k < 3 * SIDE * SIDE / 2; k++) ((float *)two.pixels)[k] = 16.0f;
    assert_true(fabsf(weft_image_meter(&two) - log2f(0.18f / 4.0f)) < 1e-3f);
    weft_image_free(&two);
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
    for (int k = 0; k < WEFT_TONEMAP_COUNT; k++) {
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
    for (int k = 0; k < WEFT_TONEMAP_COUNT; k++)
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
    assert_int_equal(weft_image_tonemap(&good, WEFT_TONEMAP_COUNT, 0.0f, &out, NULL), WEFT_USAGE);
    assert_int_equal(weft_image_tonemap(&good, WEFT_TONEMAP_NONE, NAN, &out, NULL), WEFT_USAGE);
    assert_int_equal(weft_image_show(&good, &(WeftTone){.white = {0.7f, 0.7f}}, NULL, &out, &error), WEFT_USAGE);
    assert_int_equal(weft_image_show(&good, &(WeftTone){.white = {0.3f, 0.0f}}, NULL, &out, &error), WEFT_USAGE);
    assert_int_equal(weft_image_show(&good, &(WeftTone){.white = {NAN, 0.3f}}, NULL, &out, &error), WEFT_USAGE);
    assert_null(out.pixels);
    assert_null(weft_tonemap_name(WEFT_TONEMAP_COUNT));
    assert_null(weft_tonemap_name(-1));
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
        cmocka_unit_test(agx_has_its_published_values),
        cmocka_unit_test(grey_card_under_a_lamp_is_grey),
        cmocka_unit_test(temperatures_are_those_of_lights),
        cmocka_unit_test(metered_pictures_are_middle_grey),
        cmocka_unit_test(neutral_desaturates_bright_colours),
        cmocka_unit_test(exposure_is_in_stops),
        cmocka_unit_test(dither_is_even_exact_and_repeatable),
        cmocka_unit_test(tone_curves_of_odd_numbers_are_finite),
        cmocka_unit_test(tone_mapped_alpha_is_linear),
        cmocka_unit_test(tone_mapping_of_unsuitable_images_is_refused),
    };
    return cmocka_run_group_tests_name("tonemap", tests, NULL, NULL);
}
