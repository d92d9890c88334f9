/* TGA files byte by byte: every type, depth, map and origin, packets, and headers that lie. */
#include "image/fixture.h"

enum { WIDTH = 3, HEIGHT = 2 };

typedef struct Header {
    int map_type, type, map_first, map_length, map_bits, width, height, bits, descriptor;
} Header;

static Bytes header(Header h) {
    Bytes bytes = {.size = 0};
    put_byte(&bytes, 3); /* an identification to be skipped */
    put_byte(&bytes, h.map_type);
    put_byte(&bytes, h.type);
    put_word(&bytes, h.map_first);
    put_word(&bytes, h.map_length);
    put_byte(&bytes, h.map_bits);
    put_word(&bytes, 11); /* where on a screen: without meaning here */
    put_word(&bytes, 22);
    put_word(&bytes, h.width);
    put_word(&bytes, h.height);
    put_byte(&bytes, h.bits);
    put_byte(&bytes, h.descriptor);
    put_text(&bytes, "id.");
    return bytes;
}

/* The colour of pixel n of the file: components that 5 bits hold exactly too. */
static void color_of(int n, unsigned char rgba[4]) {
    static const unsigned char levels[] = {0, 255, 132, 66};
    for (int c = 0; c < 3; c++) rgba[c] = levels[(n + c) % 4];
    rgba[3] = n % 2 ? 255 : 0;
}

static void put_color(Bytes *bytes, int bits, int n) {
    unsigned char rgba[4];
    color_of(n, rgba);
    if (bits == 15 || bits == 16)
        put_word(bytes, (rgba[3] ? 0x8000 : 0) | rgba[0] >> 3 << 10 | rgba[1] >> 3 << 5 | rgba[2] >> 3);
    else
        put(bytes, (unsigned char[]){rgba[2], rgba[1], rgba[0], rgba[3]}, bits == 32 ? 4 : 3);
}

/* Pixel n of the file is pixel `place` of the image, rows from the top. */
static int place_of(int n, int descriptor) {
    int x = n % WIDTH, y = n / WIDTH;
    if (descriptor & 0x10) x = WIDTH - 1 - x;
    if (!(descriptor & 0x20)) y = HEIGHT - 1 - y;
    return y * WIDTH + x;
}

static void assert_colors(const WeftImage *image, int descriptor) {
    for (int n = 0; n < WIDTH * HEIGHT; n++) {
        unsigned char rgba[4];
        color_of(n, rgba);
        const unsigned char *pixel = (const unsigned char *)image->pixels + place_of(n, descriptor) * image->channels;
        assert_memory_equal(pixel, rgba, (size_t)image->channels);
    }
}

/* Types 2 and 10, with and without attribute bits, from all four corners. */
static void tga_of_true_colour_is_read(void **state) {
    (void)state;
    static const int depths[] = {15, 16, 24, 32};
    for (int i = 0; i < 4 * 2 * 2 * 4; i++) {
        const int bits = depths[i % 4], packed = i / 4 % 2, attributes = i / 8 % 2 ? (bits == 32 ? 8 : 1) : 0;
        const int descriptor = attributes | (i / 16) << 4;
        Bytes bytes = header((Header){
            .type = packed ? 10 : 2, .width = WIDTH, .height = HEIGHT, .bits = bits, .descriptor = descriptor});
        for (int n = 0; n < WIDTH * HEIGHT; n++) {
            if (packed && n == 0) put_byte(&bytes, 3);    /* a dump over the end of a line */
            if (packed && n >= 4) put_byte(&bytes, 0x80); /* runs of one */
            put_color(&bytes, bits, n);
        }
        refuse_prefixes(&bytes);
        WeftImage image = read_bytes(&bytes);
        assert_shape(&image, WIDTH, HEIGHT, attributes && bits != 15 && bits != 24 ? 4 : 3, WEFT_PIXEL_U8);
        assert_colors(&image, descriptor);
        weft_image_free(&image);
    }
}

/* Types 1 and 9: indices of 8 and 16 bits into maps of every depth that do not start at 0. */
static void tga_with_a_colour_map_is_read(void **state) {
    (void)state;
    static const int depths[] = {15, 16, 24, 32};
    for (int i = 0; i < 4 * 2 * 2; i++) {
        const int map_bits = depths[i % 4], packed = i / 4 % 2, bits = i / 8 ? 16 : 8, first = 2;
        Header h = {.map_type = 1,
                    .type = packed ? 9 : 1,
                    .map_first = first,
                    .map_length = WIDTH * HEIGHT,
                    .map_bits = map_bits,
                    .width = WIDTH,
                    .height = HEIGHT,
                    .bits = bits,
                    .descriptor = 0x28};
        Bytes bytes = header(h);
        for (int n = 0; n < WIDTH * HEIGHT; n++) put_color(&bytes, map_bits, n);
        if (packed) put_byte(&bytes, WIDTH * HEIGHT - 1);
        for (int n = 0; n < WIDTH * HEIGHT; n++) {
            put_byte(&bytes, n + first);
            if (bits == 16) put_byte(&bytes, 0);
        }
        refuse_prefixes(&bytes);
        WeftImage image = read_bytes(&bytes);
        assert_shape(&image, WIDTH, HEIGHT, map_bits == 16 || map_bits == 32 ? 4 : 3, WEFT_PIXEL_U8);
        assert_colors(&image, h.descriptor);
        weft_image_free(&image);

        bytes.data[bytes.size - (bits == 16 ? 2 : 1)] = (unsigned char)(first + WIDTH * HEIGHT); /* one past the map */
        refuse(&bytes, WEFT_MESSAGE_IMAGE_DAMAGED);
        bytes.data[bytes.size - (bits == 16 ? 2 : 1)] = (unsigned char)(first - 1); /* one before it */
        refuse(&bytes, WEFT_MESSAGE_IMAGE_DAMAGED);
    }
}

/* Types 3 and 11. */
static void tga_of_grey_is_read(void **state) {
    (void)state;
    for (int i = 0; i < 4; i++) {
        const int packed = i % 2, bits = i / 2 ? 16 : 8, step = bits / 8;
        const size_t length = (size_t)step + 1;
        Bytes bytes = header(
            (Header){.type = packed ? 11 : 3, .width = WIDTH, .height = HEIGHT, .bits = bits, .descriptor = 0x20});
        if (packed) {
            put(&bytes, (unsigned char[]){0x84, 9, 200}, length); /* five */
            put(&bytes, (unsigned char[]){0x00, 8, 100}, length); /* one */
        } else {
            for (int n = 0; n < 5; n++) put(&bytes, (unsigned char[]){9, 200}, (size_t)step);
            put(&bytes, (unsigned char[]){8, 100}, (size_t)step);
        }
        refuse_prefixes(&bytes);
        WeftImage image = read_bytes(&bytes);
        assert_shape(&image, WIDTH, HEIGHT, step, WEFT_PIXEL_U8);
        const unsigned char *pixels = image.pixels;
        for (int n = 0; n < 6; n++) {
            assert_int_equal(pixels[n * step], n < 5 ? 9 : 8);
            if (step == 2) assert_int_equal(pixels[n * step + 1], n < 5 ? 200 : 100);
        }
        weft_image_free(&image);
    }
}

static void tga_with_a_lying_header_is_refused(void **state) {
    (void)state;
    const Header good = {.type = 3, .width = WIDTH, .height = HEIGHT, .bits = 8, .descriptor = 0x20};
    Header h = good;
    h.type = 4;
    Bytes bytes = header(h);
    put(&bytes, "......", 6);
    refuse(&bytes, WEFT_MESSAGE_IMAGE_FORMAT);
    h = good;
    h.bits = 7;
    bytes = header(h);
    put(&bytes, "......", 6);
    refuse(&bytes, WEFT_MESSAGE_IMAGE_FORMAT);
    h = good;
    h.descriptor |= 0x40;
    bytes = header(h);
    put(&bytes, "......", 6);
    refuse(&bytes, WEFT_MESSAGE_IMAGE_UNSUPPORTED);
    h = good;
    h.width = 0;
    bytes = header(h);
    refuse(&bytes, WEFT_MESSAGE_IMAGE_SIZE);
    h = good;
    h.width = h.height = 65535;
    bytes = header(h);
    refuse(&bytes, WEFT_MESSAGE_IMAGE_SIZE);
    h.type = 11;
    bytes = header(h);
    for (int i = 0; i < 100; i++) put(&bytes, "\xff.", 2);
    refuse(&bytes, WEFT_MESSAGE_IMAGE_SIZE);
    h = good;
    h.type = 11;
    bytes = header(h);
    put(&bytes, "\x86.", 2); /* seven pixels where there are six */
    refuse(&bytes, WEFT_MESSAGE_IMAGE_DAMAGED);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tga_of_true_colour_is_read),
        cmocka_unit_test(tga_with_a_colour_map_is_read),
        cmocka_unit_test(tga_of_grey_is_read),
        cmocka_unit_test(tga_with_a_lying_header_is_refused),
    };
    return cmocka_run_group_tests_name("tga", tests, NULL, NULL);
}
