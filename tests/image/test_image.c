/* Images in memory, suffixes, conversion, the difference, and files that appear complete or not at all. */
#include "image/fixture.h"

#include <dirent.h>
#include <math.h>
#include <sys/stat.h>

#include "image/codec.h"
#include "image/srgb.h"
#define WEFT_LIBM /* as tonemap.c has it */
#include "shading/dialect/tone.h"

static void new_image_is_black_and_freed(void **state) {
    (void)state;
    WeftImage image = make_image(3, 2, 4, WEFT_PIXEL_U16);
    assert_shape(&image, 3, 2, 4, WEFT_PIXEL_U16);
    for (size_t i = 0; i < value_total(&image); i++) assert_int_equal(((uint16_t *)image.pixels)[i], 0);
    weft_image_free(&image);
    assert_null(image.pixels);
    assert_int_equal(image.width, 0);
    weft_image_free(&image);
    weft_image_free(NULL);

    static const int wrong[][4] = {{0, 1, 1, 0}, {1, 0, 1, 0}, {65537, 1, 1, 0}, {1, 1, 0, 0},
                                   {1, 1, 5, 0}, {1, 1, 1, 3}, {1, -1, 1, 0},    {1, 1, 1, -1}};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        WeftError error = {0};
        assert_int_equal(
            weft_image_create(wrong[i][0], wrong[i][1], wrong[i][2], (WeftPixelType)wrong[i][3], &image, &error),
            WEFT_USAGE);
        assert_int_equal(error.message, WEFT_MESSAGE_DESC);
        assert_null(image.pixels);
    }
}

static void suffixes_choose_the_format(void **state) {
    (void)state;
    static const struct {
        const char *path;
        int known, linear;
    } cases[] = {{"a.png", 1, 0}, {"a.PNG", 1, 0},     {"a/b.c/d.exr", 1, 1}, {"x.hdr", 1, 1},
                 {"x.jpg", 0, 0}, {"x.png.txt", 0, 0}, {"png", 0, 0},         {".png", 0, 0},
                 {"", 0, 0},      {"xhdr", 0, 0},      {"x.Npy", 1, 1}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        assert_int_equal(weft_image_suffix_known(cases[i].path), cases[i].known);
        assert_int_equal(weft_image_suffix_linear(cases[i].path), cases[i].linear);
    }
}

static void unknown_content_is_refused(void **state) {
    (void)state;
    refuse_bytes("", 0, WEFT_MESSAGE_IMAGE_FORMAT);
    refuse_bytes("hello, this is a text and not an image", 38, WEFT_MESSAGE_IMAGE_FORMAT);
    refuse_bytes("\x89PNG", 4, WEFT_MESSAGE_IMAGE_DAMAGED);
    refuse_bytes("\xff\xd8\xff", 3, WEFT_MESSAGE_IMAGE_DAMAGED);
    refuse_bytes("#?", 2, WEFT_MESSAGE_IMAGE_DAMAGED);
    refuse_bytes("\x76\x2f\x31\x01", 4, WEFT_MESSAGE_IMAGE_DAMAGED);
    refuse_bytes("\x93NUMPY", 6, WEFT_MESSAGE_IMAGE_DAMAGED);
    WeftImage image;
    WeftError error = {0};
    assert_int_equal(weft_image_read("/nowhere/at all.png", &image, NULL, &error), WEFT_INPUT);
    assert_int_equal(error.message, WEFT_MESSAGE_FILE_OPEN);
    assert_int_equal(weft_image_read("/", &image, NULL, &error), WEFT_INPUT);
    assert_int_equal(error.message, WEFT_MESSAGE_FILE_READ);
}

static void header_that_claims_more_than_the_file_can_hold_is_refused(void **state) {
    (void)state;
    const ImageSource small = {.size = 1000, .name = "small"}, large = {.size = 100 << 20, .name = "large"};
    WeftError error = {0};
    assert_int_equal(image_check_header(&small, 8192, 8192, 4, &error), WEFT_OK);
    assert_int_equal(image_check_header(&small, 16384, 16384, 4, &error), WEFT_INPUT);
    assert_int_equal(error.message, WEFT_MESSAGE_IMAGE_SIZE);
    assert_int_equal(image_check_header(&large, 16384, 16384, 4, &error), WEFT_OK);
    assert_int_equal(image_check_header(&large, 65536, 65536, 1, &error), WEFT_INPUT);
    assert_int_equal(image_check_header(&small, 65537, 1, 1, &error), WEFT_INPUT);
    assert_int_equal(image_check_header(&small, 1, 0, 1, &error), WEFT_INPUT);
    assert_int_equal(image_reachable(&small, 1000, &error), WEFT_OK);
    assert_int_equal(image_reachable(&small, 1001, &error), WEFT_INPUT);
}

static void converted_pixels_have_the_values_of_the_original(void **state) {
    (void)state;
    for (int channels = 1; channels <= 4; channels++)
        for (int deep = 0; deep < 2; deep++)
            for (int srgb = 0; srgb < 2; srgb++) {
                WeftImage in = make_image(2, 3, channels, deep ? WEFT_PIXEL_U16 : WEFT_PIXEL_U8), out;
                const size_t count = value_total(&in);
                for (size_t i = 0; i < count; i++) {
                    if (deep)
                        ((uint16_t *)in.pixels)[i] = (uint16_t)(i * 2730);
                    else
                        ((unsigned char *)in.pixels)[i] = (unsigned char)(i * 10);
                }
                assert_int_equal(weft_image_convert_f32(&in, srgb, &out, NULL), WEFT_OK);
                assert_shape(&out, 2, 3, channels, WEFT_PIXEL_F32);
                for (size_t i = 0; i < count; i++) {
                    const float plain = deep ? (float)(i * 2730) / 65535.0f : (float)(i * 10) / 255.0f;
                    const int alpha = channels % 2 == 0 && (int)i % channels == channels - 1;
                    const float want = srgb && !alpha ? srgb_decode(plain) : plain;
                    assert_near(((float *)out.pixels)[i], want, 0.0f);
                }
                WeftImage same;
                assert_int_equal(weft_image_convert_f32(&out, 1, &same, NULL), WEFT_OK);
                assert_memory_equal(same.pixels, out.pixels, count * sizeof(float));
                weft_image_free(&same);
                weft_image_free(&out);
                weft_image_free(&in);
            }
}

static void srgb_decodes_what_it_encodes(void **state) {
    (void)state;
    assert_near(tone_encode(0.0f), 0.0f, 0.0f);
    assert_near(tone_encode(1.0f), 1.0f, 1e-6f);
    assert_near(srgb_decode(0.5f), 0.21404114f, 1e-6f); /* IEC 61966-2-1 */
    for (int i = 0; i <= 1000; i++)
        assert_near(srgb_decode(tone_encode((float)i / 1000.0f)), (float)i / 1000.0f, 1e-6f);
}

static void pixels_that_a_format_cannot_hold_are_refused(void **state) {
    (void)state;
    WeftImage floats = make_image(2, 2, 3, WEFT_PIXEL_F32), bytes = make_image(2, 2, 3, WEFT_PIXEL_U8);
    WeftImage grey = make_image(2, 2, 1, WEFT_PIXEL_F32), none = {0};
    const struct {
        const WeftImage *image;
        const char *suffix;
        WeftMessage message;
    } cases[] = {{&floats, ".jpg", WEFT_MESSAGE_OUTPUT_SUFFIX},
                 {&floats, ".png", WEFT_MESSAGE_DESC},
                 {&bytes, ".exr", WEFT_MESSAGE_DESC},
                 {&bytes, ".hdr", WEFT_MESSAGE_DESC},
                 {&grey, ".hdr", WEFT_MESSAGE_DESC},
                 {&none, ".png", WEFT_MESSAGE_DESC}};
    char folder[SCRATCH_SIZE], path[300];
    assert_true(scratch_make(folder));
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        snprintf(path, sizeof path, "%s/image%s", folder, cases[i].suffix);
        WeftError error = {0};
        assert_int_equal(weft_image_write(path, cases[i].image, &error), WEFT_USAGE);
        assert_int_equal(error.message, cases[i].message);
    }
    assert_int_equal(rmdir(folder), 0); /* nothing was left behind */
    weft_image_free(&floats);
    weft_image_free(&bytes);
    weft_image_free(&grey);
}

static int entry_count(const char *folder) {
    DIR *dir = opendir(folder);
    assert_non_null(dir);
    int count = 0;
    while (readdir(dir)) count++;
    closedir(dir);
    return count - 2;
}

/* A folder that is not there, a folder in the place of the file, and a disk that is full: FILE_WRITE, and no
 * temporary file stays. */
static void unwritable_path_is_an_error_without_temporary_files(void **state) {
    (void)state;
    WeftImage image = make_image(600, 600, 3, WEFT_PIXEL_F32), bytes = make_image(600, 600, 3, WEFT_PIXEL_U8);
    char folder[SCRATCH_SIZE], path[300];
    assert_true(scratch_make(folder));
    static const char *const suffixes[] = {".exr", ".hdr", ".png"};
    for (int i = 0; i < 3; i++) {
        const WeftImage *what = i == 2 ? &bytes : &image;
        WeftError error = {0};
        snprintf(path, sizeof path, "%s/missing/image%s", folder, suffixes[i]);
        assert_int_equal(weft_image_write(path, what, &error), WEFT_RESOURCES);
        assert_int_equal(error.message, WEFT_MESSAGE_FILE_WRITE);
        snprintf(path, sizeof path, "%s/taken%s", folder, suffixes[i]);
        assert_int_equal(mkdir(path, 0777), 0);
        assert_int_equal(weft_image_write(path, what, &error), WEFT_RESOURCES);
        assert_int_equal(error.message, WEFT_MESSAGE_FILE_WRITE);
        assert_int_equal(entry_count(folder), 1);
        assert_int_equal(rmdir(path), 0);
    }
    assert_int_equal(rmdir(folder), 0);
    weft_image_free(&image);
    weft_image_free(&bytes);
}

/* The writers themselves say so when their stream does not take the bytes. */
static void write_to_a_full_disk_is_an_error(void **state) {
    (void)state;
    WeftImage image = make_image(600, 600, 3, WEFT_PIXEL_F32), bytes = make_image(600, 600, 3, WEFT_PIXEL_U8);
    for (size_t i = 0; i < value_total(&image); i++) { /* noise, which does not compress into a stream's buffer */
        ((float *)image.pixels)[i] = (float)((i * 7919) % 65521) / 1000.0f;
        ((unsigned char *)bytes.pixels)[i] = (unsigned char)((i * i * 7919) >> 7);
    }
    const WeftImageWriting plain = {0};
    for (int i = 0; i < 4; i++) {
        FILE *full = fopen("/dev/full", "wb");
        if (!full) skip();
        WeftError error = {0};
        WeftResult result = i == 0   ? image_write_exr(full, "full", &image, &plain, &error)
                            : i == 1 ? image_write_hdr(full, "full", &image, &plain, &error)
                            : i == 2 ? image_write_npy(full, "full", &image, &plain, &error)
                                     : image_write_png(full, "full", &bytes, &plain, &error);
        fclose(full);
        assert_int_equal(result, WEFT_RESOURCES);
        assert_int_equal(error.message, WEFT_MESSAGE_FILE_WRITE);
    }
    weft_image_free(&image);
    weft_image_free(&bytes);
}

/* A failed write leaves the old file as it was. */
static void failed_write_leaves_the_old_file(void **state) {
    (void)state;
    WeftImage bytes = make_image(4, 4, 3, WEFT_PIXEL_U8), grey = make_image(4, 4, 1, WEFT_PIXEL_F32), back;
    char folder[SCRATCH_SIZE], path[300];
    assert_true(scratch_make(folder));
    snprintf(path, sizeof path, "%s/image.hdr", folder);
    FILE *old = fopen(path, "wb");
    assert_non_null(old);
    fputs("old", old);
    fclose(old);
    assert_int_equal(weft_image_write(path, &grey, NULL), WEFT_USAGE);
    char text[8] = {0};
    old = fopen(path, "rb");
    assert_non_null(old);
    assert_non_null(fgets(text, sizeof text, old));
    fclose(old);
    assert_string_equal(text, "old");
    WeftImage color = make_image(4, 4, 3, WEFT_PIXEL_F32);
    assert_int_equal(weft_image_write(path, &color, NULL), WEFT_OK);
    assert_int_equal(weft_image_read(path, &back, NULL, NULL), WEFT_OK);
    assert_int_equal(unlink(path), 0);
    assert_int_equal(rmdir(folder), 0);
    weft_image_free(&back);
    weft_image_free(&color);
    weft_image_free(&grey);
    weft_image_free(&bytes);
}

static void unsupported_formats_are_named(void **state) {
    (void)state;
    static const struct {
        const char *bytes, *name;
    } files[] = {{"BM and so on", "it is BMP"},
                 {"\xabKTX 11\xbb\r\n\x1a\n and so on", "it is KTX"},
                 {"GIF89a and so on, a screen", "it is GIF"},
                 {"<!DOCTYPE html> not found", "it is HTML"}};
    for (size_t k = 0; k < sizeof files / sizeof *files; k++) {
        WeftImage image;
        WeftError error;
        WeftResult result =
            weft_image_read_memory(files[k].bytes, strlen(files[k].bytes), "map.png", &image, NULL, &error);
        assert_int_equal(result, WEFT_INPUT);
        assert_int_equal(error.message, WEFT_MESSAGE_IMAGE_FORMAT);
        if (!strstr(error.text, files[k].name)) fail_msg("%s", error.text);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(new_image_is_black_and_freed),
        cmocka_unit_test(suffixes_choose_the_format),
        cmocka_unit_test(unknown_content_is_refused),
        cmocka_unit_test(header_that_claims_more_than_the_file_can_hold_is_refused),
        cmocka_unit_test(converted_pixels_have_the_values_of_the_original),
        cmocka_unit_test(srgb_decodes_what_it_encodes),
        cmocka_unit_test(pixels_that_a_format_cannot_hold_are_refused),
        cmocka_unit_test(unwritable_path_is_an_error_without_temporary_files),
        cmocka_unit_test(write_to_a_full_disk_is_an_error),
        cmocka_unit_test(failed_write_leaves_the_old_file),
        cmocka_unit_test(unsupported_formats_are_named),
    };
    return cmocka_run_group_tests_name("image", tests, NULL, NULL);
}
