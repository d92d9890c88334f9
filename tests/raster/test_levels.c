/* Mip levels that a KTX 2 file has of its own: both renderers draw them from afar, and a saved scene keeps the file
 *
 * Labels: unsanitized */
#include <malloc.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include <cmocka.h>

#include "base/file.h"
#include "raster/gl.h"
#include "raster/square.h"
#include "scratch.h"

enum { TEXELS = 64, LEVELS = 6, SIDE = 64 };
static const char *const CAMERA = "0,2,0.001;0,0,0;43.6"; /* sees 1.6 m */

/* Each level has a colour of its own, which no mean of the others has; sRGB. */
static const unsigned char colors[LEVELS + 1][3] = {{200, 40, 40},   {40, 200, 40},   {40, 40, 200},  {120, 120, 120},
                                                    {120, 120, 120}, {120, 120, 120}, {120, 120, 120}};

static void fill(int level, WeftImage *image) {
    const int side = TEXELS >> level;
    assert_int_equal(weft_image_create(side, side, 3, WEFT_PIXEL_U8, image, NULL), WEFT_OK);
    for (int k = 0; k < 3 * side * side; k++) ((unsigned char *)image->pixels)[k] = colors[level][k % 3];
}

/* Writes a material file whose texture is a file, with `more` said of it. */
static void texture_say(const char *name, const char *texture, const char *more) {
    FILE *file = fopen(name, "w");
    assert_non_null(file);
    fprintf(file, "{\"base_color\": {\"texture\": \"%s\", %s}, \"roughness\": 1, \"specular\": 0, \"reflectance\": 0}",
            texture, more);
    assert_int_equal(fclose(file), 0);
}

/* Writes NAME.ktx2 with so many levels after the first, and NAME.json, a matt material of it. */
static void material_write(const char *name, int levels) {
    WeftImage images[LEVELS + 1];
    WeftError error;
    char path[64];
    for (int k = 0; k <= LEVELS; k++) fill(k, &images[k]);
    const WeftImageWriting how = {.levels = images + 1, .level_count = levels};
    snprintf(path, sizeof path, "%s.ktx2", name);
    if (weft_image_write_as(path, &images[0], &how, &error) != WEFT_OK) fail_msg("%s", error.text);
    for (int k = 0; k <= LEVELS; k++) weft_image_free(&images[k]);
    char json[64];
    snprintf(json, sizeof json, "%s.json", name);
    texture_say(json, path, "\"levels\": true");
}

/* A square whose texture has so many texels across a pixel, in even light. */
static WeftScene *square(const char *material, double across) {
    static const float normal[3] = {0.0f, 1.0f, 0.0f};
    const float repeats = (float)(across * SIDE / 1.6 * 2.0 / TEXELS);
    WeftScene *scene = test_scene();
    WeftError error;
    test_material(scene, 0.5f);
    Mesh *quad = test_quad(scene, vec3(-1.0f, 0.0f, 1.0f), vec3(2.0f, 0.0f, 0.0f), vec3(0.0f, 0.0f, -2.0f));
    quad->normal = arena_array(&scene->arena, 4, sizeof normal);
    quad->texcoord[0] = arena_array(&scene->arena, 8, sizeof(float));
    for (int k = 0; k < 4; k++) {
        memcpy(quad->normal + 3 * k, normal, sizeof normal);
        quad->texcoord[0][2 * k] = k == 1 || k == 2 ? repeats : 0.0f;
        quad->texcoord[0][2 * k + 1] = k == 2 || k == 3 ? repeats : 0.0f;
    }
    scene_bounds(scene);
    test_environment(scene, 1.0f);
    if (weft_scene_assign_material(scene, NULL, material, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    return scene;
}

static WeftImage traced(const WeftScene *scene) { return square_traced(scene, SIDE, CAMERA, 16); }

static WeftImage drawn(const WeftScene *scene) { return square_drawn(scene, SIDE, CAMERA); }

static double linear(int byte) { return pow((byte / 255.0 + 0.055) / 1.055, 2.4); }

/* Compares the mean of the middle of a picture with a mixture of two levels. */
static void looks_like(WeftImage image, const char *what, int level, double next) {
    for (int c = 0; c < 3; c++) {
        double sum = 0.0;
        for (int y = SIDE / 4; y < SIDE * 3 / 4; y++)
            for (int x = SIDE / 4; x < SIDE * 3 / 4; x++)
                sum += (double)((const float *)image.pixels)[image.channels * (y * SIDE + x) + c];
        const double mean = sum * 4.0 / (SIDE * SIDE);
        const double wanted =
            linear(colors[level][c]) * (1.0 - next) + (next > 0.0 ? next * linear(colors[level + 1][c]) : 0.0);
        if (!(fabs(mean - wanted) < 0.02 + 0.05 * wanted))
            fail_msg("%s, level %d + %g, channel %d: %.4f, not %.4f", what, level, next, c, mean, wanted);
    }
    weft_image_free(&image);
}

/* Texels across a pixel, and what is seen of them. */
static const struct {
    double across;
    int level;
    double next; /* share of the level after it */
} seen[] = {{0.5, 0, 0.0}, {1.0, 0, 0.0}, {2.0, 1, 0.0}, {4.0, 2, 0.0}, {2.8284, 1, 0.5}, {1.4142, 0, 0.5}};
enum { SEEN = sizeof seen / sizeof *seen };

static void levels_are_seen(WeftImage (*render)(const WeftScene *), const char *what) {
    material_write("own", LEVELS);
    for (int k = 0; k < SEEN; k++) {
        WeftScene *scene = square("own.json", seen[k].across);
        looks_like(render(scene), what, seen[k].level, seen[k].next);
        weft_scene_free(scene);
    }
}

static void path_tracer_draws_the_levels(void **state) {
    (void)state;
    levels_are_seen(traced, "traced");
}

static void raster_engine_draws_the_levels(void **state) {
    (void)state;
    need_gl();
    levels_are_seen(drawn, "drawn");
}

/* A sampler of each kind that asks for no levels shows the picture itself, also when it was saved and read again. */
static void samplers_without_levels(WeftImage (*render)(const WeftScene *), const char *what) {
    WeftError error;
    material_write("own", LEVELS);
    for (int k = 0; k < 2; k++) {
        WeftScene *scene = square("own.json", 4.0), *again;
        scene->textures[0].nearest = k == 0;
        scene->textures[0].single = k == 1;
        looks_like(render(scene), what, 0, 0.0);
        if (weft_scene_save(scene, "sampled.glb", &error) != WEFT_OK) fail_msg("%s", error.text);
        if (weft_scene_load("sampled.glb", &again, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
        assert_non_null(again->textures[0].levels);
        test_environment(again, 1.0f);
        looks_like(render(again), what, 0, 0.0);
        weft_scene_free(again);
        weft_scene_free(scene);
    }
}

static void path_tracer_heeds_samplers(void **state) {
    (void)state;
    samplers_without_levels(traced, "traced");
}

static void raster_engine_heeds_samplers(void **state) {
    (void)state;
    need_gl();
    samplers_without_levels(drawn, "drawn");
}

/* A material file says it by a word, and no other than true or false. */
static void material_files_turn_levels_off(void **state) {
    (void)state;
    WeftError error;
    material_write("own", LEVELS);
    texture_say("off.json", "own.ktx2", "\"levels\": false");
    WeftScene *scene = square("off.json", 4.0);
    looks_like(traced(scene), "levels: false", 0, 0.0);
    assert_int_equal(weft_scene_save_material(scene, 0, "kept-off.json", &error), WEFT_OK);
    texture_say("odd.json", "own.ktx2", "\"levels\": 1");
    assert_int_equal(weft_scene_assign_material(scene, NULL, "odd.json", NULL, &error), WEFT_INPUT);
    assert_non_null(strstr(error.text, "levels must be true or false"));
    weft_scene_free(scene);
    scene = square("kept-off.json", 4.0);
    looks_like(traced(scene), "saved", 0, 0.0);
    weft_scene_free(scene);
}

/* The levels are there however the file came: by a material, as a map of its name, or read again. */
static void levels_do_not_depend_on_how_a_file_came(void **state) {
    (void)state;
    WeftError error;
    material_write("own", LEVELS);
    material_write("other", LEVELS);
    static const char *const paths[] = {"own.ktx2", "other.ktx2"}; /* the scene has the first */
    for (int k = 0; k < 2; k++) {
        WeftScene *scene = square("own.json", 4.0);
        if (weft_scene_set_texture(scene, "matt.base_color", paths[k], NULL, &error) != WEFT_OK)
            fail_msg("%s", error.text);
        looks_like(traced(scene), paths[k], 2, 0.0);
        for (int t = 1; t <= scene->texture_count; t++)
            if (weft_scene_read_texture(scene, t, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
        looks_like(traced(scene), "read again", 2, 0.0);
        weft_scene_free(scene);
    }
}

/* Memory does not grow with reloads: an editor's user saves the picture a hundred times. */
static void reloads_release_the_levels_before(void **state) {
    (void)state;
    enum { RELOADS = 100, FIRST = 4 };
    size_t before = 0;
    material_write("own", LEVELS);
    WeftScene *scene = square("own.json", 4.0);
    for (int k = 0; k < RELOADS; k++) {
        if (k == FIRST) before = mallinfo2().uordblks;
        assert_int_equal(weft_scene_read_texture(scene, 1, NULL, NULL), WEFT_OK);
    }
    const size_t after = mallinfo2().uordblks, set = (size_t)TEXELS * TEXELS; /* of all levels, at 3 bytes a texel */
    if (after > before + 10 * set) fail_msg("%zu bytes more", after - before);
    weft_scene_free(scene);
}

/* Scenes whose textures differ only in their levels are not one scene. */
static void levels_count_in_the_hash(void **state) {
    (void)state;
    material_write("own", LEVELS);
    material_write("short", 2);
    WeftScene *own = square("own.json", 4.0), *same = square("own.json", 4.0), *other = square("short.json", 4.0);
    assert_true(weft_scene_hash(own) == weft_scene_hash(same));
    assert_true(weft_scene_hash(own) != weft_scene_hash(other));
    weft_scene_free(own);
    weft_scene_free(same);
    weft_scene_free(other);
}

/* A file with a damaged level, the second or the last, still has its picture. */
static void damaged_levels_are_left_out(void **state) {
    (void)state;
    enum { INDEX = 80, ENTRY = 24 };
    static const int damaged[] = {1, LEVELS};
    for (int k = 0; k < 2; k++) {
        FileBytes file;
        material_write("hurt", LEVELS);
        assert_int_equal(file_read("hurt.ktx2", SIZE_MAX, &file, NULL), WEFT_OK);
        const unsigned char *entry = file.data + INDEX + ENTRY * damaged[k];
        const size_t at = entry[0] + 256u * entry[1] + 65536u * entry[2], size = entry[8] + 256u * entry[9];
        assert_true(size > 0 && at + size <= file.size);
        memset(file.data + at, 0xff, size);
        FILE *stream = fopen("hurt.ktx2", "wb");
        assert_non_null(stream);
        assert_true(fwrite(file.data, 1, file.size, stream) == file.size);
        assert_int_equal(fclose(stream), 0);
        free(file.data);
        WeftScene *scene = square("hurt.json", 4.0);
        looks_like(traced(scene), "damaged", 0, 0.0);
        weft_scene_free(scene);
    }
}

/* The roughness that is made of a glossiness has no levels: those of the file show the specular colour. */
static void glossiness_is_not_read_as_roughness(void **state) {
    (void)state;
    static const char text[] =
        "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],"
        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"TEXCOORD_0\":1},\"material\":0}]}],"
        "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\"min\":[-1,-1,0],"
        "\"max\":[1,1,0]},{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC2\"}],"
        "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],\"buffers\":[{\"byteLength\":36,\"uri\":"
        "\"data:application/octet-stream;base64,AACAvwAAgL8AAAAAAACAPwAAgL8AAAAAAAAAAAAAgD8AAAAA\"}],"
        "\"extensionsUsed\":[\"KHR_materials_pbrSpecularGlossiness\",\"KHR_texture_basisu\"],"
        "\"images\":[{\"uri\":\"gloss.ktx2\"}],"
        "\"textures\":[{\"extensions\":{\"KHR_texture_basisu\":{\"source\":0}}}],"
        "\"materials\":[{\"extensions\":{\"KHR_materials_pbrSpecularGlossiness\":{"
        "\"specularGlossinessTexture\":{\"index\":0}}}}]}";
    WeftImage image;
    WeftError error;
    assert_int_equal(weft_image_create(TEXELS, TEXELS, 4, WEFT_PIXEL_U8, &image, NULL), WEFT_OK);
    for (int k = 0; k < 4 * TEXELS * TEXELS; k++) ((unsigned char *)image.pixels)[k] = k % 4 == 3 ? 51 : 255;
    assert_int_equal(weft_image_write_as("gloss.ktx2", &image, &(WeftImageWriting){.data = 0}, &error), WEFT_OK);
    weft_image_free(&image);
    FILE *file = fopen("gloss.gltf", "w");
    assert_true(file && fputs(text, file) >= 0 && fclose(file) == 0);
    WeftScene *scene;
    if (weft_scene_load("gloss.gltf", &scene, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    const Input *inputs = scene->materials[0].inputs;
    const Texture *specular = &scene->textures[inputs[INPUT_specular_color].texture - 1],
                  *roughness = &scene->textures[inputs[INPUT_roughness].texture - 1];
    assert_non_null(specular->levels);
    assert_null(roughness->levels);
    const double first = ((const uint16_t *)scene->images[roughness->image].pixels)[0] / 65535.0;
    assert_true(fabs(first - 0.8) < 0.02);
    weft_scene_free(scene);
}

/* Levels that do not go down to one texel are no pyramid: the picture itself is drawn, as if there were none. */
static void levels_that_end_early_are_left_out(void **state) {
    (void)state;
    material_write("short", 2);
    WeftScene *scene = square("short.json", 4.0);
    looks_like(traced(scene), "traced", 0, 0.0);
    weft_scene_free(scene);
}

/* Returns true if the bytes of one file are among those of another. */
static bool holds(const FileBytes *file, const FileBytes *part) {
    for (size_t k = 0; k + part->size <= file->size; k++)
        if (memcmp(file->data + k, part->data, part->size) == 0) return true;
    return false;
}

/* A packed scene has the file as it was, and a plain picture for viewers without its decoder; so has the same unpacked. */
static void saved_scenes_keep_the_file(void **state) {
    (void)state;
    static const char *const paths[] = {"scene.glb", "scene.gltf"};
    material_write("kept", LEVELS);
    FileBytes file, saved, beside;
    WeftError error;
    assert_int_equal(file_read("kept.ktx2", SIZE_MAX, &file, NULL), WEFT_OK);
    WeftScene *scene = square("kept.json", 4.0);
    for (int k = 0; k < 2; k++) {
        WeftScene *again;
        if (weft_scene_save(scene, paths[k], &error) != WEFT_OK) fail_msg("%s", error.text);
        assert_int_equal(file_read(paths[k], SIZE_MAX, &saved, NULL), WEFT_OK);
        const FileBytes name = {.data = (unsigned char *)"KHR_texture_basisu", .size = 18};
        const FileBytes plain = {.data = (unsigned char *)(k ? "-0.png" : "image/png"), .size = k ? 6 : 9};
        assert_true(holds(&saved, &name) && holds(&saved, &plain));
        if (k == 0) assert_true(holds(&saved, &file));
        free(saved.data);
        if (weft_scene_load(paths[k], &again, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
        assert_int_equal(again->image_count, 1);
        test_environment(again, 1.0f);
        looks_like(traced(again), paths[k], 2, 0.0);
        weft_scene_free(again);
    }
    assert_int_equal(file_read("scene-1.ktx2", SIZE_MAX, &beside, NULL), WEFT_OK);
    assert_true(beside.size == file.size && memcmp(beside.data, file.data, file.size) == 0);
    free(beside.data);
    free(file.data);
    weft_scene_free(scene);
}

static int begin(void **state) {
    gl_begin(state);
    return scratch_group_begin(state);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(path_tracer_draws_the_levels),       cmocka_unit_test(raster_engine_draws_the_levels),
        cmocka_unit_test(path_tracer_heeds_samplers),         cmocka_unit_test(raster_engine_heeds_samplers),
        cmocka_unit_test(material_files_turn_levels_off),     cmocka_unit_test(levels_do_not_depend_on_how_a_file_came),
        cmocka_unit_test(reloads_release_the_levels_before),  cmocka_unit_test(levels_count_in_the_hash),
        cmocka_unit_test(damaged_levels_are_left_out),        cmocka_unit_test(glossiness_is_not_read_as_roughness),
        cmocka_unit_test(levels_that_end_early_are_left_out), cmocka_unit_test(saved_scenes_keep_the_file),
    };
    return cmocka_run_group_tests(tests, begin, scratch_group_end);
}
