/* Six faces as one lat-long image: each lands where OpenGL has it, upright, from its folder and from any of
 * its files; what is missing, uneven or there twice is one clear line */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "scene/light/cubemap.h"
#include "scene/light/env_split.h"
#include "scratch.h"

enum { SIDE = 32 };

static char folder[SCRATCH_SIZE];

static int begin(void **state) {
    (void)state;
    return scratch_make(folder) ? 0 : -1;
}

static void clear(void) {
    char command[128];
    snprintf(command, sizeof command, "rm -f %s/*", folder);
    assert_int_equal(system(command), 0);
}

static int end(void **state) {
    (void)state;
    clear();
    return scratch_remove_empty(folder) ? 0 : -1;
}

static const char *name_of(const char *name) {
    static char path[256];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return path;
}

/* Blue tells the face, red grows towards the right, green downwards. */
static void write_face(const char *name, int face, int width, int height) {
    WeftImage image;
    WeftError error = {0};
    assert_int_equal(weft_image_create(width, height, 3, WEFT_PIXEL_F32, &image, NULL), WEFT_OK);
    float *p = image.pixels;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++, p += 3) {
            p[0] = ((float)x + 0.5f) / (float)width;
            p[1] = ((float)y + 0.5f) / (float)height;
            p[2] = (float)(face + 1);
        }
    if (weft_image_write(name_of(name), &image, &error) != WEFT_OK) fail_msg("%s", error.text);
    weft_image_free(&image);
}

static const char *const plain[6] = {"posx.exr", "negx.exr", "posy.exr", "negy.exr", "posz.exr", "negz.exr"};
static const char *const mixed[6] = {"PX.hdr", "nx.exr", "Py.EXR", "ny.exr", "pz.exr", "NZ.hdr"};

static void write_all(const char *const names[6]) {
    clear();
    for (int k = 0; k < 6; k++) write_face(names[k], k, SIDE, SIDE);
}

static void fails(const char *path, const char *words) {
    WeftImage image;
    WeftError error = {0};
    assert_int_equal(cubemap_read(path, &image, NULL, &error), WEFT_INPUT);
    assert_int_equal(error.message, WEFT_MESSAGE_CUBEMAP);
    assert_null(image.pixels);
    assert_null(strchr(error.text, '\n'));
    if (!strstr(error.text, words)) fail_msg("%s", error.text);
}

/* Where the middle of a face looks, its right edge and its lower edge: table 3.20 of the OpenGL
 * specification, s to the right and t down. */
static const Vec3 table[6][3] = {{{1, 0, 0}, {0, 0, -1}, {0, -1, 0}}, {{-1, 0, 0}, {0, 0, 1}, {0, -1, 0}},
                                 {{0, 1, 0}, {1, 0, 0}, {0, 0, 1}},   {{0, -1, 0}, {1, 0, 0}, {0, 0, -1}},
                                 {{0, 0, 1}, {1, 0, 0}, {0, -1, 0}},  {{0, 0, -1}, {-1, 0, 0}, {0, -1, 0}}};

static void looks_right(const char *path) {
    WeftImage image;
    WeftError error = {0};
    if (cubemap_read(path, &image, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    assert_int_equal(image.width, 4 * SIDE);
    assert_int_equal(image.height, 2 * SIDE);
    for (int face = 0; face < 6; face++)
        for (int k = 0; k < 25; k++) {
            float right = 0.35f * (float)(k % 5 - 2), down = 0.35f * (float)(k / 5 - 2), c[3];
            Vec3 d = vec3_madd(vec3_madd(table[face][0], table[face][1], right), table[face][2], down);
            latlong_at(&image, vec3_normal_or(d, d), c);
            /* a texel is 0.031 wide; at the poles its columns meet */
            assert_float_equal(c[0], 0.5f + 0.5f * right, 0.02);
            assert_float_equal(c[1], 0.5f + 0.5f * down, 0.02);
            assert_float_equal(c[2], (float)(face + 1), 0.02);
        }
    weft_image_free(&image);
}

static void cubemap_faces_land_where_opengl_has_them(void **state) {
    (void)state;
    write_all(plain);
    assert_true(cubemap_named(folder));
    looks_right(folder);
    looks_right(name_of("negz.exr"));
}

static void cubemap_names_may_be_short_and_of_any_case(void **state) {
    (void)state;
    write_all(mixed);
    write_face("posx.exr", 0, SIDE, SIDE); /* fewer of this kind */
    looks_right(folder);
    assert_true(cubemap_named(name_of("Py.EXR")));
    looks_right(name_of("Py.EXR"));
    assert_false(cubemap_named(name_of("happy.exr")));
    assert_false(cubemap_named(name_of("px.txt")));
    assert_false(cubemap_named("studio.hdr"));
}

static void put_number(FILE *file, uint64_t number, int size) {
    for (int k = 0; k < size; k++) fputc((int)(number >> 8 * k & 255), file);
}

/* Writes the faces of write_face as one KTX 2 file of floats, VkFormat 106, of which `faces` are there. */
static void write_ktx2(const char *name, int faces) {
    const uint32_t header[] = {106, 4, SIDE, SIDE, 0, 0, 6, 1, 0, 104, 44, 0, 0, 0, 0, 0, 0};
    const uint64_t size = 6 * SIDE * SIDE * 3 * 4;
    const uint32_t descriptor[] = {44, 0, 2 | 40 << 16, 0x00010101, 0, 0, 0, 0, 0, 0, 0};
    FILE *file = fopen(name_of(name), "wb");
    assert_non_null(file);
    fwrite("\xabKTX 20\xbb\r\n\x1a\n", 1, 12, file);
    for (size_t k = 0; k < sizeof header / sizeof *header; k++) put_number(file, header[k], 4);
    put_number(file, 148, 8);
    put_number(file, size, 8);
    put_number(file, size, 8);
    for (size_t k = 0; k < sizeof descriptor / sizeof *descriptor; k++) put_number(file, descriptor[k], 4);
    for (int face = 0; face < faces; face++)
        for (int k = 0; k < SIDE * SIDE; k++) {
            const float pixel[] = {((float)(k % SIDE) + 0.5f) / SIDE, ((float)(k / SIDE) + 0.5f) / SIDE,
                                   (float)(face + 1)};
            fwrite(pixel, sizeof *pixel, 3, file);
        }
    assert_int_equal(fclose(file), 0);
}

static void cubemap_of_one_file_lands_as_that_of_six(void **state) {
    (void)state;
    clear();
    write_ktx2("sky.ktx2", 6);
    assert_true(cubemap_named(name_of("sky.ktx2")));
    looks_right(name_of("sky.ktx2"));
    WeftScene *scene = scene_create("cube");
    WeftError error = {0};
    if (weft_scene_set_environment_file(scene, name_of("sky.ktx2"), NULL, &error) != WEFT_OK)
        fail_msg("%s", error.text);
    assert_int_equal(scene->environment.image.width, 4 * SIDE);
    write_ktx2("sky.ktx2", 5);
    assert_int_equal(weft_scene_set_environment_file(scene, name_of("sky.ktx2"), NULL, &error), WEFT_INPUT);
    assert_int_equal(error.message, WEFT_MESSAGE_IMAGE_SIZE);
    weft_scene_free(scene);
}

static void wrong_cubemap_is_an_error(void **state) {
    (void)state;
    write_all(plain);
    write_face("negy.exr", 3, SIDE, SIDE / 2);
    fails(folder, "not square");
    write_face("negy.exr", 3, SIDE / 2, SIDE / 2);
    fails(folder, "16 wide");
    assert_int_equal(unlink(name_of("negy.exr")), 0);
    fails(folder, "negy is missing");
    fails(name_of("posx.exr"), "negy is missing");
    write_face("negy.exr", 3, SIDE, SIDE);
    write_face("NEGY.hdr", 3, SIDE, SIDE);
    fails(folder, "negy is there twice");
    clear();
    fails(folder, "posx is missing");
    WeftImage image;
    WeftError error;
    assert_int_equal(cubemap_read("/nowhere/posx.exr", &image, NULL, &error), WEFT_INPUT);
    assert_int_equal(error.message, WEFT_MESSAGE_FILE_OPEN);
}

/* Bytes go through the sRGB curve, and the scene takes the cube for its light. */
static void scene_takes_a_cubemap_as_environment(void **state) {
    (void)state;
    clear();
    for (int k = 0; k < 6; k++) {
        WeftImage image;
        char name[16];
        assert_int_equal(weft_image_create(4, 4, 3, WEFT_PIXEL_U8, &image, NULL), WEFT_OK);
        memset(image.pixels, 188, 4 * 4 * 3); /* a half, about */
        snprintf(name, sizeof name, "%.4s.png", plain[k]);
        assert_int_equal(weft_image_write(name_of(name), &image, NULL), WEFT_OK);
        weft_image_free(&image);
    }
    WeftScene *scene = scene_create("cube");
    WeftError error = {0};
    if (weft_scene_set_environment_file(scene, folder, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    assert_int_equal(scene->environment.kind, ENVIRONMENT_IMAGE);
    assert_float_equal(((float *)scene->environment.image.pixels)[0], 0.5029, 1e-3);
    weft_scene_free(scene);
}

static void keep_text(void *user, WeftMessage message, const char *text) {
    assert_int_equal(message, WEFT_MESSAGE_IMAGE_REPAIRED);
    snprintf(user, 256, "%s", text);
}

static void sky_below_zero_is_raised_and_told(void **state) {
    (void)state;
    static const float numbers[] = {1.0f, -2.0f, 0.5f, 0.25f, 0.5f, -0.125f};
    char said[256] = "";
    const WeftLog log = {keep_text, said};
    WeftImage image;
    clear();
    assert_int_equal(weft_image_create(2, 1, 3, WEFT_PIXEL_F32, &image, NULL), WEFT_OK);
    memcpy(image.pixels, numbers, sizeof numbers);
    assert_int_equal(weft_image_write(name_of("sky.exr"), &image, NULL), WEFT_OK);
    weft_image_free(&image);
    WeftScene *scene = scene_create("sky");
    assert_int_equal(weft_scene_set_environment_file(scene, name_of("sky.exr"), &log, NULL), WEFT_OK);
    const float *values = scene->environment.image.pixels;
    for (int k = 0; k < 6; k++) assert_float_equal(values[k], fmaxf(numbers[k], 0.0f), 1e-3f);
    if (!strstr(said, "2 of 6 values were below 0")) fail_msg("%s", said);
    weft_scene_free(scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cubemap_faces_land_where_opengl_has_them),
        cmocka_unit_test(cubemap_names_may_be_short_and_of_any_case),
        cmocka_unit_test(cubemap_of_one_file_lands_as_that_of_six),
        cmocka_unit_test(wrong_cubemap_is_an_error),
        cmocka_unit_test(scene_takes_a_cubemap_as_environment),
        cmocka_unit_test(sky_below_zero_is_raised_and_told),
    };
    return cmocka_run_group_tests(tests, begin, end);
}
