/* A woven cloth hides the fine relief of the asset and keeps its folds, in both engines, by every way that says so, and
 * a saved scene keeps the map of the asset.
 *
 * Labels: unsanitized */
#include <math.h>

#include "run.h"
#include "weft/weft.h"

enum { SIDE = 1024 };

/* Writes a normal map of waves along u: folds, one over the whole map, and a pile, 128 of them. */
static void map_make(const char *path, double folds, double pile) {
    WeftImage image;
    assert_int_equal(weft_image_create(SIDE, 4, 3, WEFT_PIXEL_U8, &image, NULL), WEFT_OK);
    unsigned char *p = image.pixels;
    for (int k = 0; k < SIDE * 4; k++, p += 3) {
        const double u = 2.0 * acos(-1.0) * (k % SIDE + 0.5) / SIDE, slope = folds * sin(u) + pile * sin(128.0 * u),
                     up = 1.0 / sqrt(1.0 + slope * slope);
        p[0] = (unsigned char)(127.5 + 127.5 * slope * up + 0.5), p[1] = 128;
        p[2] = (unsigned char)(127.5 + 127.5 * up + 0.5);
    }
    assert_int_equal(weft_image_write_as(path, &image, &(WeftImageWriting){.data = 1}, NULL), WEFT_OK);
    weft_image_free(&image);
}

/* Writes a square of half a metre with a normal map; its texture coordinates span two units, and a transform of the map
 * halves them again, so that waves keep their size. */
static void quad_make(const char *path, const char *map) {
    static const float numbers[20] = {0, 0, 0, 0.5f, 0, 0, 0.5f, 0.5f, 0, 0, 0.5f, 0, 0, 2, 2, 2, 2, 0, 0, 0};
    char text[2048];
    file_make("quad.bin", numbers, sizeof numbers);
    const int size = snprintf(
        text, sizeof text,
        "{\"asset\":{\"version\":\"2.0\"},\"extensionsUsed\":[\"KHR_texture_transform\"],\"scenes\":[{\"nodes\":[0]}],"
        "\"nodes\":[{\"mesh\":0}],\"images\":[{\"uri\":\"%s\"}],\"textures\":[{\"source\":0}],\"materials\":[{\"name\":"
        "\"cloth\",\"normalTexture\":{\"index\":0,\"extensions\":{\"KHR_texture_transform\":{\"scale\":[0.5,0.5]}}}}],"
        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"TEXCOORD_0\":1},\"mode\":6,\"material\":0}]}],"
        "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\",\"min\":[0,0,0],"
        "\"max\":[0.5,0.5,0]},{\"bufferView\":1,\"componentType\":5126,\"count\":4,\"type\":\"VEC2\"}],"
        "\"bufferViews\":[{\"buffer\":0,\"byteLength\":48},{\"buffer\":0,\"byteOffset\":48,\"byteLength\":32}],"
        "\"buffers\":[{\"byteLength\":80,\"uri\":\"quad.bin\"}]}",
        map);
    file_make(path, text, (size_t)size);
}

static int assets_begin(void **state) {
    if (work_begin(state) != 0) return -1;
    map_make("folds.png", 0.4, 0.0);
    map_make("both.png", 0.4, 0.6);
    map_make("flat.png", 0.0, 0.0);
    quad_make("folds.gltf", "folds.png");
    quad_make("both.gltf", "both.png");
    quad_make("flat.gltf", "flat.png");
    return 0;
}

/* The whole square, a sixteenth of its height: threads are smaller than a pixel, a wave of the pile is five wide. */
enum { COLUMNS = 640 };
#define PICTURE                                                                                                        \
    "--width", "640", "--height", "20", "--camera", "0.25,0.25,2;0.25,0.25,0;0.4476", "--light",                       \
        "sun;-1,-0.3,-1;3,3,3", "--env", "0", "--quiet", "-o", "seen.npy"
#define TRACED "--spp", "16"
#define DRAWN  "--engine", "raster", "--occlusion", "0"
#define WEAVE  "--weave", "cloth=plain; both 1#808080; sett 40"

/* The brightness of each column of a picture. */
typedef struct Seen {
    double row[COLUMNS];
} Seen;

static Seen seen_by(const char *const *arguments) {
    Seen seen = {{0}};
    WeftImage image;
    Ran ran = run_with(NULL, arguments);
    if (ran.code != 0) fail_msg("%s", ran.err);
    ran_free(&ran);
    assert_int_equal(weft_image_read("seen.npy", &image, NULL, NULL), WEFT_OK);
    assert_int_equal(image.width, COLUMNS);
    const float *p = image.pixels;
    for (int y = 0; y < image.height; y++)
        for (int x = 0; x < COLUMNS; x++) seen.row[x] += (double)p[image.channels * (y * COLUMNS + x) + 1];
    weft_image_free(&image);
    return seen;
}
#define SEEN(...) seen_by(LIST("render", __VA_ARGS__, PICTURE))

/* Returns the mean difference of two rows as a part of the first one's mean. */
static double difference(Seen a, Seen b) {
    double sum = 0.0, mean = 0.0;
    for (int x = 0; x < COLUMNS; x++) sum += fabs(a.row[x] - b.row[x]), mean += a.row[x];
    return sum / mean;
}

static void check_engine(const char *engine, Seen folds, Seen flat, Seen all, Seen usual, Seen none) {
    print_message("%s: folds over flat %.3f, pile over folds %.3f; smoothed beside folds %.4f, none beside flat %.4f\n",
                  engine, difference(flat, folds), difference(folds, all), difference(folds, usual),
                  difference(flat, none));
    assert_true(difference(flat, folds) > 0.1);
    assert_true(difference(folds, all) > 0.1);
    assert_true(difference(folds, usual) < 0.06);
    assert_true(difference(flat, none) < 0.02);
}

static void a_cloth_keeps_folds_and_hides_a_pile(void **state) {
    (void)state;
    check_engine("trace", SEEN("folds.gltf", TRACED, WEAVE, "--set", "cloth.weave.relief=all"),
                 SEEN("flat.gltf", TRACED, WEAVE, "--set", "cloth.weave.relief=all"),
                 SEEN("both.gltf", TRACED, WEAVE, "--set", "cloth.weave.relief=all"), SEEN("both.gltf", TRACED, WEAVE),
                 SEEN("both.gltf", TRACED, WEAVE, "--set", "cloth.weave.relief=none"));
}

static void the_raster_engine_does_so_too(void **state) {
    (void)state;
    Ran ran = run_with(NULL, LIST("render", "both.gltf", DRAWN, PICTURE));
    const bool gl = ran.code == 0;
    ran_free(&ran);
    if (!gl) skip();
    check_engine("raster", SEEN("folds.gltf", DRAWN, WEAVE, "--set", "cloth.weave.relief=all"),
                 SEEN("flat.gltf", DRAWN, WEAVE, "--set", "cloth.weave.relief=all"),
                 SEEN("both.gltf", DRAWN, WEAVE, "--set", "cloth.weave.relief=all"), SEEN("both.gltf", DRAWN, WEAVE),
                 SEEN("both.gltf", DRAWN, WEAVE, "--set", "cloth.weave.relief=none"));
}

/* The length that is smoothed away may be given; none of it is all of the relief. */
static void a_length_says_what_is_fine(void **state) {
    (void)state;
    const Seen all = SEEN("both.gltf", TRACED, WEAVE, "--set", "cloth.weave.relief=all"),
               nothing = SEEN("both.gltf", TRACED, WEAVE, "--set", "cloth.weave.relief=0"),
               little = SEEN("both.gltf", TRACED, WEAVE, "--set", "cloth.weave.relief=0.0002"),
               much = SEEN("both.gltf", TRACED, WEAVE, "--set", "cloth.weave.relief=1"),
               none = SEEN("both.gltf", TRACED, WEAVE, "--set", "cloth.weave.relief=none");
    assert_true(difference(all, nothing) <= 0.0);
    assert_true(difference(all, little) < 0.06);
    assert_true(difference(none, much) < 0.02);
}

/* A saved scene and a saved material draw the same and still have the whole relief: a cloth that asks for it, and a
 * material without a weave, show it again. */
static void a_saved_cloth_keeps_the_map_of_the_asset(void **state) {
    (void)state;
    static const char *const ways[] = {"none", "0.004"};
    for (int k = 0; k < 2; k++) {
        char set[64];
        snprintf(set, sizeof set, "cloth.weave.relief=%s", ways[k]);
        Ran ran = RUN("render", "both.gltf", WEAVE, "--set", set, "--save", "saved.glb", "--save", "saved.json");
        if (ran.code != 0) fail_msg("%s", ran.err);
        ran_free(&ran);
        const Seen here = SEEN("both.gltf", TRACED, WEAVE, "--set", set);
        assert_true(difference(here, SEEN("saved.glb", TRACED)) <= 0.0);
        assert_true(difference(here, SEEN("both.gltf", TRACED, "--material", "cloth=saved.json")) <= 0.0);
        assert_true(difference(SEEN("both.gltf", TRACED, WEAVE, "--set", "cloth.weave.relief=all"),
                               SEEN("saved.glb", TRACED, "--set", "cloth.weave.relief=all")) <= 0.0);
    }
    WeftScene *scene;
    WeftMaterial material;
    assert_int_equal(weft_scene_load("saved.glb", &scene, NULL, NULL), WEFT_OK);
    assert_int_equal(weft_scene_material(scene, 0, &material, NULL), WEFT_OK);
    const int texture = material.inputs[weft_material_input_find("normal")].texture;
    assert_int_equal(weft_scene_texture(scene, texture).width, SIDE);
    assert_true(weft_scene_cloth_info(scene, material.cloth).relief > 0.0f);
    material.cloth = 0;
    assert_int_equal(weft_scene_put_material(scene, 0, &material, NULL), WEFT_OK);
    assert_int_equal(weft_scene_material(scene, 0, &material, NULL), WEFT_OK);
    assert_int_equal(material.inputs[weft_material_input_find("normal")].texture, texture);
    assert_int_equal(weft_scene_save(scene, "plain.glb", NULL), WEFT_OK);
    weft_scene_free(scene);
    assert_true(difference(SEEN("saved.glb", TRACED, "--material", "cloth=preset:denim"),
                           SEEN("plain.glb", TRACED, "--material", "cloth=preset:denim")) <= 0.0);
}

/* New pixels of the asset's map are smoothed too. */
static void a_map_that_is_replaced_is_smoothed_anew(void **state) {
    (void)state;
    const Seen wanted = SEEN("flat.gltf", TRACED, WEAVE), before = SEEN("folds.gltf", TRACED, WEAVE);
    WeftScene *scene;
    WeftImage image;
    WeftMaterial material;
    assert_int_equal(weft_scene_load("folds.gltf", &scene, NULL, NULL), WEFT_OK);
    assert_int_equal(weft_scene_weave(scene, "cloth", "", "plain; both 1#808080; sett 40", NULL, NULL), WEFT_OK);
    assert_int_equal(weft_scene_material(scene, 0, &material, NULL), WEFT_OK);
    assert_int_equal(weft_image_read("flat.png", &image, NULL, NULL), WEFT_OK);
    const int texture = material.inputs[weft_material_input_find("normal")].texture;
    assert_int_equal(weft_scene_put_texture(scene, texture, &image, NULL), WEFT_OK);
    assert_int_equal(weft_scene_save(scene, "replaced.glb", NULL), WEFT_OK);
    WeftRender *render;
    const WeftRenderDesc desc = {.width = 64, .height = 2, .camera = "0.25,0.25,2;0.25,0.25,0;0.4476"};
    float rows[2][64] = {{0}};
    for (int k = 0; k < 2; k++) {
        WeftScene *saved = NULL;
        if (k) assert_int_equal(weft_scene_load("replaced.glb", &saved, NULL, NULL), WEFT_OK);
        assert_int_equal(weft_render_create(k ? saved : scene, &desc, &render, NULL), WEFT_OK);
        assert_int_equal(weft_render_run(render, 4, 0.0, NULL, NULL), WEFT_OK);
        assert_int_equal(weft_render_image(render, &image, NULL), WEFT_OK);
        for (int x = 0; x < 64; x++) rows[k][x] = ((const float *)image.pixels)[image.channels * x];
        weft_image_free(&image);
        weft_render_free(render);
        weft_scene_free(saved);
    }
    assert_memory_equal(rows[0], rows[1], sizeof rows[0]);
    weft_scene_free(scene);
    assert_true(difference(wanted, before) > 0.1);
    assert_true(difference(wanted, SEEN("replaced.glb", TRACED)) <= 0.0);
}

static void a_wrong_relief_is_refused_in_one_line(void **state) {
    (void)state;
    static const char *const bad[] = {"cloth.weave.relief=half", "cloth.weave.relief=-1", "cloth.weave.relief=11",
                                      "cloth.weave.relief=", "cloth.weave={\"draft\":\"plain\",\"relief\":[1]}"};
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        Ran ran = RUN("render", "both.gltf", "--set", bad[k], "-o", "no.npy");
        if (ran.code == 0 || !one_complaint(ran.err) || !strstr(ran.err, "relief") || !strstr(ran.err, "folds"))
            fail_msg("%s: %d: %s", bad[k], ran.code, ran.err);
        ran_free(&ran);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_cloth_keeps_folds_and_hides_a_pile),
                                       cmocka_unit_test(the_raster_engine_does_so_too),
                                       cmocka_unit_test(a_length_says_what_is_fine),
                                       cmocka_unit_test(a_saved_cloth_keeps_the_map_of_the_asset),
                                       cmocka_unit_test(a_map_that_is_replaced_is_smoothed_anew),
                                       cmocka_unit_test(a_wrong_relief_is_refused_in_one_line)};
    return cmocka_run_group_tests(tests, assets_begin, work_end);
}
