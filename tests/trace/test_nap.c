/* The nap of a fibre sheen: what numbers and maps say is what its lobe gets, in the directions meant
 *
 * Labels: unsanitized */
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>

#include <cmocka.h>

#include "base/pi.h"
#include "base/random.h"
#include "scene/record/tangents.h"
#include "scenes.h"
#include "shading/stack/layer.h"
#include "weft/weft.h"

#define DEGREES (PI_FLOAT / 180.0f)

/* A square seen from far above, x to the right and y up, in light from 50 degrees over the right. It wears a
 * black base under white fibres; the map, where there is one, is one texel. */
static WeftScene *square(const float *texel) {
    WeftScene *scene = test_scene();
    test_environment(scene, 0.0f);
    Material *material = test_material(scene, 0.0f);
    material->choices[CHOICE_sheen_lobe] = weft_lobe_find("fibre-walk");
    material->choices[CHOICE_layer] = LAYER_ADDITIVE;
    test_color(material, INPUT_sheen_color, 1.0f);
    material->inputs[INPUT_sheen_roughness].value[0] = 0.8f;
    material->inputs[INPUT_sheen_density].value[0] = 2.0f;
    Mesh *mesh = test_quad(scene, vec3(-1, -1, 0), vec3(2, 0, 0), vec3(0, 2, 0));
    static const float uv[8] = {0, 1, 1, 1, 1, 0, 0, 0}; /* v runs down */
    mesh->texcoord[0] = arena_array(&scene->arena, 4, 2 * sizeof(float));
    memcpy(mesh->texcoord[0], uv, sizeof uv);
    float s = sinf(50.0f * DEGREES), c = cosf(50.0f * DEGREES);
    scene->lights[scene->light_count++] = (Light){.name = "",
                                                  .kind = LIGHT_DIRECTIONAL,
                                                  .direction = {-s, 0.0f, -c},
                                                  .color = {1.0f, 1.0f, 1.0f},
                                                  .intensity = 1.0f};
    if (!texel) return scene;
    scene->images = arena_array(&scene->arena, 1, sizeof *scene->images);
    scene->textures = arena_array(&scene->arena, 1, sizeof *scene->textures);
    assert_int_equal(weft_image_create(1, 1, 3, WEFT_PIXEL_F32, &scene->images[0], NULL), WEFT_OK);
    memcpy(scene->images[0].pixels, texel, 3 * sizeof *texel);
    scene->image_count = scene->texture_count = 1;
    material->inputs[INPUT_nap].texture = material->inputs[INPUT_nap_direction].texture = 1;
    material->inputs[INPUT_nap].channel = 2;
    return scene;
}

static Material *lean(WeftScene *scene, float nap, float direction) {
    Material *material = &scene->materials[0];
    material->inputs[INPUT_nap].value[0] = nap * DEGREES;
    material->inputs[INPUT_nap_direction].value[0] = direction * DEGREES;
    return material;
}

/* The mean radiance of its middle. */
static double seen_by(WeftScene *scene, const char *camera) {
    enum { SIDE = 32 };
    assert_int_equal(tangents_complete(scene, NULL), WEFT_OK);
    WeftImage image = test_render(scene, (WeftRenderDesc){.camera = camera, .width = SIDE, .height = SIDE}, 16);
    double sum = 0.0;
    for (int k = 0; k < SIDE * SIDE; k++) sum += (double)((const float *)image.pixels)[4 * k] / (SIDE * SIDE);
    weft_image_free(&image);
    return sum;
}

static double seen(WeftScene *scene) { return seen_by(scene, "0,0,50;0,0,0;1"); }

static double seen_and_freed(WeftScene *scene) {
    double mean = seen(scene);
    weft_scene_free(scene);
    return mean;
}

/* f cos of the lobe with those parameters, the mean over directions about that of the camera. */
static double of_the_lobe(float tilt, float azimuth) {
    enum { COUNT = 20000 };
    WeftLobe lobe;
    assert_int_equal(weft_lobe_init("fibre-walk", &lobe, NULL), WEFT_OK);
    static const char *const names[] = {"alpha", "density", "tilt", "azimuth"};
    const float values[] = {0.64f, 2.0f, tilt * DEGREES, azimuth * DEGREES};
    const WeftLobeInfo *info = weft_lobe_info(lobe.lobe);
    for (int k = 0; k < 4; k++) {
        assert_string_equal(info->params[k].name, names[k]);
        lobe.params[k] = values[k];
    }
    uint64_t stream = stream_start(5, 0);
    const float wi[3] = {sinf(50.0f * DEGREES), 0.0f, cosf(50.0f * DEGREES)};
    double sum = 0.0;
    for (int k = 0; k < COUNT; k++) {
        float x = 1e-3f * unit_float((uint32_t)(stream_next(&stream) >> 32));
        float y = 1e-3f * unit_float((uint32_t)(stream_next(&stream) >> 32)), f[3];
        weft_lobe_eval(&lobe, (const float[3]){x, y, sqrtf(1.0f - x * x - y * y)}, wi, f);
        sum += (double)(f[0] * wi[2]) / COUNT;
    }
    return sum;
}

static void near(double value, double expected, double share) {
    if (!(fabs(value - expected) < share * expected)) fail_msg("%g is not %g", value, expected);
}

/* Fibres that lean from the light are brighter by far, and the picture is the lobe's mean in the direction of
 * the world that is meant. */
static void nap_numbers_reach_the_lobe(void **state) {
    (void)state;
    double bright = 0.0, dark = 0.0;
    for (int k = 0; k < 4; k++) {
        WeftScene *scene = square(NULL);
        lean(scene, 40.0f, 90.0f * (float)k);
        double mean = seen_and_freed(scene);
        near(mean, of_the_lobe(40.0f, 90.0f * (float)k), 0.04);
        if (k == 0) dark = mean;
        if (k == 2) bright = mean;
    }
    if (!(bright > 2.0 * dark)) fail_msg("%g beside %g", bright, dark);
}

/* Half of 60 degrees, towards 90 of the map and 45 more. */
static void nap_map_scales_and_turns_the_nap(void **state) {
    (void)state;
    WeftScene *scene = square((const float[3]){0.5f, 1.0f, 0.5f});
    lean(scene, 60.0f, 45.0f);
    near(seen_and_freed(scene), of_the_lobe(30.0f, 135.0f), 0.04);
}

/* Rotating the map by 90 degrees rotates nap_direction by 90. */
static void turned_nap_map_equals_a_turned_direction(void **state) {
    (void)state;
    const float c = 0.5f * cosf(0.4f), s = 0.5f * sinf(0.4f);
    WeftScene *map = square((const float[3]){0.5f - s, 0.5f + c, 1.0f}), /* (c, s) turned: (-s, c) */
        *added = square((const float[3]){0.5f + c, 0.5f + s, 1.0f}),
              *neither = square((const float[3]){0.5f + c, 0.5f + s, 1.0f});
    lean(map, 40.0f, 0.0f);
    lean(added, 40.0f, 90.0f);
    lean(neither, 40.0f, 0.0f);
    double turned = seen_and_freed(map), expected = seen_and_freed(added);
    near(turned, expected, 0.01);
    assert_true(turned > 1.3 * seen_and_freed(neither));
}

/* The nap is told from the surface's tangent, also where the highlight below is drawn out elsewhere. */
static void anisotropy_direction_does_not_turn_the_nap(void **state) {
    (void)state;
    WeftScene *scene = square(NULL);
    Material *material = lean(scene, 40.0f, 180.0f);
    double expected = seen(scene);
    material->inputs[INPUT_anisotropy].value[0] = 0.5f;
    material->inputs[INPUT_anisotropy_direction].value[0] = 70.0f * DEGREES;
    near(seen_and_freed(scene), expected, 0.04);
}

/* A map without nap, and a sheen without fibres, stay as they are. */
static void lobe_without_nap_does_not_lean(void **state) {
    (void)state;
    WeftScene *scene = square((const float[3]){0.5f, 1.0f, 0.0f});
    lean(scene, 45.0f, 0.0f);
    near(seen_and_freed(scene), of_the_lobe(0.0f, 0.0f), 0.04);
    for (int k = 0; k < 2; k++) {
        scene = square(NULL);
        Material *material = lean(scene, 0.0f, 0.0f);
        material->choices[CHOICE_sheen_lobe] = weft_lobe_find(k ? "charlie-neubelt" : "threads");
        double expected = seen(scene);
        lean(scene, 40.0f, 30.0f);
        assert_true(fabs(seen_and_freed(scene) - expected) <= 0.0);
    }
}

/* White fibres over a white base in white light, seen from 11 degrees over the right: along, between and
 * against the nap, by numbers and by a map. tests/shading/test_leaning has the figures. */
static void white_base_under_a_nap_stays_white(void **state) {
    (void)state;
    for (int k = 0; k < 4; k++) {
        bool map = k % 2 == 1;
        WeftScene *scene = square(map ? (const float[3]){0.5f, 1.0f, 0.5f} : NULL);
        scene->light_count = 0;
        test_environment(scene, 1.0f);
        Material *material = lean(scene, map ? 80.0f : 40.0f, 60.0f * (float)k - (map ? 90.0f : 0.0f));
        material->choices[CHOICE_sheen_lobe] = weft_lobe_find("fibre");
        material->choices[CHOICE_layer] = LAYER_ALBEDO_VIEW;
        material->inputs[INPUT_sheen_roughness].value[0] = 0.71f;
        material->inputs[INPUT_sheen_density].value[0] = 1.0f;
        test_color(material, INPUT_base_color, 1.0f);
        double mean = seen_by(scene, "49,0,10;0,0,0;0.4");
        if (!(fabs(mean - 1.0) < 0.02)) fail_msg("%g at %d degrees", mean, 60 * k);
        weft_scene_free(scene);
    }
}

static void nap_is_set_in_degrees(void **state) {
    (void)state;
    WeftScene *scene = square((const float[3]){0.5f, 1.0f, 0.5f});
    const Input *inputs = scene->materials[0].inputs;
    WeftError error;
    assert_int_equal(weft_scene_set(scene, "*.nap", "40", NULL, &error), WEFT_OK);
    assert_int_equal(weft_scene_set(scene, "*.nap_direction", "-90", NULL, &error), WEFT_OK);
    assert_true(fabsf(inputs[INPUT_nap].value[0] - 40.0f * DEGREES) < 1e-6f && !inputs[INPUT_nap].texture);
    assert_true(fabsf(inputs[INPUT_nap_direction].value[0] + 90.0f * DEGREES) < 1e-6f);
    assert_int_equal(weft_scene_set(scene, "*.nap", "120", NULL, &error), WEFT_OK);
    assert_true(fabsf(inputs[INPUT_nap].value[0] - 90.0f * DEGREES) < 1e-6f);
    assert_int_equal(weft_scene_set(scene, "*.nap", "steep", NULL, &error), WEFT_USAGE);
    assert_int_equal(error.message, WEFT_MESSAGE_PARAM_VALUE);
    assert_int_equal(weft_scene_set(scene, "*.nap_tilt", "4", NULL, &error), WEFT_USAGE);
    assert_int_equal(error.message, WEFT_MESSAGE_PARAM_NAME);
    weft_scene_free(scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nap_numbers_reach_the_lobe),
        cmocka_unit_test(nap_map_scales_and_turns_the_nap),
        cmocka_unit_test(turned_nap_map_equals_a_turned_direction),
        cmocka_unit_test(anisotropy_direction_does_not_turn_the_nap),
        cmocka_unit_test(lobe_without_nap_does_not_lean),
        cmocka_unit_test(white_base_under_a_nap_stays_white),
        cmocka_unit_test(nap_is_set_in_degrees),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
