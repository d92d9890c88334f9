/* What is reflected of the environment can be scaled by kind of lobe, for every profile and every layer rule.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "scenes.h"

enum { SIDE = 16, SAMPLES = 4 };

/* Something in each slot, and behind it light that is not of the sky. */
static WeftScene *dusty_ball(void) {
    WeftScene *scene = test_scene();
    Material *ball = test_material(scene, 0.4f);
    ball->inputs[INPUT_specular].value[0] = 0.9f;
    ball->inputs[INPUT_clearcoat].value[0] = 0.6f;
    ball->inputs[INPUT_clearcoat_roughness].value[0] = 0.3f;
    ball->inputs[INPUT_dust].value[0] = 0.5f;
    test_color(ball, INPUT_sheen_color, 0.6f);
    ball->inputs[INPUT_sheen_roughness].value[0] = 0.5f;
    test_sphere(scene, vec3(0.0f, 0.0f, 0.0f), 0.5f);
    scene_bounds(scene);
    const WeftLight sun = {.direction = {-0.4f, -1.0f, -0.3f}, .color = {1.0f, 0.9f, 0.8f}};
    assert_int_equal(weft_scene_add_light(scene, &sun, NULL), WEFT_OK);
    return scene;
}

/* The same paths each time: what differs is the factors alone. */
static WeftImage traced(WeftScene *scene, float ambient, float reflection, WeftSampling sampling) {
    const WeftRenderDesc desc = {.width = SIDE,
                                 .height = SIDE,
                                 .camera = "0,0.9,3;0,0,0;18",
                                 .max_depth = 1,
                                 .sampling = sampling,
                                 .background = WEFT_BACKGROUND_TRANSPARENT};
    assert_int_equal(weft_scene_set_environment_parts(scene, ambient, reflection, NULL), WEFT_OK);
    return test_render(scene, desc, SAMPLES);
}

static void parts_add_up(WeftScene *scene, const char *name, WeftSampling sampling) {
    WeftImage none = traced(scene, 0.0f, 0.0f, sampling), ambient = traced(scene, 1.0f, 0.0f, sampling),
              reflection = traced(scene, 0.0f, 1.0f, sampling), all = traced(scene, 1.0f, 1.0f, sampling),
              scaled = traced(scene, 0.25f, 3.0f, sampling);
    const float *n = none.pixels, *a = ambient.pixels, *r = reflection.pixels, *p = all.pixels, *s = scaled.pixels;
    double sums[2] = {0.0, 0.0};
    for (int k = 0; k < SIDE * SIDE * 4; k++) {
        if (k % 4 == 3) continue;
        float due = n[k] + 0.25f * (a[k] - n[k]) + 3.0f * (r[k] - n[k]), slack = 2e-4f * (due + p[k]) + 1e-6f;
        if (!(fabsf(a[k] + r[k] - n[k] - p[k]) <= slack && fabsf(s[k] - due) <= slack))
            fail_msg("%s: pixel %d: %g + %g - %g is not %g, or %g not %g", name, k / 4, (double)a[k], (double)r[k],
                     (double)n[k], (double)p[k], (double)s[k], (double)due);
        sums[0] += (double)(a[k] - n[k]), sums[1] += (double)(r[k] - n[k]);
    }
    if (!(sums[0] > 0.1 && sums[1] > 0.1)) fail_msg("%s: sums %g, %g", name, sums[0], sums[1]);
    weft_image_free(&none);
    weft_image_free(&ambient);
    weft_image_free(&reflection);
    weft_image_free(&all);
    weft_image_free(&scaled);
}

static void ambient_light_and_reflection_sum_to_the_whole(void **state) {
    (void)state;
    static const char *const choices[] = {"profile", "layer"};
    WeftScene *scene = dusty_ball();
    int tried = 0;
    for (int c = 0; c < 2; c++) {
        int index = 0;
        char target[32];
        while (strcmp(weft_material_choice_name(index), choices[c]) != 0) index++;
        snprintf(target, sizeof target, "0.%s", choices[c]);
        for (int k = 0; weft_material_choice_value(index, k); k++, tried++) {
            const char *value = weft_material_choice_value(index, k);
            assert_int_equal(weft_scene_set(scene, target, value, NULL, NULL), WEFT_OK);
            parts_add_up(scene, value, WEFT_SAMPLING_MIS);
        }
        assert_int_equal(weft_scene_set(scene, target, "auto", NULL, NULL), WEFT_OK);
    }
    parts_add_up(scene, "light sampling", WEFT_SAMPLING_LIGHT);
    parts_add_up(scene, "lobe sampling", WEFT_SAMPLING_LOBE);
    assert_true(tried > 15);
    weft_scene_free(scene);
}

static double total(WeftScene *scene, float ambient, float reflection) {
    WeftImage image = traced(scene, ambient, reflection, WEFT_SAMPLING_MIS);
    const float *p = image.pixels;
    double sum = 0.0;
    for (int k = 0; k < SIDE * SIDE * 4; k++) sum += k % 4 == 3 ? 0.0 : (double)p[k];
    weft_image_free(&image);
    return sum;
}

/* A ball of a metal reflects and has no ambient light, one of lambert alone the other way round; whatever
 * engine draws it. A coat is neither's ambient light, and dust no reflection. */
static void each_lobe_belongs_to_ambient_light_or_reflection(void **state) {
    (void)state;
    static const struct Side {
        const char *metallic, *specular, *sheen_color, *clearcoat, *dust;
        bool reflects;
    } sides[] = {{"1", "1", "0.6", "0.6", "0", true}, {"0", "0", "0", "0", "0.5", false}};
    WeftScene *scene = dusty_ball();
    assert_int_equal(weft_scene_remove_light(scene, 0, NULL), WEFT_OK);
    int index = 0;
    while (strcmp(weft_material_choice_name(index), "layer") != 0) index++;
    for (int s = 0; s < 2; s++) {
        assert_int_equal(weft_scene_set(scene, "0.metallic", sides[s].metallic, NULL, NULL), WEFT_OK);
        assert_int_equal(weft_scene_set(scene, "0.specular", sides[s].specular, NULL, NULL), WEFT_OK);
        assert_int_equal(weft_scene_set(scene, "0.sheen_color", sides[s].sheen_color, NULL, NULL), WEFT_OK);
        assert_int_equal(weft_scene_set(scene, "0.clearcoat", sides[s].clearcoat, NULL, NULL), WEFT_OK);
        assert_int_equal(weft_scene_set(scene, "0.dust", sides[s].dust, NULL, NULL), WEFT_OK);
        for (int k = 0; weft_material_choice_value(index, k); k++) {
            const char *layer = weft_material_choice_value(index, k);
            assert_int_equal(weft_scene_set(scene, "0.layer", layer, NULL, NULL), WEFT_OK);
            double ambient = total(scene, 1.0f, 0.0f), reflection = total(scene, 0.0f, 1.0f);
            double due = sides[s].reflects ? reflection : ambient, none = ambient + reflection - due;
            if (!(due > 1.0 && none <= 1e-5 * due))
                fail_msg("%s: ambient %g, reflection %g", layer, ambient, reflection);
            assert_true(!(total(scene, 0.0f, 0.0f) > 0.0));
        }
    }
    weft_scene_free(scene);
}

static void environment_factors_without_sense_are_refused(void **state) {
    (void)state;
    WeftScene *scene = test_scene();
    WeftError error;
    assert_int_equal(weft_scene_set_environment_parts(scene, -1.0f, 1.0f, &error), WEFT_USAGE);
    assert_non_null(strstr(error.text, "ambient"));
    assert_int_equal(weft_scene_set_environment_parts(scene, 1.0f, NAN, &error), WEFT_USAGE);
    assert_non_null(strstr(error.text, "reflection"));
    weft_scene_free(scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(ambient_light_and_reflection_sum_to_the_whole),
                                       cmocka_unit_test(each_lobe_belongs_to_ambient_light_or_reflection),
                                       cmocka_unit_test(environment_factors_without_sense_are_refused)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
