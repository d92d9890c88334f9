/* Texture look-up: wrapping, filtering, formats, colour. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "base/random.h"
#include "scene/record/texture.h"
#include "shading/stack/surface_rows.h"

static WeftImage image_of(int width, int height, int channels, WeftPixelType type) {
    WeftImage image;
    assert_int_equal(weft_image_create(width, height, channels, type, &image, NULL), WEFT_OK);
    return image;
}

static void expect(Texel t, float r, float g, float b, float a) {
    const float want[4] = {r, g, b, a};
    for (int k = 0; k < 4; k++) assert_true(fabsf(t.c[k] - want[k]) < 1e-5f);
}

/* Every pixel type and channel count gives the same RGBA for the same content. */
static void textures_of_every_pixel_format_agree(void **state) {
    (void)state;
    SrgbTable srgb = srgb_table();
    for (int channels = 1; channels <= 4; channels++)
        for (int type = WEFT_PIXEL_U8; type <= WEFT_PIXEL_F32; type++) {
            WeftImage image = image_of(1, 1, channels, (WeftPixelType)type);
            static const int bytes[4] = {51, 102, 204, 153};
            for (int k = 0; k < channels; k++) {
                if (type == WEFT_PIXEL_U8) ((uint8_t *)image.pixels)[k] = (uint8_t)bytes[k];
                if (type == WEFT_PIXEL_U16) ((uint16_t *)image.pixels)[k] = (uint16_t)(bytes[k] * 257);
                if (type == WEFT_PIXEL_F32) ((float *)image.pixels)[k] = (float)bytes[k] / 255.0f;
            }
            Texture texture = {0};
            Texel t = texture_fetch(&texture, &image, NULL, 0.3f, 0.8f);
            if (channels == 1) expect(t, 0.2f, 0.2f, 0.2f, 1.0f);
            if (channels == 2) expect(t, 0.2f, 0.2f, 0.2f, 0.4f);
            if (channels == 3) expect(t, 0.2f, 0.4f, 0.8f, 1.0f);
            if (channels == 4) expect(t, 0.2f, 0.4f, 0.8f, 0.6f);
            Texel d = texture_fetch(&texture, &image, &srgb, 0.3f, 0.8f);
            assert_true(fabsf(d.c[3] - t.c[3]) < 1e-6f); /* alpha is never decoded */
            float decoded = powf((0.2f + 0.055f) / 1.055f, 2.4f);
            assert_true(fabsf(d.c[0] - (type == WEFT_PIXEL_F32 ? 0.2f : decoded)) < 1e-5f);
            weft_image_free(&image);
        }
}

static void texture_wrapping_follows_the_sampler(void **state) {
    (void)state;
    WeftImage image = image_of(4, 1, 1, WEFT_PIXEL_F32);
    memcpy(image.pixels, (float[4]){0.0f, 1.0f, 2.0f, 3.0f}, 4 * sizeof(float));
    static const struct {
        TextureWrap wrap;
        float u, value;
    } cases[] = {
        {WRAP_REPEAT, 0.125f, 0.0f},  {WRAP_REPEAT, 1.125f, 0.0f}, {WRAP_REPEAT, -0.125f, 3.0f},
        {WRAP_REPEAT, -7.125f, 3.0f}, {WRAP_REPEAT, 0.0f, 1.5f},   {WRAP_CLAMP, -5.0f, 0.0f},
        {WRAP_CLAMP, 5.0f, 3.0f},     {WRAP_CLAMP, 0.0f, 0.0f},    {WRAP_MIRROR, 1.125f, 3.0f},
        {WRAP_MIRROR, -0.375f, 1.0f}, {WRAP_MIRROR, 2.375f, 1.0f}, {WRAP_MIRROR, 1.0f, 3.0f},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        Texture texture = {.wrap_u = cases[k].wrap, .wrap_v = cases[k].wrap};
        assert_true(fabsf(texture_fetch(&texture, &image, NULL, cases[k].u, 0.5f).c[0] - cases[k].value) < 1e-4f);
    }
    weft_image_free(&image);
}

static void nearest_filter_does_not_blend(void **state) {
    (void)state;
    WeftImage image = image_of(2, 2, 1, WEFT_PIXEL_F32);
    memcpy(image.pixels, (float[4]){1.0f, 2.0f, 3.0f, 4.0f}, 4 * sizeof(float));
    Texture linear = {0}, nearest = {.nearest = true};
    assert_true(texture_fetch(&nearest, &image, NULL, 0.49f, 0.49f).c[0] == 1.0f);
    assert_true(texture_fetch(&nearest, &image, NULL, 0.51f, 0.99f).c[0] == 4.0f);
    assert_true(fabsf(texture_fetch(&linear, &image, NULL, 0.5f, 0.5f).c[0] - 2.5f) < 1e-6f);
    assert_true(fabsf(texture_fetch(&linear, &image, NULL, 0.5f, 0.25f).c[0] - 1.5f) < 1e-6f);
    weft_image_free(&image);
}

/* Any coordinate reads inside the image and gives a value between its extremes. */
static void lookup_at_extreme_coordinates_is_finite(void **state) {
    (void)state;
    static const float wild[] = {NAN, INFINITY, -INFINITY, 1e30f, -1e30f, 3e9f, -0.0f, 1e-40f};
    WeftImage image = image_of(3, 5, 3, WEFT_PIXEL_U8);
    for (int k = 0; k < 45; k++) ((uint8_t *)image.pixels)[k] = (uint8_t)(k * 5);
    for (int wrap = WRAP_REPEAT; wrap <= WRAP_CLAMP; wrap++)
        for (uint32_t k = 0; k < 64 + 2000; k++) {
            float u = k < 64 ? wild[k % 8] : 40.0f * unit_float(hash32(k)) - 20.0f;
            float v = k < 64 ? wild[k / 8] : 40.0f * unit_float(hash32(k + 9999)) - 20.0f;
            Texture texture = {.wrap_u = (TextureWrap)wrap, .wrap_v = (TextureWrap)wrap, .nearest = k % 2 == 0};
            Texel t = texture_fetch(&texture, &image, NULL, u, v);
            for (int c = 0; c < 3; c++) assert_true(t.c[c] >= 0.0f && t.c[c] <= 1.0f);
        }
    weft_image_free(&image);
}

/* Rows give what single lookups give: every type, number of channels, wrap and filter, wild coordinates among them. */
static void row_lookups_agree_with_single_lookups(void **state) {
    (void)state;
    static float u[ROW_CAPACITY], v[ROW_CAPACITY], c[4][ROW_CAPACITY];
    static const float wild[] = {NAN, INFINITY, -INFINITY, 1e30f, 1e6f, -1e6f, -0.0f, 1.0f};
    SrgbTable srgb = srgb_table();
    for (uint32_t run = 0; run < 3 * 4 * 9 * 2 * 2; run++) {
        int type = (int)(run % 3), channels = 1 + (int)(run / 3 % 4), wraps = (int)(run / 12 % 9);
        bool decode = run / 216 == 1;
        WeftImage image = image_of(7, 5, channels, (WeftPixelType)type);
        size_t bytes = (size_t)(35 * channels) * (type == WEFT_PIXEL_F32 ? 4 : type == WEFT_PIXEL_U16 ? 2 : 1);
        for (size_t k = 0; k < bytes; k++) ((uint8_t *)image.pixels)[k] = (uint8_t)hash32((uint32_t)k);
        for (int k = 0; type == WEFT_PIXEL_F32 && k < 35 * channels; k++)
            ((float *)image.pixels)[k] = unit_float(hash32((uint32_t)k));
        Texture texture = {
            .wrap_u = (TextureWrap)(wraps % 3), .wrap_v = (TextureWrap)(wraps / 3), .nearest = run / 108 % 2 == 1};
        int n = 1 + (int)(hash32(run) % ROW_MOST);
        for (int k = 0; k < row_whole(n); k++) {
            u[k] = k < 64 ? wild[k % 8] : 6.0f * unit_float(hash32((uint32_t)k)) - 3.0f;
            v[k] = k < 64 ? wild[k / 8] : 6.0f * unit_float(hash32((uint32_t)k + 999)) - 3.0f;
        }
        texture_fetch_rows(&texture, &image, decode ? &srgb : NULL, n, u, v, c[0]);
        for (int k = 0; k < n; k++) {
            Texel t = texture_fetch(&texture, &image, decode ? &srgb : NULL, u[k], v[k]);
            for (int a = 0; a < 4; a++) assert_true(fabsf(c[a][k] - t.c[a]) < 1e-5f);
        }
        weft_image_free(&image);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(textures_of_every_pixel_format_agree),
        cmocka_unit_test(texture_wrapping_follows_the_sampler),
        cmocka_unit_test(nearest_filter_does_not_blend),
        cmocka_unit_test(lookup_at_extreme_coordinates_is_finite),
        cmocka_unit_test(row_lookups_agree_with_single_lookups),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
