/* PNG: every colour type and depth as libpng writes it, round trips of ours, and damage. */
#include "image/fixture.h"

#include <png.h>

enum { WIDTH = 11, HEIGHT = 9 };

static void append(png_structp png, png_bytep data, size_t size) { put(png_get_io_ptr(png), data, size); }
static void flush(png_structp png) { (void)png; }

/* The sample of channel c at (x, y), as deep as depth says. */
static unsigned sample(int x, int y, int c, int depth) {
    return (unsigned)(x * 2659 + y * 7919 + c * 12007) & ((1u << depth) - 1);
}

static const png_color palette[16] = {{0, 10, 20}, {30, 40, 50}, {60, 70, 80}, {90, 100, 110}, {200, 1, 2}};
static const png_byte palette_alpha[2] = {0, 77};

static Bytes png_make(int type, int depth, int channels, int interlaced, int transparent) {
    Bytes bytes = {.size = 0};
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    assert_non_null(png);
    png_infop info = png_create_info_struct(png);
    assert_non_null(info);
    png_set_write_fn(png, &bytes, append, flush);
    png_set_IHDR(png, info, WIDTH, HEIGHT, depth, type, interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    if (type == PNG_COLOR_TYPE_PALETTE) png_set_PLTE(png, info, palette, depth < 4 ? 1 << depth : 16);
    png_color_16 key = {.gray = (png_uint_16)sample(2, 3, 0, depth),
                        .red = (png_uint_16)sample(2, 3, 0, depth),
                        .green = (png_uint_16)sample(2, 3, 1, depth),
                        .blue = (png_uint_16)sample(2, 3, 2, depth)};
    if (transparent) png_set_tRNS(png, info, palette_alpha, 2, &key);
    png_write_info(png, info);
    png_byte rows[HEIGHT][WIDTH * 8];
    png_bytep pointers[HEIGHT];
    memset(rows, 0, sizeof rows);
    for (int y = 0; y < HEIGHT; y++) {
        pointers[y] = rows[y];
        for (int i = 0; i < WIDTH * channels; i++) {
            const unsigned value =
                sample(i / channels, y, i % channels, depth) & (type == PNG_COLOR_TYPE_PALETTE ? 15u : 0xffffu);
            if (depth == 16) rows[y][2 * i] = (png_byte)(value >> 8);
            if (depth == 16) rows[y][2 * i + 1] = (png_byte)value;
            if (depth == 8) rows[y][i] = (png_byte)value;
            if (depth < 8) rows[y][i * depth / 8] |= (png_byte)(value << (8 - depth - i * depth % 8));
        }
    }
    png_write_image(png, pointers);
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
    return bytes;
}

/* What channel c of the image must hold. */
static unsigned expected(int type, int depth, int x, int y, int c, int channels, int transparent) {
    if (type == PNG_COLOR_TYPE_PALETTE) {
        const unsigned index = sample(x, y, 0, depth) & 15;
        const png_color color = palette[index];
        return c == 0 ? color.red : c == 1 ? color.green : c == 2 ? color.blue : index < 2 ? palette_alpha[index] : 255;
    }
    const unsigned most = depth == 16 ? 65535 : 255;
    if (transparent && c == channels - 1) {
        for (int k = 0; k < channels - 1; k++)
            if (sample(x, y, k, depth) != sample(2, 3, k, depth)) return most;
        return 0;
    }
    return sample(x, y, c, depth) * (depth < 8 ? 255 / ((1u << depth) - 1) : 1);
}

static void png_of_every_type_and_depth_is_read(void **state) {
    (void)state;
    static const struct {
        int type, depth, channels;
    } forms[] = {
        {PNG_COLOR_TYPE_GRAY, 1, 1},        {PNG_COLOR_TYPE_GRAY, 2, 1},      {PNG_COLOR_TYPE_GRAY, 4, 1},
        {PNG_COLOR_TYPE_GRAY, 8, 1},        {PNG_COLOR_TYPE_GRAY, 16, 1},     {PNG_COLOR_TYPE_RGB, 8, 3},
        {PNG_COLOR_TYPE_RGB, 16, 3},        {PNG_COLOR_TYPE_PALETTE, 1, 1},   {PNG_COLOR_TYPE_PALETTE, 2, 1},
        {PNG_COLOR_TYPE_PALETTE, 4, 1},     {PNG_COLOR_TYPE_PALETTE, 8, 1},   {PNG_COLOR_TYPE_GRAY_ALPHA, 8, 2},
        {PNG_COLOR_TYPE_GRAY_ALPHA, 16, 2}, {PNG_COLOR_TYPE_RGB_ALPHA, 8, 4}, {PNG_COLOR_TYPE_RGB_ALPHA, 16, 4}};
    for (size_t i = 0; i < sizeof forms / sizeof *forms; i++)
        for (int variant = 0; variant < 4; variant++) {
            const int type = forms[i].type, depth = forms[i].depth, interlaced = variant & 1;
            const int transparent = (variant & 2) != 0 && !(type & PNG_COLOR_MASK_ALPHA);
            Bytes bytes = png_make(type, depth, forms[i].channels, interlaced, transparent);
            WeftImage image = read_bytes(&bytes);
            const int channels = (type == PNG_COLOR_TYPE_PALETTE ? 3 : forms[i].channels) + (transparent ? 1 : 0);
            assert_shape(&image, WIDTH, HEIGHT, channels, depth == 16 ? WEFT_PIXEL_U16 : WEFT_PIXEL_U8);
            for (int n = 0; n < WIDTH * HEIGHT * channels; n++) {
                const unsigned got = depth == 16 ? ((uint16_t *)image.pixels)[n] : ((uint8_t *)image.pixels)[n];
                const int p = n / channels;
                assert_int_equal(got, expected(type, depth, p % WIDTH, p / WIDTH, n % channels, channels, transparent));
            }
            weft_image_free(&image);
        }
}

static void damaged_png_is_refused(void **state) {
    (void)state;
    Bytes bytes = png_make(PNG_COLOR_TYPE_RGB, 8, 3, 0, 0);
    refuse_prefixes(&bytes);
    /* Every byte after the signature is covered by a check sum or is one; a length may make it look cut. */
    for (size_t i = 8; i < bytes.size; i++) {
        Bytes damaged = bytes;
        damaged.data[i] ^= 0x10;
        WeftImage image;
        WeftError error = {0};
        assert_int_equal(weft_image_read_memory(damaged.data, damaged.size, "bytes", &image, NULL, &error), WEFT_INPUT);
        assert_null(strchr(error.text, '\n'));
    }
}

/* A header that claims much with nothing behind it. */
static void png_that_claims_too_many_pixels_is_refused(void **state) {
    (void)state;
    Bytes bytes = png_make(PNG_COLOR_TYPE_GRAY, 8, 1, 0, 0);
    assert_true(bytes.size < 4096);
    static const unsigned char giant[] = {0, 0, 0x4e, 0x20, 0, 0, 0x4e, 0x20};
    memcpy(bytes.data + 16, giant, sizeof giant);
    /* CRC-32 of the changed header, the polynomial of PNG */
    uint32_t crc = 0xffffffffu;
    for (size_t i = 12; i < 29; i++) {
        crc ^= bytes.data[i];
        for (int k = 0; k < 8; k++) crc = crc & 1 ? crc >> 1 ^ 0xedb88320u : crc >> 1;
    }
    crc = ~crc;
    for (int i = 0; i < 4; i++) bytes.data[29 + i] = (unsigned char)(crc >> (24 - 8 * i));
    refuse(&bytes, WEFT_MESSAGE_IMAGE_SIZE);
}

static void png_reads_what_it_wrote(void **state) {
    (void)state;
    for (int channels = 1; channels <= 4; channels++)
        for (int deep = 0; deep < 2; deep++) {
            WeftImage image = make_image(37, 21, channels, deep ? WEFT_PIXEL_U16 : WEFT_PIXEL_U8);
            const size_t size = value_total(&image) * (deep ? 2 : 1);
            for (size_t i = 0; i < size; i++) ((unsigned char *)image.pixels)[i] = (unsigned char)(i * 31 >> 2);
            WeftImage back = write_and_read(&image, ".png");
            assert_shape(&back, 37, 21, channels, image.type);
            assert_memory_equal(back.pixels, image.pixels, size);
            weft_image_free(&back);
            weft_image_free(&image);
        }
}

static void count_denoised(void *user, WeftMessage message, const char *text) {
    assert_int_equal(message, WEFT_MESSAGE_IMAGE_DENOISED);
    assert_non_null(strstr(text, "image.png"));
    ++*(int *)user;
}

/* A denoised picture says so, and the reader does; another text is none of its business. */
static void denoised_png_warns_its_reader(void **state) {
    (void)state;
    static const char *const said[] = {NULL, "regression", ""};
    char folder[SCRATCH_SIZE], path[300];
    assert_true(scratch_make(folder));
    snprintf(path, sizeof path, "%s/image.png", folder);
    WeftImage image = make_image(8, 8, 3, WEFT_PIXEL_U8), back;
    for (int k = 0; k < 3; k++) {
        int warnings = 0;
        const WeftLog log = {count_denoised, &warnings};
        const WeftImageWriting how = {.comment = "Denoised", .denoised = said[k]};
        assert_int_equal(weft_image_write_as(path, &image, &how, NULL), WEFT_OK);
        assert_int_equal(weft_image_read(path, &back, &log, NULL), WEFT_OK);
        assert_int_equal(warnings, k > 0);
        weft_image_free(&back);
    }
    weft_image_free(&image);
    assert_int_equal(unlink(path), 0);
    assert_int_equal(rmdir(folder), 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(png_of_every_type_and_depth_is_read),
        cmocka_unit_test(damaged_png_is_refused),
        cmocka_unit_test(png_that_claims_too_many_pixels_is_refused),
        cmocka_unit_test(png_reads_what_it_wrote),
        cmocka_unit_test(denoised_png_warns_its_reader),
    };
    return cmocka_run_group_tests_name("png", tests, NULL, NULL);
}
