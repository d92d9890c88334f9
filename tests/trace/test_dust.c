/* Dust in pictures: on what looks up in the world, whichever way the surface lies in its own frame */
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>

#include <cmocka.h>

#include "scenes.h"
#include "weft/weft.h"

enum { SIDE = 48 };

/* A black sphere about the origin in white light, seen from +z; white dust over it. */
static WeftScene *sphere(void) {
    WeftScene *scene = test_scene();
    test_environment(scene, 1.0f);
    Material *material = test_material(scene, 0.0f);
    test_color(material, INPUT_dust_color, 1.0f);
    test_sphere(scene, vec3(0, 0, 0), 1.0f);
    return scene;
}

static void set(WeftScene *scene, const char *target, const char *value) {
    WeftError error;
    if (weft_scene_set(scene, target, value, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
}

static WeftImage picture(WeftScene *scene) {
    WeftRenderDesc desc = {
        .camera = "0,0,40;0,0,0;2.6", .width = SIDE, .height = SIDE, .background = WEFT_BACKGROUND_COLOR};
    return test_render(scene, desc, 8);
}

/* The mean over a square of 6 x 6 pixels about a point of the sphere, of radius 22 pixels or so. */
static double seen(const WeftImage *image, int x, int y) {
    double sum = 0.0;
    for (int v = y - 3; v < y + 3; v++)
        for (int u = x - 3; u < x + 3; u++) sum += (double)((const float *)image->pixels)[4 * (v * SIDE + u)] / 36.0;
    return sum;
}

static double seen_of(WeftScene *scene, int x, int y) {
    WeftImage image = picture(scene);
    double mean = seen(&image, x, y);
    weft_image_free(&image);
    return mean;
}

static void dust_of_amount_zero_leaves_the_picture(void **state) {
    (void)state;
    WeftScene *scene = sphere();
    WeftImage clean = picture(scene);
    set(scene, "*.dust_noise", "1");
    set(scene, "*.dust_falloff", "2");
    WeftImage none = picture(scene);
    assert_memory_equal(clean.pixels, none.pixels, SIDE * SIDE * 4 * sizeof(float));
    weft_image_free(&clean);
    weft_image_free(&none);
    weft_scene_free(scene);
}

static void dust_lies_on_top(void **state) {
    (void)state;
    WeftScene *scene = sphere();
    set(scene, "*.dust", "1");
    WeftImage image = picture(scene);
    double top = seen(&image, 24, 10), middle = seen(&image, 24, 21), below = seen(&image, 24, 34);
    if (!(top > 0.7 && middle > 0.2 && middle < top && below < 1e-6))
        fail_msg("from the top: %g, %g, %g", top, middle, below);
    weft_image_free(&image);
    set(scene, "*.dust_falloff", "16"); /* off the slopes */
    assert_true(seen_of(scene, 24, 21) < 0.01);
    weft_scene_free(scene);
}

/* From above tilted over by 90 degrees towards +x, then towards +z, then from below. */
static void dust_lies_towards_its_given_direction(void **state) {
    (void)state;
    static const struct {
        const char *tilt, *direction;
        int dusty[2], bare[2];
    } cases[] = {{"90", "0", {38, 24}, {10, 24}},
                 {"90", "180", {10, 24}, {38, 24}},
                 {"90", "90", {24, 24}, {-1, -1}},
                 {"180", "0", {24, 38}, {24, 10}}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        WeftScene *scene = sphere();
        set(scene, "*.dust", "1");
        set(scene, "*.dust_tilt", cases[k].tilt);
        set(scene, "*.dust_direction", cases[k].direction);
        double dusty = seen_of(scene, cases[k].dusty[0], cases[k].dusty[1]);
        if (!(dusty > 0.7)) fail_msg("case %zu: %g", k, dusty);
        if (cases[k].bare[0] > 0) assert_true(seen_of(scene, cases[k].bare[0], cases[k].bare[1]) < 1e-6);
        weft_scene_free(scene);
    }
}

/* A sheet has dust on the side that looks up, and on that alone. */
static void sheet_is_dusty_on_its_upper_side(void **state) {
    (void)state;
    for (int below = 0; below < 2; below++) {
        WeftScene *scene = test_scene();
        test_environment(scene, 1.0f);
        Material *material = test_material(scene, 0.0f);
        test_color(material, INPUT_dust_color, 1.0f);
        material->inputs[INPUT_dust].value[0] = 1.0f;
        test_quad(scene, vec3(-1, 0, 1), vec3(2, 0, 0), vec3(0, 0, -2));
        WeftRenderDesc desc = {.camera = below ? "0,-9,1;0,0,0;4" : "0,9,1;0,0,0;4", .width = SIDE, .height = SIDE};
        WeftImage image = test_render(scene, desc, 4);
        double mean = seen(&image, 24, 24);
        assert_true(below ? mean < 1e-6 : mean > 0.7);
        weft_image_free(&image);
        weft_scene_free(scene);
    }
}

/* White dust on a white sphere, in patches: no more light comes back than came. */
static void dusty_white_sphere_in_a_furnace_stays_white(void **state) {
    (void)state;
    WeftScene *scene = sphere();
    test_color(&scene->materials[0], INPUT_base_color, 1.0f);
    set(scene, "*.dust", "0.6");
    set(scene, "*.dust_noise", "1");
    set(scene, "*.dust_scale", "0.3");
    assert_float_equal(seen_of(scene, 24, 12), 1.0, 0.02);
    assert_float_equal(seen_of(scene, 24, 24), 1.0, 0.02);
    weft_scene_free(scene);
}

/* The sheen times the y of the normal, of whatever lobe: none of it below. Dust, whose amount is
 * a number of layers, is thicker than that. */
static void sheen_on_what_faces_up_is_multiplied_by_the_normals_y(void **state) {
    (void)state;
    static const char *const lobes[] = {"charlie-neubelt", "exponential", "ltc-fibre", "cook-torrance"};
    for (size_t k = 0; k < sizeof lobes / sizeof *lobes; k++) {
        WeftScene *scene = sphere();
        test_color(&scene->materials[0], INPUT_sheen_color, 1.0f);
        set(scene, "*.sheen_roughness", "0.8");
        set(scene, "*.sheen_lobe", lobes[k]);
        WeftImage whole = picture(scene);
        set(scene, "*.sheen_upward", "1");
        WeftImage up = picture(scene);
        set(scene, "*.sheen_upward", "0.5");
        WeftImage half = picture(scene);
        const double y = 11.0 / 26.7, share = seen(&up, 24, 13) / seen(&whole, 24, 13); /* pixels, of a radius */
        print_message("%s: %.3f of the sheen where n.y is %.3f\n", lobes[k], share, y);
        assert_true(fabs(share - y) < 0.01);
        assert_true(fabs(seen(&up, 24, 4) / seen(&whole, 24, 4) - y * 20.0 / 11.0) < 0.01);
        assert_true(fabs(seen(&half, 24, 13) / seen(&whole, 24, 13) - 0.5 * (1.0 + y)) < 0.01);
        assert_true(seen(&up, 24, 35) < 1e-6 && seen(&whole, 24, 35) > 1e-3);
        set(scene, "*.sheen_upward", "1");
        set(scene, "*.dust_falloff", "2");
        assert_true(fabs(seen_of(scene, 24, 13) / seen(&whole, 24, 13) - y * y) < 0.01);
        weft_image_free(&whole);
        weft_image_free(&up);
        weft_image_free(&half);
        weft_scene_free(scene);
    }
}

/* Values beyond what is possible are clamped, angles are in degrees, colours may be three numbers. */
static void dust_values_are_set_by_name_and_clamped(void **state) {
    (void)state;
    WeftScene *scene = sphere();
    const Input *inputs = scene->materials[0].inputs;
    set(scene, "*.dust", "-1");
    assert_true(inputs[INPUT_dust].value[0] == 0.0f);
    set(scene, "*.dust", "7");
    assert_true(inputs[INPUT_dust].value[0] == 1.0f);
    set(scene, "*.dust_scale", "-1");
    assert_true(inputs[INPUT_dust_scale].value[0] > 0.0f);
    set(scene, "*.dust_falloff", "-1");
    assert_true(inputs[INPUT_dust_falloff].value[0] > 0.0f);
    set(scene, "*.dust_tilt", "45");
    set(scene, "*.dust_direction", "-90");
    assert_true(fabsf(inputs[INPUT_dust_tilt].value[0] - 0.78539816f) < 1e-6f);
    assert_true(fabsf(inputs[INPUT_dust_direction].value[0] + 1.57079633f) < 1e-6f);
    set(scene, "*.dust_color", "0.5,0.4,0.3");
    assert_true(inputs[INPUT_dust_color].value[2] == 0.3f);
    WeftError error;
    assert_int_equal(weft_scene_set(scene, "*.dust", "much", NULL, &error), WEFT_USAGE);
    assert_int_equal(error.message, WEFT_MESSAGE_PARAM_VALUE);
    weft_scene_free(scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(dust_of_amount_zero_leaves_the_picture),
        cmocka_unit_test(dust_lies_on_top),
        cmocka_unit_test(dust_lies_towards_its_given_direction),
        cmocka_unit_test(sheet_is_dusty_on_its_upper_side),
        cmocka_unit_test(dusty_white_sphere_in_a_furnace_stays_white),
        cmocka_unit_test(sheen_on_what_faces_up_is_multiplied_by_the_normals_y),
        cmocka_unit_test(dust_values_are_set_by_name_and_clamped),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
