/* TIFF files put together here: numbers of every type, little and big endian, one plane or several, alpha, palettes,
 * damage. */
#include "image/fixture.h"

#include <stdbool.h>

/* A file of one strip, 2 x 2 pixels, whose sample k is (k + 1) / 16 of the largest. */
typedef struct Form {
    bool big, planes, floats;
    int samples, bits, photometric;
    int extra; /* type of the last sample, -1: a colour */
} Form;

static void put_number(Bytes *bytes, bool big, uint32_t number, int size) {
    for (int k = 0; k < size; k++) put_byte(bytes, (int)(number >> 8 * (big ? size - 1 - k : k) & 255u));
}

static void put_entry(Bytes *bytes, bool big, int tag, int type, uint32_t count, uint32_t value) {
    put_number(bytes, big, (uint32_t)tag, 2);
    put_number(bytes, big, (uint32_t)type, 2);
    put_number(bytes, big, count, 4);
    put_number(bytes, big, value, type == 3 && count == 1 ? 2 : 4);
    if (type == 3 && count == 1) put_number(bytes, big, 0, 2);
}

static float value(int k) { return (float)(k + 1) / 16.0f; }

static void put_sample(Bytes *bytes, const Form *form, int k) {
    const float v = value(k);
    uint32_t word;
    memcpy(&word, &v, sizeof word);
    if (form->bits == 8)
        put_byte(bytes, (int)(v * 255.0f + 0.5f));
    else if (form->bits == 16)
        put_number(bytes, form->big, (uint32_t)(v * 65535.0f + 0.5f), 2);
    else
        put_number(bytes, form->big, word, 4);
}

static Bytes tiff_of(const Form *form) {
    Bytes bytes = {.size = 0};
    const uint32_t plane = (uint32_t)(4 * form->bits / 8), data = 8 + 2 + 12 * 10 + 4,
                   lists = data + plane * (uint32_t)form->samples;
    const int parts = form->planes ? form->samples : 1;
    put_text(&bytes, form->big ? "MM" : "II");
    put_number(&bytes, form->big, 42, 2);
    put_number(&bytes, form->big, 8, 4);
    put_number(&bytes, form->big, 10, 2);
    put_entry(&bytes, form->big, 256, 3, 1, 2);
    put_entry(&bytes, form->big, 257, 3, 1, 2);
    put_entry(&bytes, form->big, 258, 3, 1, (uint32_t)form->bits); /* of every sample */
    put_entry(&bytes, form->big, 259, 3, 1, 1);
    put_entry(&bytes, form->big, 262, 3, 1, (uint32_t)form->photometric);
    put_entry(&bytes, form->big, 273, 4, (uint32_t)parts, parts > 1 ? lists : data);
    put_entry(&bytes, form->big, 277, 3, 1, (uint32_t)form->samples);
    put_entry(&bytes, form->big, 279, 4, (uint32_t)parts,
              parts > 1 ? lists + 4 * (uint32_t)parts : plane * (uint32_t)form->samples);
    if (form->extra >= 0)
        put_entry(&bytes, form->big, 338, 3, 1, (uint32_t)form->extra);
    else
        put_entry(&bytes, form->big, 284, 3, 1, form->planes ? 2 : 1);
    put_entry(&bytes, form->big, 339, 3, 1, form->floats ? 3 : 1);
    put_number(&bytes, form->big, 0, 4);
    for (int k = 0; k < 4 * form->samples; k++)
        put_sample(&bytes, form, form->planes ? k % 4 * form->samples + k / 4 : k);
    for (int k = 0; k < parts && parts > 1; k++) put_number(&bytes, form->big, data + plane * (uint32_t)k, 4);
    for (int k = 0; k < parts && parts > 1; k++) put_number(&bytes, form->big, plane, 4);
    return bytes;
}

static float number_at(const WeftImage *image, int k) {
    return image->type == WEFT_PIXEL_U8    ? (float)((const unsigned char *)image->pixels)[k] / 255.0f
           : image->type == WEFT_PIXEL_U16 ? (float)((const uint16_t *)image->pixels)[k] / 65535.0f
                                           : ((const float *)image->pixels)[k];
}

static bool has_libtiff(void) {
    WeftImage image;
    WeftError error = {0};
    weft_image_read_memory("II*\0", 4, "bytes", &image, NULL, &error);
    return error.message != WEFT_MESSAGE_IMAGE_FORMAT;
}

static void tiff_of_every_type_is_read(void **state) {
    (void)state;
    static const Form forms[] = {
        {false, false, false, 1, 8, 1, -1}, {true, false, false, 3, 8, 2, -1},  {false, false, false, 3, 16, 2, -1},
        {true, false, false, 1, 16, 1, -1}, {false, false, true, 3, 32, 2, -1}, {true, false, true, 1, 32, 1, -1},
        {false, true, false, 3, 8, 2, -1},  {true, true, true, 3, 32, 2, -1},   {false, false, false, 4, 8, 2, 2},
        {true, false, false, 4, 16, 2, 2},  {false, false, false, 1, 8, 0, -1},
    };
    if (!has_libtiff()) skip();
    for (size_t f = 0; f < sizeof forms / sizeof *forms; f++) {
        const Form *form = &forms[f];
        Bytes bytes = tiff_of(form);
        WeftImage image = read_bytes(&bytes);
        assert_shape(&image, 2, 2, form->samples,
                     form->floats      ? WEFT_PIXEL_F32
                     : form->bits == 8 ? WEFT_PIXEL_U8
                                       : WEFT_PIXEL_U16);
        for (int k = 0; k < 4 * form->samples; k++)
            assert_near(number_at(&image, k), form->photometric == 0 ? 1.0f - value(k) : value(k), 3e-3f);
        weft_image_free(&image);
        bytes.size = 8 + 2 + 12 * 10 + 4 + 1;
        refuse(&bytes, WEFT_MESSAGE_IMAGE_DAMAGED);
    }
}

/* Colours that are multiplied by alpha come back; channels without a meaning are left, with a word. */
static void extra_samples_of_a_tiff_are_understood(void **state) {
    (void)state;
    if (!has_libtiff()) skip();
    Bytes bytes = tiff_of(&(Form){false, false, true, 4, 32, 2, 1});
    WeftImage image = read_bytes(&bytes);
    for (int n = 0; n < 4; n++)
        for (int c = 0; c < 3; c++)
            assert_near(number_at(&image, 4 * n + c), value(4 * n + c) / value(4 * n + 3), 1e-5f);
    weft_image_free(&image);
    bytes = tiff_of(&(Form){false, false, false, 4, 8, 2, 0});
    image = read_bytes_said(&bytes, "it shows 3 of its 4 channels");
    assert_shape(&image, 2, 2, 3, WEFT_PIXEL_U8);
    assert_near(number_at(&image, 3), value(4), 3e-3f);
    weft_image_free(&image);
}

static void damaged_tiff_is_refused_or_read(void **state) {
    (void)state;
    Bytes bytes = tiff_of(&(Form){false, false, false, 3, 16, 2, -1});
    for (size_t at = 0; at < bytes.size; at++)
        for (int bit = 0; bit < 8; bit++) {
            Bytes wrong = bytes;
            WeftImage image;
            WeftError error = {0};
            wrong.data[at] ^= (unsigned char)(1 << bit);
            const WeftResult result = weft_image_read_memory(wrong.data, wrong.size, "bytes", &image, NULL, &error);
            if (result != WEFT_OK && (!error.text[0] || strchr(error.text, '\n'))) fail_msg("%s", error.text);
            weft_image_free(&image);
        }
    refuse_prefixes(&bytes);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tiff_of_every_type_is_read),
        cmocka_unit_test(extra_samples_of_a_tiff_are_understood),
        cmocka_unit_test(damaged_tiff_is_refused_or_read),
    };
    return cmocka_run_group_tests_name("tiff", tests, NULL, NULL);
}
