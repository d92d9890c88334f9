/* JPEG as libjpeg writes it: grey, colour, CMYK, progressive; damage and scan bombs. */
#include "image/fixture.h"

#include <jpeglib.h>

enum { WIDTH = 50, HEIGHT = 40 };

typedef struct Form {
    int components;
    J_COLOR_SPACE from, to;
    int progressive, sampling;
} Form;

/* One smooth colour, which JPEG keeps within a few steps: value[c] at the top, less further down. */
static Bytes jpeg_make(Form form, const unsigned char value[4]) {
    Bytes bytes = {.size = 0};
    struct jpeg_compress_struct jpeg;
    struct jpeg_error_mgr errors;
    jpeg.err = jpeg_std_error(&errors);
    jpeg_create_compress(&jpeg);
    unsigned char *data = NULL;
    unsigned long size = 0;
    jpeg_mem_dest(&jpeg, &data, &size);
    jpeg.image_width = WIDTH;
    jpeg.image_height = HEIGHT;
    jpeg.input_components = form.components;
    jpeg.in_color_space = form.from;
    jpeg_set_defaults(&jpeg);
    jpeg_set_colorspace(&jpeg, form.to);
    jpeg_set_quality(&jpeg, 95, TRUE);
    jpeg.comp_info[0].h_samp_factor = jpeg.comp_info[0].v_samp_factor = form.sampling;
    if (form.progressive) jpeg_simple_progression(&jpeg);
    jpeg_start_compress(&jpeg, TRUE);
    for (int y = 0; y < HEIGHT; y++) {
        JSAMPLE row[WIDTH * 4];
        JSAMPROW pointer = row;
        for (int i = 0; i < WIDTH * form.components; i++) row[i] = (JSAMPLE)(value[i % form.components] - y);
        jpeg_write_scanlines(&jpeg, &pointer, 1);
    }
    jpeg_finish_compress(&jpeg);
    jpeg_destroy_compress(&jpeg);
    put(&bytes, data, size);
    free(data);
    return bytes;
}

static const Form forms[] = {
    {1, JCS_GRAYSCALE, JCS_GRAYSCALE, 0, 1},
    {1, JCS_GRAYSCALE, JCS_GRAYSCALE, 1, 1},
    {3, JCS_RGB, JCS_YCbCr, 0, 2},
    {3, JCS_RGB, JCS_YCbCr, 1, 2},
    {3, JCS_RGB, JCS_RGB, 0, 1},
    {4, JCS_CMYK, JCS_CMYK, 0, 1},
    {4, JCS_CMYK, JCS_YCCK, 1, 2},
};

static const unsigned char value[4] = {220, 140, 60, 200};

static void jpeg_of_every_sampling_is_read(void **state) {
    (void)state;
    for (size_t i = 0; i < sizeof forms / sizeof *forms; i++) {
        Bytes bytes = jpeg_make(forms[i], value);
        WeftImage image = read_bytes(&bytes);
        const int channels = forms[i].components == 1 ? 1 : 3;
        assert_shape(&image, WIDTH, HEIGHT, channels, WEFT_PIXEL_U8);
        for (int n = 0; n < WIDTH * HEIGHT * channels; n++) {
            const int y = n / channels / WIDTH, c = n % channels;
            int want = value[c] - y;
            /* libjpeg marks CMYK as Adobe does, whose numbers are 255 - ink: what is left of white */
            if (forms[i].components == 4) want = want * (value[3] - y) / 255;
            assert_true(abs(((unsigned char *)image.pixels)[n] - want) <= 4);
        }
        weft_image_free(&image);
    }
}

/* Without Adobe's mark the numbers are ink. */
static void jpeg_of_plain_cmyk_is_read_as_ink(void **state) {
    (void)state;
    Bytes bytes = jpeg_make(forms[5], value), plain = {.size = 0};
    size_t at = 2;
    put(&plain, bytes.data, at);
    while (bytes.data[at + 1] == 0xee || bytes.data[at + 1] == 0xe0) /* drop APP14, Adobe's */
        at += 2 + (size_t)(bytes.data[at + 2] << 8 | bytes.data[at + 3]);
    put(&plain, bytes.data + at, bytes.size - at);
    assert_true(plain.size < bytes.size);
    WeftImage image = read_bytes(&plain);
    for (int c = 0; c < 3; c++)
        assert_true(abs(((unsigned char *)image.pixels)[c] - (255 - value[c]) * (255 - value[3]) / 255) <= 4);
    weft_image_free(&image);
}

/* A cut file is refused, or read with a warning once its picture has begun. */
static void truncated_jpeg_is_refused_or_read_with_a_warning(void **state) {
    (void)state;
    for (size_t i = 0; i < sizeof forms / sizeof *forms; i++) {
        Bytes bytes = jpeg_make(forms[i], value);
        int repaired = 0, refused = 0;
        for (size_t size = 3; size + 2 < bytes.size; size += 7) {
            WeftImage image;
            int warnings = 0;
            const WeftLog log = {count_warning, &warnings};
            WeftError error = {0};
            if (weft_image_read_memory(bytes.data, size, "bytes", &image, &log, &error) == WEFT_OK) {
                assert_int_equal(warnings, 1);
                weft_image_free(&image);
                repaired++;
            } else {
                assert_int_equal(error.result, WEFT_INPUT);
                refused++;
            }
        }
        assert_true(repaired > 0 && refused > 0);
    }
}

/* Many scans that each refine nothing new: libjpeg alone would visit all blocks for each. */
static void jpeg_with_too_many_scans_is_refused(void **state) {
    (void)state;
    Bytes bytes = jpeg_make(forms[1], value);
    size_t start = 2, end;
    while (bytes.data[start + 1] != 0xda) start += 2 + (size_t)(bytes.data[start + 2] << 8 | bytes.data[start + 3]);
    for (end = start + 2; bytes.data[end] != 0xff || bytes.data[end + 1] == 0; end++) {
    }
    Bytes bomb = {.size = 0};
    put(&bomb, bytes.data, start);
    for (int i = 0; i < 150; i++) put(&bomb, bytes.data + start, end - start);
    put(&bomb, "\xff\xd9", 2);
    refuse(&bomb, WEFT_MESSAGE_IMAGE_UNSUPPORTED);
}

static void jpeg_that_claims_too_many_pixels_is_refused(void **state) {
    (void)state;
    Bytes bytes = jpeg_make(forms[2], value);
    size_t frame = 2;
    while (bytes.data[frame + 1] != 0xc0) frame += 2 + (size_t)(bytes.data[frame + 2] << 8 | bytes.data[frame + 3]);
    Bytes changed = bytes;
    memset(changed.data + frame + 5, 0xff, 2);
    memset(changed.data + frame + 7, 0xff, 2);
    refuse(&changed, WEFT_MESSAGE_IMAGE_DAMAGED); /* libjpeg's own limit is 65500 */
    memcpy(changed.data + frame + 5, (unsigned char[]){0xf0, 0, 0xf0, 0}, 4);
    refuse(&changed, WEFT_MESSAGE_IMAGE_SIZE);
    changed = bytes;
    changed.data[frame + 1] = 0xc9; /* arithmetic coding */
    refuse(&changed, WEFT_MESSAGE_IMAGE_UNSUPPORTED);
    changed = bytes;
    changed.data[frame + 4] = 12; /* bits a sample */
    refuse(&changed, WEFT_MESSAGE_IMAGE_UNSUPPORTED);
    changed = bytes;
    changed.data[frame + 1] = 0xc3; /* lossless */
    refuse(&changed, WEFT_MESSAGE_IMAGE_UNSUPPORTED);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(jpeg_of_every_sampling_is_read),
        cmocka_unit_test(jpeg_of_plain_cmyk_is_read_as_ink),
        cmocka_unit_test(truncated_jpeg_is_refused_or_read_with_a_warning),
        cmocka_unit_test(jpeg_with_too_many_scans_is_refused),
        cmocka_unit_test(jpeg_that_claims_too_many_pixels_is_refused),
    };
    return cmocka_run_group_tests_name("jpeg", tests, NULL, NULL);
}
