/* Radiance files byte by byte: the three codes, eight orientations, header lines, and damage. */
#include "image/fixture.h"

#include <math.h>

static Bytes header(const char *lines, const char *resolution) {
    Bytes bytes = {.size = 0};
    put_text(&bytes, "#?RADIANCE\n# made by a test\nFORMAT=32-bit_rle_rgbe\n");
    put_text(&bytes, lines);
    put_text(&bytes, "\n");
    put_text(&bytes, resolution);
    put_text(&bytes, "\n");
    return bytes;
}

static const float *pixel(const WeftImage *image, int x, int y) {
    return (const float *)image->pixels + 3 * (y * image->width + x);
}

/* Pixel n of the file has red n + 1, as mantissa (n + 1) * 2 and exponent 7. */
static void put_pixel(Bytes *bytes, int n) {
    put(bytes, (unsigned char[]){(unsigned char)(2 * (n + 1)), 64, 0, 128 + 7}, 4);
}

static void hdr_of_every_orientation_is_read_upright(void **state) {
    (void)state;
    enum { WIDTH = 3, HEIGHT = 2 };
    for (int i = 0; i < 8; i++) {
        const int x_first = i & 1, right = i & 2, up = i & 4;
        char line[32];
        if (x_first)
            snprintf(line, sizeof line, "%cX %d %cY %d", right ? '-' : '+', WIDTH, up ? '+' : '-', HEIGHT);
        else
            snprintf(line, sizeof line, "%cY %d %cX %d", up ? '+' : '-', HEIGHT, right ? '-' : '+', WIDTH);
        Bytes bytes = header("", line);
        for (int n = 0; n < WIDTH * HEIGHT; n++) put_pixel(&bytes, n);
        refuse_prefixes(&bytes);
        WeftImage image = read_bytes(&bytes);
        assert_shape(&image, WIDTH, HEIGHT, 3, WEFT_PIXEL_F32);
        for (int n = 0; n < WIDTH * HEIGHT; n++) {
            int x = x_first ? n / HEIGHT : n % WIDTH, y = x_first ? n % HEIGHT : n / WIDTH;
            if (right) x = WIDTH - 1 - x;
            if (up) y = HEIGHT - 1 - y;
            assert_near(pixel(&image, x, y)[0], (float)(n + 1), 0.0f);
            assert_near(pixel(&image, x, y)[1], 32.0f, 0.0f);
            assert_near(pixel(&image, x, y)[2], 0.0f, 0.0f);
        }
        weft_image_free(&image);
    }
}

/* A pixel and a run; two markers count 5 + 1 * 256. */
static void hdr_old_run_lengths_are_read(void **state) {
    (void)state;
    Bytes bytes = header("", "-Y 2 +X 262");
    put_pixel(&bytes, 0);
    put(&bytes, (unsigned char[]){1, 1, 1, 5, 1, 1, 1, 1}, 8);
    put_pixel(&bytes, 1);
    put(&bytes, (unsigned char[]){1, 1, 1, 250}, 4);
    for (int n = 2; n < 13; n++) put_pixel(&bytes, n);
    refuse_prefixes(&bytes);
    WeftImage image = read_bytes(&bytes);
    for (int x = 0; x < 262; x++) {
        assert_near(pixel(&image, x, 0)[0], 1.0f, 0.0f);
        assert_near(pixel(&image, x, 1)[0], (float)(x < 251 ? 2 : x - 251 + 3), 0.0f);
    }
    weft_image_free(&image);

    bytes = header("", "-Y 1 +X 4"); /* a run over the end of the line */
    put_pixel(&bytes, 0);
    put(&bytes, (unsigned char[]){1, 1, 1, 4}, 4);
    refuse(&bytes, WEFT_MESSAGE_IMAGE_DAMAGED);
    bytes = header("", "-Y 1 +X 4"); /* a run of nothing */
    for (int n = 0; n < 4; n++) put(&bytes, (unsigned char[]){1, 1, 1, 1}, 4);
    refuse(&bytes, WEFT_MESSAGE_IMAGE_DAMAGED);
}

static void hdr_new_run_lengths_are_read(void **state) {
    (void)state;
    Bytes bytes = header("", "-Y 1 +X 9");
    const size_t start = bytes.size;
    put(&bytes, (unsigned char[]){2, 2, 0, 9}, 4);
    put(&bytes, (unsigned char[]){0x85, 2, 4, 4, 6, 8, 10}, 7); /* five 2 and a dump */
    put(&bytes, (unsigned char[]){0x89, 64, 0x89, 0}, 4);
    put(&bytes, (unsigned char[]){0x88, 135, 1, 0}, 4); /* the last pixel's exponent makes it black */
    refuse_prefixes(&bytes);
    WeftImage image = read_bytes(&bytes);
    for (int x = 0; x < 9; x++) {
        assert_near(pixel(&image, x, 0)[0], (float)(x == 8 ? 0 : x < 5 ? 1 : x - 5 + 2), 0.0f);
        assert_near(pixel(&image, x, 0)[1], x == 8 ? 0.0f : 32.0f, 0.0f);
    }
    weft_image_free(&image);

    Bytes damaged = bytes;
    damaged.data[start + 3] = 8; /* another length than the image's */
    refuse(&damaged, WEFT_MESSAGE_IMAGE_DAMAGED);
    damaged = bytes;
    damaged.data[start + 4] = 0x8a; /* a run over the end of the line */
    refuse(&damaged, WEFT_MESSAGE_IMAGE_DAMAGED);
    damaged = bytes;
    damaged.data[start + 6] = 0; /* a dump of nothing */
    refuse(&damaged, WEFT_MESSAGE_IMAGE_DAMAGED);
}

/* Radiance is what is stored divided by all EXPOSURE and COLORCORR factors. */
static void hdr_exposure_and_colour_correction_are_undone(void **state) {
    (void)state;
    Bytes bytes = header("EXPOSURE=2\nCOLORCORR= 1 4 1\nEXPOSURE=0.25\n", "-Y 1 +X 1");
    put_pixel(&bytes, 0);
    WeftImage image = read_bytes(&bytes);
    assert_near(pixel(&image, 0, 0)[0], 2.0f, 1e-6f);
    assert_near(pixel(&image, 0, 0)[1], 16.0f, 1e-6f);
    weft_image_free(&image);

    static const char *const wrong[] = {"EXPOSURE=0\n", "EXPOSURE=-1\n",   "EXPOSURE=nan\n",
                                        "EXPOSURE=\n",  "COLORCORR=1 2\n", "EXPOSURE=1e-20\nEXPOSURE=1e-20\n"};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        bytes = header(wrong[i], "-Y 1 +X 1");
        put_pixel(&bytes, 0);
        refuse(&bytes, WEFT_MESSAGE_IMAGE_DAMAGED);
    }
}

static void hdr_values_that_are_not_finite_are_a_warning(void **state) {
    (void)state;
    Bytes bytes = header("EXPOSURE=1e-20\n", "-Y 1 +X 2");
    put(&bytes, (unsigned char[]){200, 0, 100, 255, 128, 128, 128, 128}, 8);
    int warnings = 0;
    const WeftLog log = {count_warning, &warnings};
    WeftImage image;
    assert_int_equal(weft_image_read_memory(bytes.data, bytes.size, "bytes", &image, &log, NULL), WEFT_OK);
    assert_int_equal(warnings, 1);
    for (int c = 0; c < 3; c++) assert_near(pixel(&image, 0, 0)[c], 0.0f, 0.0f);
    assert_true(pixel(&image, 1, 0)[0] > 1e19f);
    weft_image_free(&image);
}

/* A line of the header that would change the picture is applied, or named. */
static void hdr_header_lines_are_applied_or_named(void **state) {
    (void)state;
    static const struct {
        const char *line, *said;
    } lines[] = {
        {"PRIMARIES= 0.64 0.33 0.3 0.6 0.15 0.06 0.3127 0.329\n", NULL},
        {"PRIMARIES=0.64 0.33\n", "\"PRIMARIES=0.64 0.33\" is not understood"},
        {"PRIMARIES= .3 .3 .3 .3 .3 .3 .3 .3\n", "are those of no colours"},
        {"PIXASPECT=1.000\n", NULL},
        {"PIXASPECT=2\n", "\"PIXASPECT=2\" is passed over"},
        {"GAMMA=1\n", NULL},
        {"GAMMA=2.2\n", "\"GAMMA=2.2\" is passed over"},
        {"EXPOSURE=1 stop\n", "has more than its factors"},
        {"SOFTWARE=pfilt\nVIEW= -vtv\n", NULL},
    };
    for (size_t k = 0; k < sizeof lines / sizeof *lines; k++) {
        Bytes bytes = header(lines[k].line, "-Y 1 +X 1");
        put_pixel(&bytes, 0);
        WeftImage image = lines[k].said ? read_bytes_said(&bytes, lines[k].said) : read_bytes(&bytes);
        assert_near(pixel(&image, 0, 0)[0], 1.0f, 1e-6f);
        weft_image_free(&image);
    }
    Bytes bytes = header("exposure = 2\n", "-Y 1 +X 1"); /* any case */
    put_pixel(&bytes, 0);
    WeftImage image = read_bytes(&bytes);
    assert_near(pixel(&image, 0, 0)[0], 0.5f, 1e-6f);
    weft_image_free(&image);
    /* red and green of Display P3 are beyond Rec. 709; its white is white */
    bytes = header("PRIMARIES= .68 .32 .265 .69 .15 .06 .3127 .329\n", "-Y 1 +X 2");
    put(&bytes, (unsigned char[]){128, 0, 0, 129, 128, 128, 128, 129}, 8);
    image = read_bytes_said(&bytes, "was applied");
    assert_near(pixel(&image, 0, 0)[0], 1.2249f, 2e-3f);
    assert_near(pixel(&image, 0, 0)[1], -0.0420f, 2e-3f);
    assert_near(pixel(&image, 0, 0)[2], -0.0197f, 2e-3f);
    for (int c = 0; c < 3; c++) assert_near(pixel(&image, 1, 0)[c], 1.0f, 1e-3f);
    weft_image_free(&image);
}

static void hdr_of_xyz_becomes_rec709(void **state) {
    (void)state;
    Bytes bytes = {.size = 0};
    put_text(&bytes, "#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n");
    put(&bytes, (unsigned char[]){122, 128, 139, 129}, 4); /* X Y Z of white, as near as bytes come */
    WeftImage image = read_bytes(&bytes);
    for (int c = 0; c < 3; c++) assert_near(pixel(&image, 0, 0)[c], 1.0f, 0.02f);
    weft_image_free(&image);
}

static void malformed_hdr_is_refused(void **state) {
    (void)state;
    Bytes bytes = {.size = 0};
    put_text(&bytes, "#?RADIANCE\nFORMAT=32-bit_rle_yuve\n\n-Y 1 +X 1\n....");
    refuse(&bytes, WEFT_MESSAGE_IMAGE_UNSUPPORTED);
    static const char *const wrong[] = {"-Y 1 +Y 1", "-Y 1", "Y 1 X 1", "-Y 0 +X 1", "-Y -1 +X 1", "-Y 1 +X 1 1"};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        bytes = header("", wrong[i]);
        put_pixel(&bytes, 0);
        refuse(&bytes, WEFT_MESSAGE_IMAGE_DAMAGED);
    }
    static const char *const large[] = {"-Y 65537 +X 1", "-Y 1 +X 99999", "-Y 65536 +X 65536", "-Y 40 +X 300"};
    for (size_t i = 0; i < sizeof large / sizeof *large; i++) {
        bytes = header("", large[i]);
        put_pixel(&bytes, 0);
        refuse(&bytes, WEFT_MESSAGE_IMAGE_SIZE);
    }
}

/* Written values come back within half a step of the shared exponent, for widths in and out of what runs can
 * code, and lines that mix runs with noise. */
static void hdr_reads_what_it_wrote(void **state) {
    (void)state;
    static const int widths[] = {1, 7, 8, 127, 128, 129, 131, 300, 32768};
    for (size_t i = 0; i < sizeof widths / sizeof *widths; i++)
        for (int channels = 3; channels <= 4; channels++) {
            WeftImage image = make_image(widths[i], 3, channels, WEFT_PIXEL_F32);
            float *values = image.pixels;
            uint32_t random = 1;
            for (size_t n = 0; n < value_total(&image); n++) {
                if (n % 11 < 6) random = random * 1664525u + 1013904223u; /* else a run */
                values[n] = ldexpf((float)(random >> 8), (int)(random & 31) - 30);
            }
            WeftImage back = write_and_read(&image, ".hdr");
            assert_shape(&back, widths[i], 3, 3, WEFT_PIXEL_F32);
            for (size_t p = 0; p < (size_t)widths[i] * 3; p++) {
                const float *from = values + p * (size_t)channels, *to = (const float *)back.pixels + 3 * p;
                const float largest = fmaxf(from[0], fmaxf(from[1], from[2]));
                for (int c = 0; c < 3; c++) assert_true(fabsf(to[c] - from[c]) <= largest / 255.0f);
            }
            weft_image_free(&back);
            weft_image_free(&image);
        }
}

static void hdr_writes_extreme_values_finite(void **state) {
    (void)state;
    WeftImage image = make_image(8, 1, 3, WEFT_PIXEL_F32);
    float *values = image.pixels;
    values[0] = NAN;
    values[3] = -1.0f;
    values[6] = INFINITY;
    values[9] = 3e38f;
    values[12] = 1e-36f;
    values[15] = 0x1.ffp0f; /* would round to a mantissa of 256 */
    WeftImage back = write_and_read(&image, ".hdr");
    assert_near(pixel(&back, 0, 0)[0], 0.0f, 0.0f);
    assert_near(pixel(&back, 1, 0)[0], 0.0f, 0.0f);
    assert_true(pixel(&back, 2, 0)[0] > 1e38f);
    assert_true(pixel(&back, 3, 0)[0] > 1e38f);
    assert_near(pixel(&back, 4, 0)[0], 0.0f, 0.0f);
    assert_near(pixel(&back, 5, 0)[0], 2.0f, 0.0f);
    weft_image_free(&back);
    weft_image_free(&image);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hdr_of_every_orientation_is_read_upright),
        cmocka_unit_test(hdr_old_run_lengths_are_read),
        cmocka_unit_test(hdr_new_run_lengths_are_read),
        cmocka_unit_test(hdr_exposure_and_colour_correction_are_undone),
        cmocka_unit_test(hdr_values_that_are_not_finite_are_a_warning),
        cmocka_unit_test(hdr_header_lines_are_applied_or_named),
        cmocka_unit_test(hdr_of_xyz_becomes_rec709),
        cmocka_unit_test(malformed_hdr_is_refused),
        cmocka_unit_test(hdr_reads_what_it_wrote),
        cmocka_unit_test(hdr_writes_extreme_values_finite),
    };
    return cmocka_run_group_tests_name("hdr", tests, NULL, NULL);
}
