/* Files that others made, from the shared data folder: good ones by what they show, bad ones by their end. */
#include "image/fixture.h"

#include <dirent.h>
#include <math.h>

/* The data folder, or a skipped test. */
static const char *data_folder(void) {
    const char *folder = getenv("WEFT_DATA");
    if (!folder || !*folder) folder = WEFT_SOURCE_DIR "/../shared/data";
    if (access(folder, R_OK) != 0) {
        print_message("%s is not there (WEFT_DATA can name another)\n", folder);
        skip();
    }
    return folder;
}

static WeftImage read_file(const char *name) {
    char path[512];
    snprintf(path, sizeof path, "%s/%s", data_folder(), name);
    WeftImage image;
    WeftError error = {0};
    if (weft_image_read(path, &image, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    return image;
}

static void assert_bytes(const WeftImage *image, int x, int y, const unsigned char *want) {
    const unsigned char *pixels = image->pixels;
    assert_memory_equal(pixels + (y * image->width + x) * image->channels, want, (size_t)image->channels);
}

static void assert_rgb(const WeftImage *image, int x, int y, float r, float g, float b) {
    const float *at = (const float *)image->pixels + (y * image->width + x) * image->channels;
    assert_near(at[0], r, 1e-3f);
    assert_near(at[1], g, 1e-3f);
    assert_near(at[2], b, 1e-3f);
}

static void png_samples_have_their_texels(void **state) {
    (void)state;
    WeftImage image = read_file("images/png/acid2.png"); /* yellow and clear, in a chequer */
    assert_shape(&image, 2, 2, 4, WEFT_PIXEL_U8);
    assert_bytes(&image, 0, 0, (unsigned char[]){255, 255, 0, 255});
    assert_int_equal(((unsigned char *)image.pixels)[7], 0);
    weft_image_free(&image);
    image = read_file("images/png/basi0g16.png"); /* 16 bits, interlaced */
    assert_shape(&image, 32, 32, 1, WEFT_PIXEL_U16);
    assert_int_equal(((uint16_t *)image.pixels)[0], 0);
    weft_image_free(&image);
    image = read_file("images/png/tp1n3p08_xmp.png"); /* palette with alpha */
    assert_shape(&image, 32, 32, 4, WEFT_PIXEL_U8);
    assert_int_equal(((unsigned char *)image.pixels)[3], 0);
    weft_image_free(&image);
}

static void tga_samples_have_their_texels(void **state) {
    (void)state;
    WeftImage image = read_file("images/tga/black_white.tga"); /* white above black */
    assert_shape(&image, 1280, 720, 3, WEFT_PIXEL_U8);
    assert_bytes(&image, 640, 0, (unsigned char[]){255, 255, 255});
    assert_bytes(&image, 640, 719, (unsigned char[]){0, 0, 0});
    weft_image_free(&image);
}

static void hdr_sample_has_its_texels(void **state) {
    (void)state;
    WeftImage image = read_file("images/hdr/rgbr4x4.hdr");
    assert_shape(&image, 4, 4, 3, WEFT_PIXEL_F32);
    assert_rgb(&image, 2, 0, 163.0f / 16384.0f, 0.0f, 0.0f);
    assert_rgb(&image, 2, 1, 0.0f, 204.0f / 2048.0f, 0.0f);
    assert_rgb(&image, 2, 2, 0.0f, 0.0f, 1.0f);
    assert_rgb(&image, 2, 3, 10.0f, 1.0f, 0.0625f);
    weft_image_free(&image);
    image = read_file("images/hdr/old-rle.hdr"); /* two flat colours with the diagonal between them */
    assert_shape(&image, 551, 276, 3, WEFT_PIXEL_F32);
    const float *corner = (const float *)image.pixels + 3 * 550;
    const float *foot = (const float *)image.pixels + 3 * 275 * 551;
    assert_true(corner[2] > corner[0]);
    assert_true(foot[0] > foot[2]);
    weft_image_free(&image);
}

static void environment_files_have_their_size_and_brightness(void **state) {
    (void)state;
    static const char *const names[] = {"env/studio_small_03_1k.hdr", "env/venice_sunset_1k.hdr",
                                        "env/OrientationLatLong.exr"};
    for (int i = 0; i < 3; i++) {
        WeftImage image = read_file(names[i]);
        assert_shape(&image, 1024, 512, i == 2 ? 4 : 3, WEFT_PIXEL_F32);
        double sum = 0.0;
        for (size_t n = 0; n < value_total(&image); n++) {
            assert_true(isfinite(((float *)image.pixels)[n]));
            sum += (double)((float *)image.pixels)[n];
        }
        assert_true(sum > 0.05 * (double)value_total(&image));
        weft_image_free(&image);
    }
    WeftImage cube = read_file("env/OrientationCube.exr"); /* tiled, with mip levels */
    assert_shape(&cube, 512, 6 * 512, 4, WEFT_PIXEL_F32);
    weft_image_free(&cube);
}

/* Every file of a folder of malformed images: refused in one line, or read. Returns how many there were. */
static int malformed(const char *folder) {
    char path[768];
    snprintf(path, sizeof path, "%s/malformed/%s", data_folder(), folder);
    DIR *dir = opendir(path);
    assert_non_null(dir);
    int count = 0;
    for (struct dirent *entry; (entry = readdir(dir));) {
        if (entry->d_name[0] == '.') continue;
        char file[1100];
        snprintf(file, sizeof file, "%s/%s", path, entry->d_name);
        WeftImage image;
        WeftError error = {0};
        if (weft_image_read(file, &image, NULL, &error) != WEFT_OK) {
            assert_int_equal(error.result, WEFT_INPUT);
            assert_null(strchr(error.text, '\n'));
            assert_int_equal(strncmp(error.text, file, strlen(file) < 200 ? strlen(file) : 200), 0);
            assert_null(image.pixels);
        }
        weft_image_free(&image);
        count++;
    }
    closedir(dir);
    return count;
}

static void malformed_sample_files_are_refused_or_read(void **state) {
    (void)state;
    assert_true(malformed("image-rs") >= 3);
    assert_true(malformed("openexr-damaged") >= 9);
    assert_true(malformed("tinyexr") >= 3);
    assert_true(malformed("gltf-validator/image") >= 1);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(png_samples_have_their_texels),
        cmocka_unit_test(tga_samples_have_their_texels),
        cmocka_unit_test(hdr_sample_has_its_texels),
        cmocka_unit_test(environment_files_have_their_size_and_brightness),
        cmocka_unit_test(malformed_sample_files_are_refused_or_read),
    };
    return cmocka_run_group_tests_name("files", tests, NULL, NULL);
}
