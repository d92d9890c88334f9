/* Panes of thin, smooth glass in the path tracer: what lights and lamps behind them leave on a floor, that no light counts
 * twice and none is made, and that other glass hides lights as before
 *
 * Labels: unsanitized */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "panes.h"
#include "shading/material/choice.h"
#include "weft/weft.h"

static const float white[3] = {1.0f, 1.0f, 1.0f};

static const WeftRenderDesc seen = {.width = 16, .height = 16, .camera = PANE_CAMERA, .max_depth = 1};

static void means_of(WeftScene *scene, WeftRenderDesc desc, int spp, double mean[3]) {
    WeftImage image = test_render(scene, desc, spp);
    pane_means(&image, mean);
    weft_image_free(&image);
    weft_scene_free(scene);
}

/* Compares a floor under `panes` tinted sheets with a bare one, by their direct light. */
static void floor_has_tinted_light(void (*light)(WeftScene *), double cosine, int panes, const char *what) {
    double mean[2][3];
    for (int k = 0; k < 2; k++) {
        WeftScene *scene = pane_floor();
        for (int pane = 0; k && pane < panes; pane++) {
            pane_material(scene, pane_tint, 0.0f, 0.0f);
            pane_put(scene, 1.0f + 0.1f * (float)pane);
        }
        light(scene);
        means_of(scene, seen, 256, mean[k]);
    }
    for (int c = 0; c < 3; c++) {
        const double part = mean[1][c] / mean[0][c], expected = pow(pane_clear(cosine) * (double)pane_tint[c], panes);
        print_message("%s, %d panes, channel %d: %.4f of the light, %.4f expected\n", what, panes, c, part, expected);
        if (!(fabs(part / expected - 1.0) < 0.01)) fail_msg("%s: %g for %g", what, part, expected);
    }
}

static void a_sun_shines_through_panes(void **state) {
    (void)state;
    floor_has_tinted_light(pane_sun, 0.8, 1, "sun");
    floor_has_tinted_light(pane_sun, 0.8, 2, "sun");
}

static void a_lamp_shines_through_panes(void **state) {
    (void)state;
    floor_has_tinted_light(pane_lamp, 1.0, 1, "lamp");
    floor_has_tinted_light(pane_lamp, 1.0, 2, "lamp");
}

/* Profiles that draw glass do not differ by what gets through, whatever their least roughness: within what Babylon.js,
 * which takes F0 twice, and fits of the split sum leave. */
static void a_sun_shines_through_panes_of_each_engine(void **state) {
    (void)state;
    static const char *const names[] = {"khronos", "three", "babylon", "filament-sheen", "openpbr"};
    double mean[3], bare[3];
    for (size_t k = 0; k <= sizeof names / sizeof *names; k++) {
        WeftScene *scene = pane_floor();
        if (k) {
            Material *glass = pane_material(scene, white, 0.0f, 0.0f);
            glass->choices[CHOICE_profile] = choice_find(CHOICE_profile, names[k - 1]);
            glass->inputs[INPUT_sheen].value[0] = 0.0f;
            pane_put(scene, 1.0f);
        }
        pane_sun(scene);
        means_of(scene, seen, 64, k ? mean : bare);
        if (k) print_message("%s: %.4f of the light\n", names[k - 1], mean[0] / bare[0]);
        if (k && !(mean[0] / bare[0] > 0.88 && mean[0] / bare[0] < 0.98)) fail_msg("%s", names[k - 1]);
    }
}

/* Rough, rippled and solid glass hide a sun, and so does what is under a sheen, whose transmittance is not that of glass
 * alone. */
static void other_glass_hides_a_sun(void **state) {
    (void)state;
    for (int k = 0; k < 4; k++) {
        double mean[3];
        WeftImage map;
        WeftScene *scene = pane_floor();
        Material *glass = pane_material(scene, white, k == 0 ? 0.2f : 0.0f, k == 1 ? 0.1f : 0.0f);
        if (k == 2) test_color(glass, INPUT_sheen_color, 0.5f);
        if (k == 3) {
            assert_int_equal(weft_image_create(1, 1, 3, WEFT_PIXEL_U8, &map, NULL), WEFT_OK);
            memcpy(map.pixels, (const unsigned char[]){128, 128, 255}, 3);
            glass->inputs[INPUT_normal].texture = weft_scene_add_texture(scene, &map, NULL);
        }
        pane_put(scene, 1.0f);
        pane_sun(scene);
        means_of(scene, seen, 16, mean);
        assert_true(mean[0] < 1e-6);
    }
}

/* A pane with a map of transmission, one half of it clear: the sun lights what is under that half. */
static void a_map_of_transmission_hides_a_part(void **state) {
    (void)state;
    WeftScene *scene = pane_floor();
    Material *glass = pane_material(scene, white, 0.0f, 0.0f);
    WeftImage map;
    double mean[3];
    assert_int_equal(weft_image_create(2, 1, 1, WEFT_PIXEL_U8, &map, NULL), WEFT_OK);
    ((unsigned char *)map.pixels)[0] = 0;
    ((unsigned char *)map.pixels)[1] = 255;
    glass->inputs[INPUT_transmission].texture = weft_scene_add_texture(scene, &map, NULL);
    scene->textures[0].nearest = true;
    test_sheet(scene, vec3(-3, 1, 3), vec3(6, 0, 0), vec3(0, 0, -6));
    test_sun(scene, vec3(0, -1, 0), PI_FLOAT);
    scene_bounds(scene);
    means_of(scene, seen, 64, mean);
    print_message("half of a pane is clear: %.4f\n", mean[0]);
    assert_true(fabs(mean[0] / (0.5 * 0.5 * pane_clear(1.0)) - 1.0) < 0.02);
}

/* A glossy floor under a pane, a lamp and an even sky: samples of lights, of lobes and of both find the same direct light. */
static void strategies_agree_behind_a_pane(void **state) {
    (void)state;
    double mean[3][3];
    for (int s = 0; s < 3; s++) {
        WeftScene *scene = pane_floor();
        scene->materials[0].inputs[INPUT_specular].value[0] = 1.0f;
        scene->materials[0].inputs[INPUT_roughness].value[0] = 0.4f;
        test_environment(scene, 0.3f);
        pane_material(scene, pane_tint, 0.0f, 0.0f);
        pane_put(scene, 1.0f);
        pane_lamp(scene);
        WeftRenderDesc desc = seen;
        desc.sampling = (WeftSampling)s;
        means_of(scene, desc, s == WEFT_SAMPLING_LOBE ? 16384 : 2048, mean[s]);
        print_message("strategy %d: %.4f %.4f %.4f\n", s, mean[s][0], mean[s][1], mean[s][2]);
    }
    for (int s = 1; s < 3; s++)
        for (int c = 0; c < 3; c++) assert_true(fabs(mean[s][c] / mean[0][c] - 1.0) < 0.01);
}

/* White panes under radiance 1, a ball in a ball: from afar, and a matt white floor below some, all is 1. */
static void white_panes_vanish(void **state) {
    (void)state;
    for (int parts = 0; parts < 2; parts++) {
        double mean[3];
        WeftScene *scene = test_scene();
        test_environment(scene, 1.0f);
        if (parts) {
            test_material(scene, 1.0f);
            test_quad(scene, vec3(-4, -2, 4), vec3(8, 0, 0), vec3(0, 0, -8));
        }
        pane_material(scene, white, 0.0f, 0.0f);
        test_sphere(scene, vec3(0, 0, 0), 1.0f);
        test_sphere(scene, vec3(0, 0, 0), 0.5f);
        scene_bounds(scene);
        const WeftRenderDesc desc = {.width = 32, .height = 32, .camera = "0,0.5,3;0,-0.5,0;40", .max_depth = 400};
        means_of(scene, desc, 256, mean);
        print_message("white panes%s: 1 %+.1e\n", parts ? " over a white floor" : "", mean[0] - 1.0);
        assert_true(fabs(mean[0] - 1.0) < 2e-3);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_sun_shines_through_panes),
        cmocka_unit_test(a_lamp_shines_through_panes),
        cmocka_unit_test(a_sun_shines_through_panes_of_each_engine),
        cmocka_unit_test(other_glass_hides_a_sun),
        cmocka_unit_test(a_map_of_transmission_hides_a_part),
        cmocka_unit_test(strategies_agree_behind_a_pane),
        cmocka_unit_test(white_panes_vanish),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
