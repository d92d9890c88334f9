/* `weft convert`: what it writes of each kind of pixels and of U3M, what it says, and what it refuses. */
#include "run.h"

#include <math.h>

#include "u3m_text.h"
#include "weft/weft.h"

/* Writes a picture of 8 x 8 texels whose channels are steps of 32 to the right and down, and 64. */
static void picture_make(const char *path) {
    WeftImage image;
    assert_int_equal(weft_image_create(8, 8, 3, WEFT_PIXEL_U8, &image, NULL), WEFT_OK);
    unsigned char *pixels = image.pixels;
    for (int n = 0; n < 64; n++) {
        pixels[3 * n] = (unsigned char)(n % 8 * 32);
        pixels[3 * n + 1] = (unsigned char)(n / 8 * 32);
        pixels[3 * n + 2] = 64;
    }
    assert_int_equal(weft_image_write(path, &image, NULL), WEFT_OK);
    weft_image_free(&image);
}

/* Returns the picture of a file, which must be readable. */
static WeftImage picture_of(const char *path) {
    WeftImage image;
    WeftError error = {0};
    if (weft_image_read(path, &image, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    return image;
}

static void converts(const char *from, const char *to, const char *option, const char *said) {
    Ran ran = run_with(NULL, LIST("convert", from, "-o", to, option));
    if (ran.code != 0 || !strstr(ran.err, said)) fail_msg("%d: \"%s\" has no \"%s\"", ran.code, ran.err, said);
    ran_free(&ran);
}

static void texture_becomes_ktx2_and_returns(void **state) {
    (void)state;
    picture_make("steps.png");
    converts("steps.png", "steps.ktx2", NULL, "steps.ktx2: 8 x 8, UASTC");
    converts("steps.ktx2", "back.png", "--quiet", "");
    WeftImage image = picture_of("steps.png"), back = picture_of("back.png");
    assert_int_equal(back.channels, 3);
    for (int k = 0; k < 192; k++)
        assert_in_range(((unsigned char *)back.pixels)[k] + 4 - ((unsigned char *)image.pixels)[k], 0, 8);
    size_t size;
    char *colors = file_bytes("steps.ktx2", &size);
    converts("steps.png", "data.ktx2", "--data", "UASTC");
    char *data = file_bytes("data.ktx2", &size);
    const size_t transfer = 80 + 4 * 24 + 4 + 10; /* of the descriptor behind four levels */
    assert_int_equal(colors[transfer], 2);
    assert_int_equal(data[transfer], 1);
    free(colors);
    free(data);
    weft_image_free(&image);
    weft_image_free(&back);
}

/* Light is linear in .exr and .npy; data keep their numbers. */
static void light_is_decoded_and_data_are_not(void **state) {
    (void)state;
    picture_make("steps.png");
    converts("steps.png", "light.npy", "--quiet", "");
    converts("steps.png", "data.npy", "--data", "wrote data.npy: 8 x 8");
    converts("light.npy", "again.png", "--quiet", "");
    WeftImage light = picture_of("light.npy"), data = picture_of("data.npy"), again = picture_of("again.png");
    assert_true(fabs((double)((float *)light.pixels)[2] - 0.0513) < 1e-3);
    assert_true(fabs((double)((float *)data.pixels)[2] - 64.0 / 255.0) < 1e-6);
    assert_in_range(((unsigned char *)again.pixels)[2], 63, 65);
    weft_image_free(&light);
    weft_image_free(&data);
    weft_image_free(&again);
}

static void refuses(const char *from, const char *to, int code, const char *said) {
    Ran ran = run_with(NULL, LIST("convert", from, "-o", to));
    if (ran.code != code || !strstr(ran.err, said)) fail_msg("%d: \"%s\" has no \"%s\"", ran.code, ran.err, said);
    assert_ptr_equal(strchr(ran.err, '\n'), ran.err + strlen(ran.err) - 1);
    ran_free(&ran);
}

static void pictures_that_cannot_be_converted_are_refused(void **state) {
    (void)state;
    picture_make("steps.png");
    refuses("none.png", "out.ktx2", 3, "none.png: cannot be opened");
    refuses("steps.png", "out.jpg", 2, "out.jpg: has no suffix");
    refuses("steps.png", "steps.png", 2, "steps.png");
    refuses("steps.png", "nowhere/out.ktx2", 4, "nowhere/out.ktx2");
    Ran ran = RUN("convert", "steps.png");
    assert_int_equal(ran.code, 2);
    assert_non_null(strstr(ran.err, "needs -o OUT"));
    ran_free(&ran);
}

/* Folder to archive and back is the same file, byte for byte, with its picture; --save does the same. */
static void u3m_is_packed_and_unpacked_unchanged(void **state) {
    (void)state;
    char text[U3M_TEXT];
    size_t sizes[4];
    picture_make("p.png");
    u3m_text(text, "\"basecolor\"",
             "{\"constant\":{\"r\":0.50,\"g\":1,\"b\":1e-1},\"texture\":{\"mode\":\"multiply\",\"factor\":{\"r\":1,"
             "\"g\":1,\"b\":1},\"image\":{\"dpi\":{\"x\":20.32,\"y\":20.32},\"width\":10,\"height\":10,\"path\":"
             "\"p.png\",\"repeat\":{\"mode\":\"normal\",\"rotation\":0}}}}");
    file_make("cloth.u3m", text, strlen(text));
    assert_int_equal(system("mkdir back saved"), 0);
    converts("cloth.u3m", "cloth.u3ma", NULL, "wrote cloth.u3ma");
    converts("cloth.u3ma", "back/cloth.u3m", "--quiet", "");
    Ran ran = RUN("render", "cloth.u3ma", "--save", "saved/cloth.u3m");
    assert_int_equal(ran.code, 0);
    assert_string_equal(ran.err, "");
    ran_free(&ran);
    char *files[4] = {file_bytes("cloth.u3m", &sizes[0]), file_bytes("back/cloth.u3m", &sizes[1]),
                      file_bytes("saved/cloth.u3m", &sizes[2]), file_bytes("back/p.png", &sizes[3])};
    assert_true(files[0] && files[1] && files[2] && files[3]);
    assert_string_equal(files[0], files[1]);
    assert_string_equal(files[0], files[2]);
    for (int k = 0; k < 4; k++) free(files[k]);
    assert_int_equal(system("rm -r back saved"), 0);
    refuses("cloth.u3m", "cloth.png", 2, "cloth.png: a U3M becomes a .u3m or a .u3ma");
    refuses("p.png", "p.u3m", 2, "p.png: is no U3M");
    refuses("none.u3m", "none.u3ma", 3, "none.u3m: cannot be opened");
    refuses("cloth.u3m", "nowhere/cloth.u3ma", 4, "nowhere/cloth.u3ma");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(u3m_is_packed_and_unpacked_unchanged),
        cmocka_unit_test(texture_becomes_ktx2_and_returns),
        cmocka_unit_test(light_is_decoded_and_data_are_not),
        cmocka_unit_test(pictures_that_cannot_be_converted_are_refused),
    };
    return cmocka_run_group_tests_name("convert", tests, work_begin, work_end);
}
