/* The parts of the light sum up to all of it, under every kind of light and for the whole catalogue; what is
 * no light is shown as it is; a crop is drawn as it is in the whole picture.
 *
 * Labels: slow unsanitized */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "raster/gl.h"
#include "shading/cases.h"
#include "trace/scenes.h"

enum { SIDE = 32 };

static const WeftRasterView view = {.width = SIDE,
                                    .height = SIDE,
                                    .samples = 1,
                                    .camera = "0,0.9,3;0,0,0;24",
                                    .background = WEFT_BACKGROUND_TRANSPARENT};

/* A ball that has something in each slot, under sun, polygon and a sky with a bright patch. */
static WeftScene *dusty_ball(void) {
    const WeftLight sun = {.direction = {-0.4f, -1.0f, -0.3f}, .color = {1.0f, 0.9f, 0.8f}};
    const WeftLight panel = {.kind = WEFT_LIGHT_POLYGON,
                             .position = {1.0f, 1.0f, 1.0f},
                             .direction = {-1.0f, -1.0f, -1.0f},
                             .color = {2.0f, 2.0f, 3.0f},
                             .size = {1.0f, 1.0f}};
    WeftScene *scene = test_scene();
    WeftImage sky;
    Material *ball = test_material(scene, 0.4f);
    ball->inputs[INPUT_specular].value[0] = 0.9f;
    ball->inputs[INPUT_roughness].value[0] = 0.4f;
    ball->inputs[INPUT_clearcoat].value[0] = 0.6f;
    ball->inputs[INPUT_clearcoat_roughness].value[0] = 0.2f;
    ball->inputs[INPUT_dust].value[0] = 0.5f;
    test_color(ball, INPUT_sheen_color, 0.6f);
    ball->inputs[INPUT_sheen_roughness].value[0] = 0.5f;
    test_sphere(scene, vec3(0.0f, 0.0f, 0.0f), 0.5f);
    scene_bounds(scene);
    assert_int_equal(weft_image_create(64, 32, 3, WEFT_PIXEL_F32, &sky, NULL), WEFT_OK);
    for (int k = 0; k < 64 * 32 * 3; k++)
        ((float *)sky.pixels)[k] = k / 3 % 64 > 10 && k / 3 % 64 < 16 && k / 192 > 5 && k / 192 < 9 ? 9.0f : 0.3f;
    weft_image_free(&scene->environment.image);
    scene->environment.image = sky;
    scene->environment.kind = ENVIRONMENT_IMAGE;
    assert_int_equal(weft_scene_add_light(scene, &sun, NULL), WEFT_OK);
    assert_int_equal(weft_scene_add_light(scene, &panel, NULL), WEFT_OK);
    return scene;
}

static WeftRaster *raster_of(const WeftScene *scene) {
    WeftRaster *raster;
    WeftError error;
    if (weft_raster_create(scene, &(WeftRasterDesc){.threads = 2}, &raster, NULL, &error) != WEFT_OK)
        fail_msg("%s", error.text);
    return raster;
}

static WeftImage drawn(WeftRaster *raster, const WeftRasterView *how) {
    WeftImage image = {0};
    WeftError error;
    if (weft_raster_draw(raster, how, &error) != WEFT_OK || weft_raster_image(raster, &image, &error) != WEFT_OK)
        fail_msg("%s", error.text);
    return image;
}

static WeftImage part_of(WeftRaster *raster, int part) {
    WeftRasterView how = view;
    how.part = (WeftPart)part;
    return drawn(raster, &how);
}

/* A part under that many times the environment's own factors: none, its own, and other ones. */
enum { FACTORS = 3 };

static void scaled_parts(WeftScene *scene, WeftRaster *raster, int part, WeftImage image[FACTORS]) {
    static const float factors[FACTORS][2] = {{0.0f, 0.0f}, {1.0f, 1.0f}, {0.25f, 3.0f}};
    for (int k = 0; k < FACTORS; k++) {
        assert_int_equal(weft_scene_set_environment_parts(scene, factors[k][0], factors[k][1], NULL), WEFT_OK);
        assert_int_equal(weft_raster_update(raster, NULL, NULL), WEFT_OK);
        image[k] = part_of(raster, part);
    }
}

/* Light that is near does not change. */
static void part_is_scaled(const WeftImage image[FACTORS], int part, const char *name) {
    const float factor = part == WEFT_PART_DIFFUSE || part == WEFT_PART_DUST ? 0.25f : 3.0f;
    const float *none = image[0].pixels, *plain = image[1].pixels, *scaled = image[2].pixels;
    for (int k = 0; k < SIDE * SIDE * 4; k++) {
        if (k % 4 == 3) continue;
        float due = none[k] + factor * (plain[k] - none[k]);
        if (!(fabsf(scaled[k] - due) <= 4e-3f * (due + plain[k]) + 1e-4f))
            fail_msg("%s: %s: pixel %d is %g, not %g", name, weft_part_name(part), k / 4, (double)scaled[k],
                     (double)due);
    }
}

/* The parts sum up to all light, and each is as the environment's factors scale it. A part has a program of its own,
 * which is asked for all of its pictures at once. */
static void parts_sum_up_and_are_scaled(WeftScene *scene, WeftRaster *raster, const char *name) {
    WeftImage all = part_of(raster, WEFT_PART_ALL);
    float sum[SIDE * SIDE * 4] = {0.0f}, most = 0.0f;
    for (int part = WEFT_PART_DIFFUSE; part <= WEFT_PART_DUST; part++) {
        WeftImage image[FACTORS];
        scaled_parts(scene, raster, part, image);
        part_is_scaled(image, part, name);
        for (int k = 0; k < SIDE * SIDE * 4; k++) sum[k] += ((float *)image[1].pixels)[k];
        for (int k = 0; k < FACTORS; k++) weft_image_free(&image[k]);
    }
    const float *is = all.pixels;
    for (int k = 0; k < SIDE * SIDE * 4; k++) {
        if (k % 4 == 3) continue;
        most = fmaxf(most, is[k]);
        if (!(fabsf(sum[k] - is[k]) <= 3e-3f * is[k] + 1e-4f)) /* pictures are of 16 bits */
            fail_msg("%s: pixel %d: parts %g, all %g", name, k / 4, (double)sum[k], (double)is[k]);
    }
    assert_true(most > 0.1f);
    weft_image_free(&all);
    assert_int_equal(weft_scene_set_environment_parts(scene, 1.0f, 1.0f, NULL), WEFT_OK);
    assert_int_equal(weft_raster_update(raster, NULL, NULL), WEFT_OK);
}

/* A choice's values, from the first one on. */
static void choices_sum_up(WeftScene *scene, WeftRaster *raster, const char *choice, int first, int step) {
    int index = 0;
    char target[32], name[96];
    WeftError error;
    while (strcmp(weft_material_choice_name(index), choice) != 0) index++;
    snprintf(target, sizeof target, "0.%s", choice);
    for (int k = first; weft_material_choice_value(index, k); k += step) {
        const char *value = weft_material_choice_value(index, k);
        if (weft_scene_set(scene, target, value, NULL, &error) != WEFT_OK) continue; /* a reference's own */
        if (weft_raster_update(raster, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
        snprintf(name, sizeof name, "%s %s", choice, value);
        parts_sum_up_and_are_scaled(scene, raster, name);
    }
    assert_int_equal(weft_scene_set(scene, target, "auto", NULL, &error), WEFT_OK);
}

static void parts_of_every_stack_sum_to_the_whole(void **state) {
    (void)state;
    need_gl();
    static const char *const choices[] = {"layer", "sheen_lobe", "profile", "workflow", "diffuse"};
    WeftScene *scene = dusty_ball();
    WeftRaster *raster = raster_of(scene);
    static const int few[] = {LAYER_SEED, LOBE_CHARLIE_KHRONOS}; /* a shader takes seconds to compile */
    for (int k = 0; k < (test_long() ? 5 : test_short() ? 1 : 2); k++)
        choices_sum_up(scene, raster, choices[k], test_long() ? 0 : few[k], test_long() ? 1 : 100);
    weft_raster_free(raster);
    weft_scene_free(scene);
}

/* Of what the picture covers, not of what is behind. */
static double mean_of(const WeftImage *image) {
    double sum = 0.0;
    const float *p = image->pixels;
    for (int k = 0; k < SIDE * SIDE * 4; k++) sum += k % 4 == 3 ? 0.0 : (double)(p[k] * p[k - k % 4 + 3]);
    return sum / (3.0 * SIDE * SIDE);
}

/* What of the sky is ambient light and what is reflections is the same in the path tracer. */
static void parts_of_the_environment_are_those_of_the_path_tracer(void **state) {
    (void)state;
    need_gl();
    static const float factors[2][2] = {{1.0f, 0.0f}, {0.0f, 1.0f}};
    WeftScene *scene = dusty_ball();
    WeftError error;
    for (int k = 0; k < 2; k++) assert_int_equal(weft_scene_remove_light(scene, 0, &error), WEFT_OK);
    WeftRaster *raster = raster_of(scene);
    for (int k = 0; k < 2; k++) {
        assert_int_equal(weft_scene_set_environment_parts(scene, factors[k][0], factors[k][1], &error), WEFT_OK);
        assert_int_equal(weft_raster_update(raster, NULL, &error), WEFT_OK);
        WeftImage one = part_of(raster, WEFT_PART_ALL);
        WeftImage true_one = test_render(
            scene,
            (WeftRenderDesc){
                .width = SIDE, .height = SIDE, .camera = view.camera, .background = WEFT_BACKGROUND_TRANSPARENT},
            64);
        double is = mean_of(&one), due = mean_of(&true_one);
        if (!(fabs(is / due - 1.0) < 0.03)) fail_msg("factors %d: %g, traced %g", k, is, due);
        weft_image_free(&one);
        weft_image_free(&true_one);
    }
    weft_raster_free(raster);
    weft_scene_free(scene);
}

/* Beside emission, which no part has. */
static void emission_belongs_to_no_part(void **state) {
    (void)state;
    need_gl();
    WeftScene *scene = dusty_ball();
    test_color(&scene->materials[0], INPUT_emission, 4.0f);
    WeftRaster *raster = raster_of(scene);
    WeftImage all = part_of(raster, WEFT_PART_ALL), diffuse = part_of(raster, WEFT_PART_DIFFUSE);
    size_t middle = 4 * (SIDE / 2 * SIDE + SIDE / 2);
    assert_true(((float *)all.pixels)[middle] > 4.0f);
    assert_true(((float *)diffuse.pixels)[middle] < 1.0f && ((float *)diffuse.pixels)[middle] > 0.0f);
    weft_image_free(&all);
    weft_image_free(&diffuse);
    weft_raster_free(raster);
    weft_scene_free(scene);
}

static void shows(WeftRaster *raster, int part, int x, int y, float r, float g, float b) {
    WeftImage image = part_of(raster, part);
    const float *p = (const float *)image.pixels + 4 * (y * SIDE + x), expected[4] = {r, g, b, 1.0f};
    for (int c = 0; c < 4; c++)
        if (!(fabsf(p[c] - expected[c]) < 2e-3f))
            fail_msg("%s: channel %d is %g", weft_part_name(part), c, (double)p[c]);
    assert_float_equal(((float *)image.pixels)[3], 0.0f, 0.0f); /* behind is nothing */
    weft_image_free(&image);
}

static void property_views_show_the_inputs(void **state) {
    (void)state;
    need_gl();
    static const float corners[8] = {1.25f, 3.5f, 1.25f, 3.5f, 1.25f, 3.5f, 1.25f, 3.5f};
    WeftScene *scene = test_scene();
    Material *material = test_material(scene, 0.5f);
    material->inputs[INPUT_base_color].value[1] = 1.0f;
    material->inputs[INPUT_roughness].value[0] = 0.35f;
    test_color(material, INPUT_sheen_color, 0.6f);
    material->inputs[INPUT_sheen_roughness].value[0] = 0.0f;
    Mesh *square = test_quad(scene, vec3(-0.3f, -0.3f, 0.0f), vec3(0.6f, 0.0f, 0.0f), vec3(0.0f, 0.6f, 0.0f));
    square->texcoord[0] = arena_array(&scene->arena, 1, sizeof corners);
    memcpy(square->texcoord[0], corners, sizeof corners);
    scene_bounds(scene);
    WeftRaster *raster = raster_of(scene);
    int at = SIDE / 2;
    shows(raster, WEFT_PART_BASE_COLOR, at, at, 0.5f, 1.0f, 0.5f);
    shows(raster, WEFT_PART_NORMAL, at, at, 0.5f, 0.5f, 1.0f);
    shows(raster, WEFT_PART_ROUGHNESS, at, at, 0.35f, 0.35f, 0.35f);
    shows(raster, WEFT_PART_SHEEN_COLOR, at, at, 0.6f, 0.6f, 0.6f);
    shows(raster, WEFT_PART_SHEEN_ROUGHNESS, at, at, 0.0f, 0.0f, 0.0f);
    shows(raster, WEFT_PART_TEXCOORD, at, at, 0.25f, 0.5f, 0.0f);
    assert_null(weft_part_name(-1));
    assert_null(weft_part_name(WEFT_PART_COUNT));
    weft_raster_free(raster);
    weft_scene_free(scene);
}

static void crop_is_a_part_of_the_picture(void **state) {
    (void)state;
    need_gl();
    WeftScene *scene = dusty_ball();
    WeftRaster *raster = raster_of(scene);
    WeftError error;
    WeftRasterView part = view;
    part.background = WEFT_BACKGROUND_COLOR;
    part.background_color[0] = 0.25f;
    part.samples = 4;
    WeftImage whole = drawn(raster, &part);
    const int crop[4] = {5, 9, 12, 8};
    memcpy(part.crop, crop, sizeof crop);
    WeftImage cropped = drawn(raster, &part);
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            const float *a = (const float *)whole.pixels + 4 * (y * SIDE + x);
            const float *b = (const float *)cropped.pixels + 4 * (y * SIDE + x);
            bool in = x >= 5 && x < 17 && y >= 9 && y < 17;
            if (fabsf(b[0] - (in ? a[0] : 0.25f)) > 0.0f)
                fail_msg("%d, %d: %g and %g", x, y, (double)a[0], (double)b[0]);
            const float wanted = in ? a[1] : 0.0f;
            assert_true(!(b[1] < wanted) && !(b[1] > wanted));
        }
    part.crop[2] = SIDE;
    assert_int_equal(weft_raster_draw(raster, &part, &error), WEFT_USAGE);
    part.crop[2] = 0;
    assert_int_equal(weft_raster_draw(raster, &part, &error), WEFT_USAGE);
    part = view;
    part.part = WEFT_PART_COUNT;
    assert_int_equal(weft_raster_draw(raster, &part, &error), WEFT_USAGE);
    weft_image_free(&whole);
    weft_image_free(&cropped);
    weft_raster_free(raster);
    weft_scene_free(scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(parts_of_every_stack_sum_to_the_whole),
                                       cmocka_unit_test(parts_of_the_environment_are_those_of_the_path_tracer),
                                       cmocka_unit_test(emission_belongs_to_no_part),
                                       cmocka_unit_test(property_views_show_the_inputs),
                                       cmocka_unit_test(crop_is_a_part_of_the_picture)};
    return cmocka_run_group_tests(tests, gl_begin, NULL);
}
