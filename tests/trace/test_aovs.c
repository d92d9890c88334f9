/* Pictures beside the picture: where surfaces are, and whose they are, as a compositing program reads them. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <jansson.h>
#include <openexr.h>

#include "scratch.h"
#include "shading/stack/layer.h"
#include "trace/frame/matte.h"
#include "trace/scenes.h"

enum { WIDTH = 40, HEIGHT = 30, CHANNELS_MOST = 64 };

static const char odd[] = "K\xc3\xa4se \"roh\" \\ /\n2";

/* Two quads side by side, with a gap between, before a third one; one has an odd name and one has none. */
static WeftScene *quads(void) {
    static const char *const names[] = {odd, "", "wall"}, *const materials[] = {"wool", "", "wool"};
    WeftScene *scene = test_scene();
    for (int k = 0; k < 3; k++) {
        test_material(scene, 0.2f + 0.2f * (float)k);
        scene->material_names[k] = materials[k];
        Mesh *mesh = k < 2 ? test_quad(scene, vec3(k ? 0.13f : -1.1f, -0.57f, 0.5f), vec3(1, 0, 0), vec3(0, 1, 0))
                           : test_quad(scene, vec3(-3, -0.9f, -1), vec3(6, 0, 0), vec3(0, 4, 0));
        mesh->name = names[k];
        mesh->texcoord[0] = arena_array(&scene->arena, 4, 2 * sizeof(float));
        const float uv[8] = {0, 0, 1, 0, 1, 1, 0, 1};
        memcpy(mesh->texcoord[0], uv, sizeof uv);
    }
    test_environment(scene, 1.0f);
    scene_bounds(scene);
    return scene;
}

static const unsigned all_aovs = (1u << WEFT_AOV_COUNT) - 1u;

static WeftRender *rendered(const WeftScene *scene, int threads) {
    WeftRenderDesc desc = {.width = WIDTH,
                           .height = HEIGHT,
                           .camera = "0,0,4;0,0,0;40",
                           .background = WEFT_BACKGROUND_TRANSPARENT,
                           .threads = threads};
    WeftRender *r = NULL;
    WeftError error;
    weft_render_record(&desc, all_aovs);
    if (weft_render_create(scene, &desc, &r, &error) != WEFT_OK) fail_msg("%s", error.text);
    assert_int_equal(weft_render_run(r, 24, 0.0, NULL, NULL), WEFT_OK);
    return r;
}

/* A file's channels of 32 bits, and its texts. */
typedef struct Exr {
    exr_context_t context;
    int count;
    char names[CHANNELS_MOST][64];
    float values[CHANNELS_MOST][WIDTH * HEIGHT];
} Exr;

static void check(exr_result_t status) {
    if (status != EXR_ERR_SUCCESS) fail_msg("%s", exr_get_error_code_as_string(status));
}

/* Decodes a file as OpenEXR's own programs do. */
static void exr_open(Exr *exr, const char *path) {
    const exr_context_initializer_t start = EXR_DEFAULT_CONTEXT_INITIALIZER;
    exr_decode_pipeline_t pipeline = EXR_DECODE_PIPELINE_INITIALIZER;
    int32_t lines = 0;
    check(exr_start_read(&exr->context, path, &start));
    check(exr_get_scanlines_per_chunk(exr->context, 0, &lines));
    for (int y = 0; y < HEIGHT; y += lines) {
        exr_chunk_info_t chunk;
        check(exr_read_scanline_chunk_info(exr->context, 0, y, &chunk));
        check(y ? exr_decoding_update(exr->context, 0, &chunk, &pipeline)
                : exr_decoding_initialize(exr->context, 0, &chunk, &pipeline));
        exr->count = pipeline.channel_count;
        assert_true(exr->count <= CHANNELS_MOST);
        for (int c = 0; c < exr->count; c++) {
            exr_coding_channel_info_t *channel = &pipeline.channels[c];
            snprintf(exr->names[c], sizeof exr->names[c], "%s", channel->channel_name);
            channel->decode_to_ptr = (uint8_t *)(exr->values[c] + y * WIDTH);
            channel->user_data_type = EXR_PIXEL_FLOAT;
            channel->user_bytes_per_element = 4;
            channel->user_pixel_stride = 4;
            channel->user_line_stride = 4 * WIDTH;
        }
        if (y == 0) check(exr_decoding_choose_default_routines(exr->context, 0, &pipeline));
        check(exr_decoding_run(exr->context, 0, &pipeline));
    }
    check(exr_decoding_destroy(exr->context, &pipeline));
}

static const float *channel(const Exr *exr, const char *name) {
    for (int c = 0; c < exr->count; c++)
        if (strcmp(exr->names[c], name) == 0) return exr->values[c];
    fail_msg("there is no channel %s", name);
    return NULL;
}

static const char *text_of(const Exr *exr, const char *name) {
    const char *text = NULL;
    int32_t length = 0;
    if (exr_attr_get_string(exr->context, 0, name, &length, &text) != EXR_ERR_SUCCESS) fail_msg("no %s", name);
    return text;
}

/* Writes the picture with all AOVs, and reads it back. */
static Exr *written(const WeftRender *r) {
    char folder[SCRATCH_SIZE];
    WeftRenderLayers layers;
    WeftImage image, plain;
    WeftError error;
    Exr *exr = calloc(1, sizeof *exr);
    assert_non_null(exr);
    assert_true(scratch_enter(folder));
    if (weft_render_layers(r, all_aovs, &layers, &error) != WEFT_OK) fail_msg("%s", error.text);
    assert_int_equal(weft_render_image(r, &image, NULL), WEFT_OK);
    const WeftImageWriting how = {.layers = layers.layers,
                                  .layer_count = layers.layer_count,
                                  .texts = layers.texts,
                                  .text_count = layers.text_count};
    if (weft_image_write_as("a.exr", &image, &how, &error) != WEFT_OK) fail_msg("%s", error.text);
    weft_render_layers_free(&layers);
    exr_open(exr, "a.exr");
    /* weft's own reader takes the picture from among the layers */
    assert_int_equal(weft_image_read("a.exr", &plain, NULL, &error), WEFT_OK);
    assert_int_equal(plain.channels, 4);
    for (int k = 0; k < WIDTH * HEIGHT; k++)
        assert_true(fabsf(((float *)plain.pixels)[4 * k + 3] - ((float *)image.pixels)[4 * k + 3]) < 1e-3f);
    weft_image_free(&plain);
    weft_image_free(&image);
    assert_true(scratch_remove(folder));
    return exr;
}

static void exr_close(Exr *exr) {
    exr_finish(&exr->context);
    free(exr);
}

/* The hash by its published values, and the names of the specification's sample. */
static void ids_are_those_of_the_specification(void **state) {
    (void)state;
    assert_int_equal(matte_hash(""), 0);
    assert_int_equal(matte_hash("hello"), 0x248bfa47);
    assert_int_equal(matte_hash("hello, world"), 0x149bbb7f);
    assert_int_equal(matte_hash("The quick brown fox jumps over the lazy dog"), 0x2e4ff723);
    assert_int_equal(matte_id("bunny"), 0x13851a76);
    assert_int_equal(matte_id("default"), 0x42c9679f);
    int inverted = 0;
    for (int k = 0; k < 20000; k++) { /* each id is a normal float */
        char name[16];
        snprintf(name, sizeof name, "m%d", k);
        const uint32_t id = matte_id(name);
        float value;
        memcpy(&value, &id, sizeof value);
        assert_true(isnormal(value));
        inverted += id != matte_hash(name);
    }
    assert_in_range(inverted, 50, 400); /* two exponents of 256 */
}

static void ranks_are_sorted_and_bounded(void **state) {
    (void)state;
    Matte matte = {{0}, {0}};
    float ranks[2 * MATTE_RANKS];
    for (uint32_t id = 1; id <= 12; id++)
        for (uint32_t k = 0; k < id; k++) matte_add(&matte, id);
    matte_rank(&matte, 78, ranks);
    for (int k = 0; k < MATTE_RANKS; k++) {
        uint32_t id;
        memcpy(&id, &ranks[2 * k], sizeof id);
        assert_int_equal(id, 8 - k); /* ids 9 to 12 found no place */
        assert_true(fabsf(ranks[2 * k + 1] - (float)id / 78.0f) < 1e-6f);
    }
}

/* Checks a matte's file entries; returns its manifest. */
static json_t *manifest_of(const Exr *exr, const char *layer) {
    char key[48], hash[9];
    snprintf(hash, sizeof hash, "%08x", (unsigned)matte_hash(layer));
    snprintf(key, sizeof key, "cryptomatte/%.7s/name", hash);
    assert_string_equal(text_of(exr, key), layer);
    snprintf(key, sizeof key, "cryptomatte/%.7s/hash", hash);
    assert_string_equal(text_of(exr, key), "MurmurHash3_32");
    snprintf(key, sizeof key, "cryptomatte/%.7s/conversion", hash);
    assert_string_equal(text_of(exr, key), "uint32_to_float32");
    snprintf(key, sizeof key, "cryptomatte/%.7s/manifest", hash);
    json_t *manifest = json_loads(text_of(exr, key), 0, NULL);
    assert_non_null(manifest);
    return manifest;
}

/* Returns the coverage that a matte of the file has of a name at a pixel, and adds all coverage to *sum. */
static float coverage_of(const Exr *exr, const char *layer, const char *name, int pixel, float *sum) {
    const uint32_t wanted = matte_id(name);
    float found = 0.0f;
    *sum = 0.0f;
    for (int rank = 0; rank < MATTE_RANKS; rank++) {
        char id_name[32], cover_name[32];
        snprintf(id_name, sizeof id_name, "%s%02d.%s", layer, rank / 2, rank % 2 ? "B" : "R");
        snprintf(cover_name, sizeof cover_name, "%s%02d.%s", layer, rank / 2, rank % 2 ? "A" : "G");
        const float *id = channel(exr, id_name) + pixel, *cover = channel(exr, cover_name) + pixel;
        *sum += *cover;
        if (memcmp(id, &wanted, sizeof wanted) == 0) found += *cover;
    }
    return found;
}

static void mattes_cover_what_the_picture_covers(void **state) {
    (void)state;
    WeftScene *scene = quads();
    WeftRender *r = rendered(scene, 2);
    Exr *exr = written(r);
    json_t *objects = manifest_of(exr, "CryptoObject"), *materials = manifest_of(exr, "CryptoMaterial");
    assert_int_equal(json_object_size(objects), 3);
    assert_int_equal(json_object_size(materials), 2);
    assert_non_null(json_object_get(objects, odd));
    assert_non_null(json_object_get(objects, "unnamed"));
    char id[9];
    snprintf(id, sizeof id, "%08x", (unsigned)matte_id(odd));
    assert_string_equal(json_string_value(json_object_get(objects, odd)), id);
    WeftImage image;
    assert_int_equal(weft_render_image(r, &image, NULL), WEFT_OK);
    double whole[3] = {0};
    for (int k = 0; k < WIDTH * HEIGHT; k++) {
        const float alpha = ((float *)image.pixels)[4 * k + 3];
        float sum, of_materials;
        const float a = coverage_of(exr, "CryptoObject", odd, k, &sum),
                    b = coverage_of(exr, "CryptoObject", "unnamed", k, &sum),
                    c = coverage_of(exr, "CryptoObject", "wall", k, &sum);
        assert_true(fabsf(sum - alpha) < 1e-5f);
        assert_true(fabsf(a + b + c - alpha) < 1e-5f);
        const float wool = coverage_of(exr, "CryptoMaterial", "wool", k, &of_materials);
        assert_true(fabsf(of_materials - alpha) < 1e-5f);
        assert_true(fabsf(wool - a - c) < 1e-5f); /* two objects of one material's name */
        whole[0] += (double)a, whole[1] += (double)b, whole[2] += (double)c;
    }
    /* a pixel at the quads' distance spans 2 tan(20 deg) 3.5 / HEIGHT */
    const double quad = (double)HEIGHT / (0.72794 * 3.5) * (double)HEIGHT / (0.72794 * 3.5);
    assert_true(fabs(whole[0] / quad - 1.0) < 0.03 && fabs(whole[1] / quad - 1.0) < 0.03 && whole[2] > quad);
    json_decref(objects);
    json_decref(materials);
    weft_image_free(&image);
    exr_close(exr);
    weft_render_free(r);
    weft_scene_free(scene);
}

/* Within the left quad a pixel's position is on it, and its texture coordinates are those of the position. */
static void places_are_those_of_the_surface(void **state) {
    (void)state;
    WeftScene *scene = quads();
    WeftRender *r = rendered(scene, 1);
    Exr *exr = written(r);
    const float *x = channel(exr, "P.X"), *y = channel(exr, "P.Y"), *z = channel(exr, "P.Z"), *u = channel(exr, "UV.U"),
                *v = channel(exr, "UV.V"), *depth = channel(exr, "Z");
    int inside = 0, outside = 0;
    for (int k = 0; k < WIDTH * HEIGHT; k++) {
        float sum;
        if (coverage_of(exr, "CryptoObject", odd, k, &sum) > 0.999f) {
            inside++;
            assert_true(fabsf(z[k] - 0.5f) < 1e-4f && fabsf(depth[k] - 3.5f) < 1e-3f);
            assert_true(fabsf(x[k] - (u[k] - 1.1f)) < 1e-4f && fabsf(y[k] - (v[k] - 0.57f)) < 1e-4f);
        } else if (!(sum > 0.0f)) {
            outside++;
            assert_true(x[k] == 0.0f && y[k] == 0.0f && z[k] == 0.0f && u[k] == 0.0f && v[k] == 0.0f);
        }
    }
    assert_true(inside > 50 && outside > 50);
    exr_close(exr);
    weft_render_free(r);
    weft_scene_free(scene);
}

static void aovs_are_the_same_on_any_threads_and_change_no_byte(void **state) {
    (void)state;
    WeftScene *scene = quads();
    WeftRender *one = rendered(scene, 1), *seven = rendered(scene, 7);
    for (int aov = 0; aov < WEFT_AOV_COUNT; aov++) {
        WeftImage a, b;
        assert_int_equal(weft_render_aov(one, (WeftAov)aov, &a, NULL), WEFT_OK);
        assert_int_equal(weft_render_aov(seven, (WeftAov)aov, &b, NULL), WEFT_OK);
        assert_memory_equal(a.pixels, b.pixels, (size_t)(WIDTH * HEIGHT * a.channels) * sizeof(float));
        weft_image_free(&a);
        weft_image_free(&b);
    }
    WeftImage with, without;
    assert_int_equal(weft_render_image(one, &with, NULL), WEFT_OK);
    const WeftRenderDesc plain = {.width = WIDTH,
                                  .height = HEIGHT,
                                  .camera = "0,0,4;0,0,0;40",
                                  .background = WEFT_BACKGROUND_TRANSPARENT,
                                  .halves = WEFT_HALVES_INDEPENDENT};
    without = test_render(scene, plain, 24);
    assert_memory_equal(with.pixels, without.pixels, WIDTH * HEIGHT * 4 * sizeof(float));
    weft_image_free(&with);
    weft_image_free(&without);
    weft_render_free(one);
    weft_render_free(seven);
    weft_scene_free(scene);
}

/* A ball with all slots under a lamp, before a matt wall. */
static WeftScene *slotted_scene(void) {
    WeftScene *scene = test_scene();
    Material *ball = test_material(scene, 0.5f);
    test_color(ball, INPUT_specular, 1.0f);
    test_color(ball, INPUT_sheen_color, 0.6f);
    ball->inputs[INPUT_sheen_roughness].value[0] = 0.5f;
    ball->inputs[INPUT_clearcoat].value[0] = 0.5f;
    test_sphere(scene, vec3(0, 0, 0), 1);
    test_material(scene, 0.4f);
    test_quad(scene, vec3(-4, -4, -1.5f), vec3(8, 0, 0), vec3(0, 8, 0));
    Material *lamp = test_material(scene, 0.0f);
    test_color(lamp, INPUT_emission, 6.0f);
    scene->material_names[2] = "lamp";
    test_quad(scene, vec3(0.9f, 0.5f, -1.2f), vec3(0, 0.6f, 0), vec3(-0.5f, 0, 0.6f));
    test_environment(scene, 0.3f);
    scene_bounds(scene);
    return scene;
}

static WeftImage aov_of(const WeftRender *r, WeftAov aov) {
    WeftImage image;
    WeftError error;
    if (weft_render_aov(r, aov, &image, &error) != WEFT_OK) fail_msg("%s", error.text);
    return image;
}

/* All slots of the ball have light, the wall has diffuse light alone, and only the lamp has other light. */
static void light_of_slots_adds_up_to_the_picture(void **state) {
    (void)state;
    WeftScene *scene = slotted_scene();
    WeftRender *r = rendered(scene, 3);
    WeftImage image, slot[6];
    double all[6] = {0};
    const uint32_t id = matte_id("lamp");
    assert_int_equal(weft_render_image(r, &image, NULL), WEFT_OK);
    for (int k = 0; k < 6; k++) slot[k] = aov_of(r, (WeftAov)(WEFT_AOV_DIFFUSE + k));
    WeftImage materials = aov_of(r, WEFT_AOV_MATERIAL);
    for (int p = 0; p < WIDTH * HEIGHT; p++)
        for (int c = 0; c < 3; c++) {
            const float *pixel = (const float *)image.pixels + 4 * p, light = pixel[c] * pixel[3];
            float sum = 0.0f;
            for (int k = 0; k < 6; k++) {
                const float part = ((const float *)slot[k].pixels)[3 * p + c];
                if (k < 5) assert_true(part >= 0.0f);
                sum += part, all[k] += (double)part;
            }
            assert_true(fabsf(sum - light) < 1e-5f * (1.0f + light));
            const float other = ((const float *)slot[5].pixels)[3 * p + c];
            const float *ranks = (const float *)materials.pixels + 4 * p;
            const float lamp = memcmp(&ranks[0], &id, sizeof id) == 0   ? ranks[1]
                               : memcmp(&ranks[2], &id, sizeof id) == 0 ? ranks[3]
                                                                        : 0.0f;
            if (fabsf(other - 6.0f * lamp) > 1e-4f * (1.0f + light))
                fail_msg("pixel %d: other light %g where %g of it is the lamp", p, (double)other, (double)lamp);
        }
    assert_true(all[0] > 50.0 && all[1] > 1.0 && all[2] > 1.0 && all[3] > 1.0 && all[4] == 0.0 && all[5] > 10.0);
    for (int k = 0; k < 6; k++) weft_image_free(&slot[k]);
    weft_image_free(&materials);
    weft_image_free(&image);
    weft_render_free(r);
    weft_scene_free(scene);
}

/* Returns the mean light of a ball with an additive sheen, all of it or of one AOV. */
static double sheen_ball(float base, int aov) {
    WeftScene *scene = test_scene();
    Material *ball = test_material(scene, base);
    test_color(ball, INPUT_sheen_color, 0.5f);
    ball->inputs[INPUT_sheen_roughness].value[0] = 0.6f;
    material_choose(ball, CHOICE_layer, LAYER_ADDITIVE);
    test_sphere(scene, vec3(0, 0, 0), 1);
    test_environment(scene, 1.0f);
    scene_bounds(scene);
    WeftRender *r = rendered(scene, 2);
    WeftImage image;
    double sum = 0.0;
    if (aov >= 0)
        image = aov_of(r, (WeftAov)aov);
    else
        assert_int_equal(weft_render_image(r, &image, NULL), WEFT_OK);
    const int channels = image.channels;
    for (int p = 0; p < WIDTH * HEIGHT; p++) {
        const float *pixel = (const float *)image.pixels + channels * p;
        sum += (double)(pixel[1] * (aov < 0 ? pixel[3] : 1.0f));
    }
    weft_image_free(&image);
    weft_render_free(r);
    weft_scene_free(scene);
    return sum / (WIDTH * HEIGHT);
}

/* Where a sheen only adds, its light is that of the same sheen on black. */
static void light_of_a_slot_is_that_of_its_lobe(void **state) {
    (void)state;
    const double alone = sheen_ball(0.0f, -1), beside = sheen_ball(0.5f, WEFT_AOV_SHEEN),
                 under = sheen_ball(0.5f, WEFT_AOV_DIFFUSE), whole = sheen_ball(0.5f, -1);
    if (fabs(beside / alone - 1.0) > 0.02) fail_msg("sheen %g, and alone it is %g", beside, alone);
    assert_true(fabs((beside + under) / whole - 1.0) < 1e-4 && under > beside);
}

static void slots_of_an_environment_in_parts_are_refused(void **state) {
    (void)state;
    WeftScene *scene = slotted_scene();
    WeftRenderDesc desc = {.width = WIDTH, .height = HEIGHT, .camera = "0,0,4;0,0,0;40"};
    WeftRender *r = NULL;
    WeftError error;
    weft_render_record(&desc, 1u << WEFT_AOV_COAT);
    assert_int_equal(weft_scene_set_environment_parts(scene, 0.5f, 1.0f, NULL), WEFT_OK);
    assert_int_equal(weft_render_create(scene, &desc, &r, &error), WEFT_USAGE);
    assert_non_null(strstr(error.text, "ambient"));
    weft_scene_free(scene);
}

static void layers_that_were_not_gathered_are_refused(void **state) {
    (void)state;
    WeftScene *scene = quads();
    const WeftRenderDesc desc = {.width = WIDTH, .height = HEIGHT, .camera = "0,0,4;0,0,0;40", .first_hits = 1};
    WeftRender *r = NULL;
    WeftRenderLayers layers;
    WeftError error;
    assert_int_equal(weft_render_create(scene, &desc, &r, &error), WEFT_OK);
    assert_int_equal(weft_render_layers(r, 1u << WEFT_AOV_ALBEDO | 1u << WEFT_AOV_OBJECT, &layers, &error), WEFT_USAGE);
    assert_int_equal(error.message, WEFT_MESSAGE_DESC);
    assert_null(layers.layers);
    assert_int_equal(weft_render_layers(r, 1u << WEFT_AOV_POSITION, &layers, &error), WEFT_USAGE);
    assert_int_equal(weft_render_layers(r, 0, &layers, &error), WEFT_OK);
    assert_int_equal(layers.layer_count, 0);
    weft_render_layers_free(&layers);
    weft_render_free(r);
    assert_int_equal(weft_render_create(scene, &(WeftRenderDesc){.mattes = 1}, &r, &error), WEFT_USAGE);
    weft_scene_free(scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ids_are_those_of_the_specification),
        cmocka_unit_test(ranks_are_sorted_and_bounded),
        cmocka_unit_test(mattes_cover_what_the_picture_covers),
        cmocka_unit_test(places_are_those_of_the_surface),
        cmocka_unit_test(aovs_are_the_same_on_any_threads_and_change_no_byte),
        cmocka_unit_test(light_of_slots_adds_up_to_the_picture),
        cmocka_unit_test(light_of_a_slot_is_that_of_its_lobe),
        cmocka_unit_test(slots_of_an_environment_in_parts_are_refused),
        cmocka_unit_test(layers_that_were_not_gathered_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
