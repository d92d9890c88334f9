/* WebP as libwebp writes it: lossless and lossy, with and without alpha; animations, damage and false sizes. */
#include "image/fixture.h"

#include <webp/encode.h>

enum { WIDTH = 31, HEIGHT = 17 };

/* A picture of smooth colours whose alpha goes from 0 to 255. */
static void pixels_make(unsigned char *out, int channels) {
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++, out += channels) {
            const unsigned char rgba[4] = {(unsigned char)(8 * x), (unsigned char)(15 * y),
                                           (unsigned char)(255 - 8 * x), (unsigned char)(255 - 15 * y)};
            memcpy(out, rgba, (size_t)channels);
        }
}

static Bytes webp_make(const unsigned char *pixels, int channels, bool lossless) {
    Bytes bytes = {.size = 0};
    unsigned char *data = NULL;
    const int stride = WIDTH * channels;
    const size_t size = lossless        ? (channels == 4 ? WebPEncodeLosslessRGBA(pixels, WIDTH, HEIGHT, stride, &data)
                                                         : WebPEncodeLosslessRGB(pixels, WIDTH, HEIGHT, stride, &data))
                        : channels == 4 ? WebPEncodeRGBA(pixels, WIDTH, HEIGHT, stride, 95.0f, &data)
                                        : WebPEncodeRGB(pixels, WIDTH, HEIGHT, stride, 95.0f, &data);
    assert_true(size > 0);
    put(&bytes, data, size);
    WebPFree(data);
    return bytes;
}

static void webp_of_every_form_is_read(void **state) {
    (void)state;
    unsigned char pixels[WIDTH * HEIGHT * 4];
    for (int channels = 3; channels <= 4; channels++)
        for (int lossless = 0; lossless < 2; lossless++) {
            pixels_make(pixels, channels);
            Bytes bytes = webp_make(pixels, channels, lossless == 1);
            WeftImage image = read_bytes(&bytes);
            assert_shape(&image, WIDTH, HEIGHT, channels, WEFT_PIXEL_U8);
            const unsigned char *got = image.pixels;
            for (size_t k = 0; k < value_total(&image); k++) {
                const bool hidden = channels == 4 && pixels[k / 4 * 4 + 3] == 0; /* its colour is the encoder's */
                if (!hidden) assert_near((float)got[k], (float)pixels[k], lossless ? 0.0f : 24.0f);
            }
            weft_image_free(&image);
        }
}

static void damaged_webp_is_refused(void **state) {
    (void)state;
    unsigned char pixels[WIDTH * HEIGHT * 4];
    pixels_make(pixels, 4);
    for (int lossless = 0; lossless < 2; lossless++) {
        Bytes bytes = webp_make(pixels, 4, lossless == 1);
        for (size_t size = 12; size < bytes.size; size++) {
            unsigned char *exact = malloc(size);
            assert_non_null(exact);
            memcpy(exact, bytes.data, size);
            WeftImage image;
            WeftError error = {0};
            assert_int_equal(weft_image_read_memory(exact, size, "bytes", &image, NULL, &error), WEFT_INPUT);
            assert_null(image.pixels);
            free(exact);
        }
    }
    static const unsigned char animated[] = "RIFF\x2e\0\0\0WEBPVP8X\x0a\0\0\0\x02\0\0\0\x0f\0\0\x0f\0\0"
                                            "ANIM\x06\0\0\0\0\0\0\0\0\0ANMF\0\0\0\0";
    refuse_bytes(animated, sizeof animated - 1, WEFT_MESSAGE_IMAGE_DAMAGED);
}

static void put_number(Bytes *bytes, int number, int count) {
    const uint64_t bits = (uint64_t)number;
    for (int k = 0; k < count; k++) put_byte(bytes, (int)(bits >> (8 * k) & 255));
}

/* Puts a picture as a frame of an animation, at an even place of the canvas. */
static void frame_put(Bytes *bytes, const Bytes *picture, int left, int top) {
    enum { RIFF_HEADER = 12, FRAME_HEADER = 16, MILLISECONDS = 100 };
    const int size = (int)picture->size - RIFF_HEADER;
    put_text(bytes, "ANMF");
    put_number(bytes, FRAME_HEADER + size, 4);
    put_number(bytes, left / 2, 3), put_number(bytes, top / 2, 3);
    put_number(bytes, WIDTH - 1, 3), put_number(bytes, HEIGHT - 1, 3), put_number(bytes, MILLISECONDS, 3);
    put_byte(bytes, 0);
    put(bytes, picture->data + RIFF_HEADER, (size_t)size);
}

/* The canvas is larger than the first frame, by 4 columns on its left and 2 rows above. */
static void animated_webp_shows_its_first_picture_with_a_warning(void **state) {
    (void)state;
    enum { LEFT = 4, TOP = 2, ANIMATION = 2, ALPHA = 16 };
    unsigned char pixels[2][WIDTH * HEIGHT * 4];
    Bytes bytes = {.size = 0};
    pixels_make(pixels[0], 4);
    for (size_t k = 0; k < sizeof pixels[1]; k++) pixels[1][k] = (unsigned char)(255 - pixels[0][k]);
    put_text(&bytes, "RIFF....WEBPVP8X");
    put_number(&bytes, 10, 4), put_number(&bytes, ANIMATION | ALPHA, 4);
    put_number(&bytes, WIDTH + LEFT - 1, 3), put_number(&bytes, HEIGHT + TOP - 1, 3);
    put_text(&bytes, "ANIM");
    put_number(&bytes, 6, 4), put_number(&bytes, 0, 6);
    for (int k = 0; k < 2; k++) {
        const Bytes picture = webp_make(pixels[k], 4, true);
        frame_put(&bytes, &picture, k ? 0 : LEFT, k ? 0 : TOP);
    }
    for (int k = 0; k < 4; k++) bytes.data[4 + k] = (unsigned char)((bytes.size - 8) >> (8 * k) & 255);
    int warnings = 0;
    const WeftLog log = {count_warning, &warnings};
    WeftImage image;
    WeftError error = {0};
    if (weft_image_read_memory(bytes.data, bytes.size, "bytes", &image, &log, &error) != WEFT_OK)
        fail_msg("%s", error.text);
    assert_int_equal(warnings, 1);
    assert_shape(&image, WIDTH + LEFT, HEIGHT + TOP, 4, WEFT_PIXEL_U8);
    for (int y = 0; y < HEIGHT + TOP; y++)
        for (int x = 0; x < WIDTH + LEFT; x++) {
            const unsigned char *got = (unsigned char *)image.pixels + 4 * (y * (WIDTH + LEFT) + x);
            const bool beside = x < LEFT || y < TOP;
            const unsigned char *want = pixels[0] + (beside ? 0 : 4 * ((y - TOP) * WIDTH + x - LEFT));
            assert_int_equal(got[3], beside ? 0 : want[3]);
            for (int c = 0; c < 3 && got[3]; c++) assert_int_equal(got[c], want[c]);
        }
    weft_image_free(&image);
}

/* 16383 x 16383 pixels of a file of 30 bytes. */
static void webp_of_a_false_size_is_refused_before_memory_is_taken(void **state) {
    (void)state;
    static const unsigned char huge[] = "RIFF\x16\0\0\0WEBPVP8L\x0a\0\0\0\x2f\xfe\xbf\xff\x0f\0\0\0\0\0";
    refuse_bytes(huge, sizeof huge - 1, WEFT_MESSAGE_IMAGE_SIZE);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(webp_of_every_form_is_read),
        cmocka_unit_test(damaged_webp_is_refused),
        cmocka_unit_test(animated_webp_shows_its_first_picture_with_a_warning),
        cmocka_unit_test(webp_of_a_false_size_is_refused_before_memory_is_taken),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
