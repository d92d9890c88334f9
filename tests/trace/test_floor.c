/* The floor catches what light is kept from it, and mirrors the scene; it changes nothing else. Lights can be
 * looked through. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "scene/record/camera.h"
#include "scenes.h"
#include "shading/ltc/polygon.h"

enum { SIDE = 8 };

/* A roof of 2 x 2 m, 1 m over the floor, which a speck holds in its place. */
static WeftScene *roof(void) {
    WeftScene *scene = test_scene();
    test_material(scene, 0.0f);
    test_quad(scene, vec3(-1.0f, 1.0f, 1.0f), vec3(2.0f, 0.0f, 0.0f), vec3(0.0f, 0.0f, -2.0f));
    test_quad(scene, vec3(0.0f, 0.0f, -0.99f), vec3(1e-3f, 0.0f, 0.0f), vec3(0.0f, 0.0f, -1e-3f));
    scene_bounds(scene);
    return scene;
}

static WeftRenderDesc seen_from(const char *camera) {
    return (WeftRenderDesc){.width = SIDE,
                            .height = SIDE,
                            .camera = camera,
                            .pixel_centre = 1,
                            .background = WEFT_BACKGROUND_TRANSPARENT,
                            .floor = {.on = 1}};
}

static const float *pixel(const WeftImage *image, int x, int y) {
    return (const float *)image->pixels + 4 * (image->width * y + x);
}

static void floor_shadow_of_a_roof_is_its_form_factor(void **state) {
    (void)state;
    WeftScene *scene = roof();
    test_environment(scene, 0.7f);
    Camera camera;
    assert_int_equal(camera_find(scene, "0,0.8,4;0,0,0;12", 1.0f, &camera, NULL), WEFT_OK);
    View view = view_of(&camera, 1.0f);
    WeftImage image = test_render(scene, seen_from("0,0.8,4;0,0,0;12"), 1024);
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            float u = ((float)x + 0.5f) / SIDE * 2.0f - 1.0f, v = 1.0f - ((float)y + 0.5f) / SIDE * 2.0f;
            CameraRay ray = view_ray(&view, u, v);
            Vec3 d = ray.direction, p = vec3_madd(ray.origin, d, -0.8f / d.y);
            if (!(d.y < -0.02f) || fabsf(p.z) > 2.0f) continue;
            Polygon roof = {.count = 4};
            for (int k = 0; k < 4; k++)
                roof.corners[k] = dir((k == 1 || k == 2 ? 1.0f : -1.0f) - p.x, (k > 1 ? 1.0f : -1.0f) - p.z, 1.0f);
            const float *c = pixel(&image, x, y);
            float due = polygon_cosine(roof);
            if (!(fabsf(c[3] - due) < 0.05f)) fail_msg("(%d, %d): %g, not %g", x, y, (double)c[3], (double)due);
            assert_true(c[0] < 1e-3f);
        }
    weft_image_free(&image);
    weft_scene_free(scene);
}

static void floor_shadow_of_the_sun_lies_under_the_roof_alone(void **state) {
    (void)state;
    WeftScene *scene = roof();
    const WeftLight sun = {.direction = {0.0f, -1.0f, 0.0f}, .color = {2.0f, 3.0f, 4.0f}};
    test_environment(scene, 0.0f);
    assert_int_equal(weft_scene_add_light(scene, &sun, NULL), WEFT_OK);
    WeftImage under = test_render(scene, seen_from("0,0.8,4;0,0,0;1"), 4);
    WeftImage beside = test_render(scene, seen_from("0,0.8,4;0,0,1.5;1"), 4);
    assert_float_equal(pixel(&under, 4, 4)[3], 1.0f, 1e-6f);
    assert_float_equal(pixel(&beside, 4, 4)[3], 0.0f, 1e-6f);
    weft_image_free(&under);
    weft_image_free(&beside);
    weft_scene_free(scene);
}

static void floor_shadow_darkens_a_coloured_background(void **state) {
    (void)state;
    WeftScene *scene = roof();
    test_environment(scene, 1.0f);
    WeftRenderDesc desc = seen_from("0,0.8,4;0,0,0;1");
    desc.background = WEFT_BACKGROUND_COLOR;
    for (int c = 0; c < 3; c++) desc.background_color[c] = 0.5f;
    WeftImage image = test_render(scene, desc, 1024);
    const float *c = pixel(&image, 4, 4);
    assert_float_equal(c[0], 0.5f * (1.0f - 0.5541f), 0.02f); /* four times the factor of a corner, 0.13853 */
    assert_float_equal(c[3], 1.0f, 1e-6f);
    weft_image_free(&image);
    weft_scene_free(scene);
}

static void mirror_of_the_floor_has_its_reflectance(void **state) {
    (void)state;
    WeftScene *scene = test_scene();
    test_color(test_material(scene, 0.0f), INPUT_emission, 2.0f);
    test_quad(scene, vec3(-1.0f, 0.0f, -1.0f), vec3(2.0f, 0.0f, 0.0f), vec3(0.0f, 2.0f, 0.0f));
    scene_bounds(scene);
    test_environment(scene, 0.0f);
    WeftRenderDesc desc = seen_from("0,0.8,4;0,0,1;1");
    desc.background = WEFT_BACKGROUND_COLOR;
    for (int c = 0; c < 3; c++) desc.background_color[c] = 1.0f;
    desc.floor.reflection = 0.5f;
    WeftImage image = test_render(scene, desc, 16);
    assert_float_equal(pixel(&image, 4, 4)[0], 0.5f * 2.0f + 0.5f * 1.0f, 1e-3f);
    weft_image_free(&image);
    weft_scene_free(scene);
}

static void floor_is_invisible_from_below_and_to_other_rays(void **state) {
    (void)state;
    WeftScene *scene = roof();
    test_environment(scene, 1.0f);
    test_color(&scene->materials[0], INPUT_base_color, 0.8f);
    WeftRenderDesc desc = seen_from("0,-2,2;0,1,0;10");
    WeftImage with = test_render(scene, desc, 8);
    desc.floor.on = 0;
    WeftImage without = test_render(scene, desc, 8);
    assert_memory_equal(with.pixels, without.pixels, sizeof(float) * 4 * SIDE * SIDE);
    weft_image_free(&with);
    weft_image_free(&without);
    weft_scene_free(scene);
}

static void floor_out_of_range_is_refused(void **state) {
    (void)state;
    WeftScene *scene = roof();
    WeftRender *render;
    WeftError error;
    WeftRenderDesc desc = seen_from(NULL);
    desc.floor.reflection = 1.5f;
    assert_int_equal(weft_render_create(scene, &desc, &render, &error), WEFT_USAGE);
    desc.floor = (WeftFloor){.on = 1, .roughness = NAN};
    assert_int_equal(weft_render_create(scene, &desc, &render, &error), WEFT_USAGE);
    weft_scene_free(scene);
}

static void hidden_light_is_invisible_and_shines(void **state) {
    (void)state;
    WeftScene *scene = test_scene();
    test_material(scene, 0.5f);
    test_quad(scene, vec3(-1.0f, 0.0f, 1.0f), vec3(2.0f, 0.0f, 0.0f), vec3(0.0f, 0.0f, -2.0f));
    scene_bounds(scene);
    test_environment(scene, 0.0f);
    const WeftLight lamp = {.kind = WEFT_LIGHT_POLYGON,
                            .position = {0.0f, 1.0f, 0.0f},
                            .direction = {0.0f, -1.0f, 0.0f},
                            .size = {1.0f, 1.0f},
                            .color = {5.0f, 5.0f, 5.0f}};
    assert_int_equal(weft_scene_add_light(scene, &lamp, NULL), WEFT_OK);
    WeftRenderDesc through = seen_from("0,0.5,0;0,1,0.01;10"), onto = seen_from("0,0.5,0;0,0,0.01;10");
    through.floor.on = onto.floor.on = 0;
    for (int hide = 0; hide < 2; hide++) {
        through.hide_lights = onto.hide_lights = hide;
        WeftImage light = test_render(scene, through, 4), lit = test_render(scene, onto, 64);
        assert_float_equal(pixel(&light, 4, 4)[0], (hide ? 0.0f : 5.0f), 1e-3f);
        assert_float_equal(pixel(&light, 4, 4)[3], (hide ? 0.0f : 1.0f), 1e-6f);
        assert_true(pixel(&lit, 4, 4)[0] > 0.2f);
        weft_image_free(&light);
        weft_image_free(&lit);
    }
    weft_scene_free(scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(floor_shadow_of_a_roof_is_its_form_factor),
        cmocka_unit_test(floor_shadow_of_the_sun_lies_under_the_roof_alone),
        cmocka_unit_test(floor_shadow_darkens_a_coloured_background),
        cmocka_unit_test(mirror_of_the_floor_has_its_reflectance),
        cmocka_unit_test(floor_is_invisible_from_below_and_to_other_rays),
        cmocka_unit_test(floor_out_of_range_is_refused),
        cmocka_unit_test(hidden_light_is_invisible_and_shines),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
