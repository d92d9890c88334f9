/* DDS files put together here: each format of both headers, more pictures than one, blocks, damage. */
#include "image/texel_numbers.h"

static void put_long(Bytes *bytes, uint32_t word) {
    put_word(bytes, (int)(word & 0xffff));
    put_word(bytes, (int)(word >> 16));
}

/* The headers of a file of 2 x 1 texels: of a DXGI format, or else the first header's flags, code, bits and masks. */
static Bytes headers(uint32_t dxgi, const uint32_t first[7], uint32_t caps, uint32_t pictures) {
    Bytes bytes = {.size = 0};
    uint32_t words[32] = {[1] = 124, [2] = 0x1007, [3] = 1, [4] = 2, [19] = 32, [27] = 0x1000, [28] = caps};
    if (dxgi) {
        words[20] = 4;
        memcpy(&words[21], "DX10", 4);
    } else {
        memcpy(&words[20], first, 7 * sizeof *first);
    }
    memcpy(&words[0], "DDS ", 4);
    for (int k = 0; k < 32; k++) put_long(&bytes, words[k]);
    if (!dxgi) return bytes;
    const uint32_t more[5] = {dxgi, 3, 0, pictures, 0};
    for (int k = 0; k < 5; k++) put_long(&bytes, more[k]);
    return bytes;
}

static void dds_of_every_format_is_read(void **state) {
    (void)state;
    static const struct {
        uint32_t dxgi, code; /* code: in place of a FourCC */
        int channels, size;
        bool floats, reversed;
    } formats[] = {
        {2, 116, 4, 4, true, false},  {6, 0, 3, 4, true, false},    {16, 115, 2, 4, true, false},
        {41, 114, 1, 4, true, false}, {10, 113, 4, 2, true, false}, {34, 112, 2, 2, true, false},
        {54, 111, 1, 2, true, false}, {11, 36, 4, 2, false, false}, {35, 0, 2, 2, false, false},
        {56, 0, 1, 2, false, false},  {28, 0, 4, 1, false, false},  {49, 0, 2, 1, false, false},
        {61, 0, 1, 1, false, false},  {87, 0, 4, 1, false, true},
    };
    for (size_t f = 0; f < sizeof formats / sizeof *formats; f++)
        for (int legacy = 0; legacy < 2; legacy++) {
            if (legacy && !formats[f].code) continue;
            const uint32_t first[7] = {4, formats[f].code};
            Bytes bytes = headers(legacy ? 0 : formats[f].dxgi, first, 0, 1);
            put_numbers(&bytes, formats[f].size, formats[f].floats, 2 * formats[f].channels);
            WeftImage image = read_bytes(&bytes);
            const int stored = formats[f].channels, shown = stored == 2 ? 3 : stored; /* blue 0 beside red and green */
            assert_shape(&image, 2, 1, shown,
                         formats[f].floats      ? WEFT_PIXEL_F32
                         : formats[f].size == 2 ? WEFT_PIXEL_U16
                                                : WEFT_PIXEL_U8);
            for (int k = 0; k < 2 * formats[f].channels; k++) {
                const int from = formats[f].reversed && k % 4 < 3 ? k / 4 * 4 + 2 - k % 4 : k;
                assert_near((float)value_at(&image, k / stored * shown + k % stored), (float)(from + 1) / 16.0f, 4e-3f);
                if (shown > stored) assert_near((float)value_at(&image, k / stored * shown + 2), 0.0f, 0.0f);
            }
            weft_image_free(&image);
            bytes.size--;
            refuse(&bytes, WEFT_MESSAGE_IMAGE_SIZE);
        }
}

static void dds_of_masks_is_read(void **state) {
    (void)state;
    Bytes bytes = headers(0, (uint32_t[7]){0x41, 0, 32, 0xff0000, 0xff00, 0xff, 0xff000000}, 0, 1);
    put(&bytes, (unsigned char[]){3, 2, 1, 4, 7, 6, 5, 8}, 8);
    WeftImage image = read_bytes(&bytes);
    assert_shape(&image, 2, 1, 4, WEFT_PIXEL_U8);
    for (int k = 0; k < 8; k++) assert_int_equal(((unsigned char *)image.pixels)[k], k + 1);
    weft_image_free(&image);
    bytes = headers(0, (uint32_t[7]){0x20000, 0, 16, 0xffff}, 0, 1);
    put_numbers(&bytes, 2, false, 2);
    image = read_bytes(&bytes);
    assert_shape(&image, 2, 1, 1, WEFT_PIXEL_U16);
    weft_image_free(&image);
}

static void dds_of_more_pictures_says_so(void **state) {
    (void)state;
    Bytes bytes = headers(41, NULL, 0x200, 1);
    put_numbers(&bytes, 4, true, 2);
    WeftImage image = read_bytes_said(&bytes, "it shows the first face of its cube");
    weft_image_free(&image);
    bytes = headers(41, NULL, 0, 7);
    put_numbers(&bytes, 4, true, 2);
    image = read_bytes_said(&bytes, "it shows the first picture of its array");
    weft_image_free(&image);
}

static void dds_of_blocks_is_refused_by_name(void **state) {
    (void)state;
    uint32_t code;
    memcpy(&code, "DXT5", 4);
    const struct {
        uint32_t dxgi, first[7];
        const char *said;
    } cases[] = {{0, {4, code}, "pixels of format DXT5; convert it to"},
                 {98, {0}, "pixels of DXGI format 98"},
                 {0, {0x41, 0, 16, 0xf800}, "pixels of 16 bits"}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        Bytes bytes = headers(cases[k].dxgi, cases[k].first, 0, 1);
        WeftImage image;
        WeftError error = {0};
        put_numbers(&bytes, 4, true, 8);
        refuse(&bytes, WEFT_MESSAGE_IMAGE_UNSUPPORTED);
        assert_int_equal(weft_image_read_memory(bytes.data, bytes.size, "bytes", &image, NULL, &error), WEFT_INPUT);
        if (!strstr(error.text, cases[k].said)) fail_msg("%s", error.text);
    }
    Bytes bytes = headers(41, NULL, 0, 1);
    put_numbers(&bytes, 4, true, 2);
    refuse_prefixes(&bytes);
    memset(bytes.data + 12, 0xff, 4); /* the height */
    refuse(&bytes, WEFT_MESSAGE_IMAGE_SIZE);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(dds_of_every_format_is_read),
        cmocka_unit_test(dds_of_masks_is_read),
        cmocka_unit_test(dds_of_more_pictures_says_so),
        cmocka_unit_test(dds_of_blocks_is_refused_by_name),
    };
    return cmocka_run_group_tests_name("dds", tests, NULL, NULL);
}
