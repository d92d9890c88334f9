/* Polygon lights that a caller adds, moves and takes away: the path tracer and the rasteriser see the same,
 * and after each update a picture is that of a new raster.
 *
 * Labels: slow unsanitized */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "raster/gl.h"
#include "trace/scenes.h"

enum { SIDE = 72 };

static const WeftLight panel = {.kind = WEFT_LIGHT_POLYGON,
                                .position = {-0.6f, 1.0f, -0.4f},
                                .direction = {0.4f, -1.0f, 0.6f},
                                .color = {5.0f, 4.0f, 3.0f},
                                .size = {0.9f, 0.7f},
                                .roll = 20.0f};
static const WeftLight lamp = {.kind = WEFT_LIGHT_SPOT,
                               .position = {1.0f, 2.0f, 1.0f},
                               .direction = {-1.0f, -2.0f, -1.0f},
                               .color = {4.0f, 4.0f, 4.0f}};

/* A ball on a floor. With a sheen the floor has a material of its own; without there is one, whose shaders link faster. */
static WeftScene *ball_scene(bool sheen) {
    WeftScene *scene = test_scene();
    Material *ball = test_material(scene, 0.4f);
    if (sheen) test_color(ball, INPUT_sheen_color, 0.6f);
    ball->inputs[INPUT_sheen_roughness].value[0] = 0.5f;
    ball->inputs[INPUT_specular].value[0] = 1.0f;
    test_sphere(scene, vec3(0.0f, 0.0f, 0.0f), 0.5f);
    if (sheen) test_material(scene, 0.5f);
    test_quad(scene, vec3(-2.0f, -0.5f, 2.0f), vec3(4.0f, 0.0f, 0.0f), vec3(0.0f, 0.0f, -4.0f));
    scene_bounds(scene);
    test_environment(scene, 0.1f);
    return scene;
}

static const WeftRasterView view = {
    .width = SIDE, .height = SIDE, .samples = 1, .camera = "0,0.9,3.4;0,0.2,0;32", .background = WEFT_BACKGROUND_COLOR};

static WeftRaster *raster_of(const WeftScene *scene) {
    WeftRaster *raster;
    WeftError error;
    const WeftRasterDesc desc = {.threads = 1, .occlusion = 16, .no_cache = 1};
    if (weft_raster_create(scene, &desc, &raster, NULL, &error) != WEFT_OK ||
        weft_raster_wait(raster, &error) != WEFT_OK)
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

static bool is_same(const WeftImage *a, const WeftImage *b) {
    return memcmp(a->pixels, b->pixels, (size_t)SIDE * SIDE * 4 * sizeof(float)) == 0;
}

/* |drawn - traced| over the sum of what is traced, of a ball below a polygon. */
static double compare(int corners, bool shadows_drawn, bool shadows_traced, float through) {
    WeftRasterView how = view;
    how.no_shadows = !shadows_drawn;
    WeftScene *scene = ball_scene(true);
    WeftLight light = panel;
    light.corners = corners;
    scene->materials[0].inputs[INPUT_diffuse_transmission].value[0] = through;
    test_environment(scene, 0.0f);
    assert_int_equal(weft_scene_add_light(scene, &light, NULL), WEFT_OK);
    WeftRaster *raster = raster_of(scene);
    const WeftRenderDesc desc = {.width = SIDE,
                                 .height = SIDE,
                                 .max_depth = 1,
                                 .camera = view.camera,
                                 .background = WEFT_BACKGROUND_COLOR,
                                 .sampling = WEFT_SAMPLING_LIGHT,
                                 .pixel_centre = 1,
                                 .no_shadows = !shadows_traced};
    WeftImage image = drawn(raster, &how), reference = test_render(scene, desc, 256);
    double off = 0.0, sum = 0.0;
    int shines = 0, shines_there = 0;
    for (int k = 0; k < SIDE * SIDE * 4; k++) {
        double x = (double)((float *)image.pixels)[k], y = (double)((float *)reference.pixels)[k];
        shines += k % 4 == 0 && x > 4.0;
        shines_there += k % 4 == 0 && y > 4.0;
        if (k % 4 == 3 || x > 2.9 || y > 2.9) continue; /* the lamp itself */
        off += fabs(x - y), sum += y;
    }
    assert_true(sum > 100.0);
    assert_true(shines > 10 && abs(shines - shines_there) < 6);
    weft_image_free(&image);
    weft_image_free(&reference);
    weft_raster_free(raster);
    weft_scene_free(scene);
    return off / sum;
}

/* A floor with a square above it, single-sided, under one light. */
static WeftScene *sheet_scene(bool faces_floor, const WeftLight *light) {
    WeftScene *scene = test_scene();
    test_material(scene, 0.6f);
    test_quad(scene, vec3(-1.5f, -0.5f, 1.5f), vec3(3.0f, 0.0f, 0.0f), vec3(0.0f, 0.0f, -3.0f));
    test_material(scene, 0.6f)->double_sided = false;
    const Vec3 across = vec3(0.6f, 0.0f, 0.0f), back = vec3(0.0f, 0.0f, -0.6f), corner = vec3(-0.3f, -0.2f, 0.3f);
    test_quad(scene, corner, faces_floor ? back : across, faces_floor ? across : back);
    scene_bounds(scene);
    test_environment(scene, 0.0f);
    assert_int_equal(weft_scene_add_light(scene, light, NULL), WEFT_OK);
    return scene;
}

/* Returns the sum of |drawn - traced| over that of what is traced. */
static double sheet_error(const WeftScene *scene) {
    WeftRaster *raster = raster_of(scene);
    const WeftRenderDesc desc = {.width = SIDE,
                                 .height = SIDE,
                                 .max_depth = 1,
                                 .camera = view.camera,
                                 .background = WEFT_BACKGROUND_COLOR,
                                 .hide_lights = 1};
    WeftRasterView how = view;
    how.hide_lights = 1;
    how.samples = 4;
    WeftImage image = drawn(raster, &how), reference = test_render(scene, desc, 128);
    double off = 0.0, sum = 0.0;
    for (int k = 0; k < SIDE * SIDE * 4; k++) {
        double x = (double)((float *)image.pixels)[k], y = (double)((float *)reference.pixels)[k];
        if (k % 4 < 3) off += fabs(x - y), sum += y;
    }
    assert_true(sum > 10.0);
    weft_image_free(&image);
    weft_image_free(&reference);
    weft_raster_free(raster);
    return off / sum;
}

static void single_sided_surfaces_shade_what_they_face(void **state) {
    (void)state;
    need_gl();
    const WeftLight sun = {.direction = {-0.3f, -1.0f, -0.2f}, .color = {2.0f, 2.0f, 2.0f}};
    const WeftLight *const lights[] = {&sun, &lamp, &panel};
    static const char *const names[] = {"sun", "spot", "polygon"};
    for (int k = 0; k < 3; k++)
        for (int faces_floor = 0; faces_floor < 2; faces_floor++) {
            WeftScene *scene = sheet_scene(faces_floor, lights[k]);
            double error = sheet_error(scene);
            print_message("a sheet that faces the %s under a %s: %.3f\n", faces_floor ? "floor" : "light", names[k],
                          error);
            assert_true(error < 0.025);
            weft_scene_free(scene);
        }
}

enum { PANELS = 5 };

/* Draws under one of some panels that do not touch each other in the picture, or under all where k is below 0. */
static WeftImage drawn_under(int k) {
    static const int corners[PANELS] = {3, 4, 4, 7, 8};
    WeftScene *scene = ball_scene(true);
    test_environment(scene, 0.0f);
    for (int n = 0; n < PANELS; n++) {
        WeftLight light = panel;
        light.position[0] = 0.35f * (float)(n - 2);
        light.size[0] = light.size[1] = 0.3f;
        light.corners = corners[n];
        if (k < 0 || k == n) assert_int_equal(weft_scene_add_light(scene, &light, NULL), WEFT_OK);
    }
    WeftRasterView how = view;
    how.no_shadows = 1;
    WeftRaster *raster = raster_of(scene);
    WeftImage image = drawn(raster, &how);
    weft_raster_free(raster);
    weft_scene_free(scene);
    return image;
}

static void polygons_of_different_corners_add_up(void **state) {
    (void)state;
    need_gl();
    static float sum[SIDE * SIDE * 4];
    WeftImage all = drawn_under(-1);
    for (int n = 0; n < PANELS; n++) {
        WeftImage one = drawn_under(n);
        for (int k = 0; k < SIDE * SIDE * 4; k++) sum[k] += ((float *)one.pixels)[k];
        weft_image_free(&one);
    }
    const float *is = all.pixels;
    float most = 0.0f;
    for (int k = 0; k < SIDE * SIDE * 4; k++) {
        if (k % 4 == 3 || is[k] > 2.9f) continue; /* a lamp itself */
        if (!(fabsf(is[k] - sum[k]) <= 4e-3f * sum[k] + 1e-4f))
            fail_msg("pixel %d is %g, each alone adds up to %g", k / 4, (double)is[k], (double)sum[k]);
        most = fmaxf(most, is[k]);
    }
    assert_true(most > 0.1f);
    weft_image_free(&all);
}

static void polygon_lights_agree_with_the_path_tracer(void **state) {
    (void)state;
    need_gl();
    for (int corners = 3; corners <= 8; corners += corners == 4 ? 4 : 1) {
        double off = compare(corners, false, false, 0.0f);
        print_message("%d corners: %.2f %% from the path tracer\n", corners, 100.0 * off);
        assert_true(off < 0.04);
    }
}

static void soft_shadows_are_near_the_path_tracer(void **state) {
    (void)state;
    need_gl();
    double off = compare(4, true, true, 0.0f), without = compare(4, false, true, 0.0f);
    print_message("shadows: %.2f %% from the path tracer, %.2f %% without\n", 100.0 * off, 100.0 * without);
    assert_true(off < 0.03 && without > 0.3);
}

static void polygon_behind_shines_through_cloth(void **state) {
    (void)state;
    need_gl();
    double off = compare(4, false, false, 0.7f);
    print_message("through the ball: %.2f %% from the path tracer\n", 100.0 * off);
    assert_true(off < 0.04);
}

/* Returns the light in the middle of a sheet of the scene's last material before an even sky. Frees the scene. */
static float middle_before_sky(WeftScene *scene) {
    test_quad(scene, vec3(-2.0f, -2.0f, 0.0f), vec3(4.0f, 0.0f, 0.0f), vec3(0.0f, 4.0f, 0.0f));
    scene_bounds(scene);
    test_environment(scene, 1.0f);
    WeftRaster *raster = raster_of(scene);
    WeftImage image = drawn(raster, &view);
    const float middle = ((const float *)image.pixels)[4 * (SIDE / 2 * SIDE + SIDE / 2)];
    weft_image_free(&image);
    weft_raster_free(raster);
    weft_scene_free(scene);
    return middle;
}

/* A sheet before an even sky: half of its light comes back, six tenths of the other half through. */
static void sky_behind_shines_through_cloth(void **state) {
    (void)state;
    need_gl();
    WeftScene *scene = test_scene();
    Material *sheet = test_material(scene, 1.0f);
    sheet->inputs[INPUT_diffuse_transmission].value[0] = 0.5f;
    test_color(sheet, INPUT_diffuse_transmission_color, 0.6f);
    const float middle = middle_before_sky(scene);
    if (!(fabsf(middle - 0.8f) < 0.008f)) fail_msg("%g is not 0.8", (double)middle);
}

/* A pane and a solid before an even sky, of which the last absorbs a half; either in a colour. */
static void sky_behind_shines_through_glass(void **state) {
    (void)state;
    need_gl();
    for (int k = 0; k < 4; k++) {
        const bool solid = k % 2, smooth = k < 2;
        WeftScene *scene = test_scene();
        Material *sheet = test_material(scene, 0.8f);
        sheet->inputs[INPUT_transmission].value[0] = 1.0f;
        sheet->inputs[INPUT_roughness].value[0] = smooth ? 0.1f : 0.6f;
        sheet->inputs[INPUT_thickness].value[0] = solid ? 0.2f : 0.0f;
        sheet->inputs[INPUT_attenuation_distance].value[0] = 0.2f;
        test_color(sheet, INPUT_attenuation_color, 0.5f);
        const float middle = middle_before_sky(scene), expected = solid ? 0.4f : 0.8f;
        if (!(fabsf(middle - expected) < 0.008f)) fail_msg("%d: %g is not %g", k, (double)middle, (double)expected);
    }
}

/* A pane that absorbs half of the light, by every profile: those that draw glass show half the sky through it, and an opaque
 * one is the brighter for it. */
static void sky_behind_shines_through_glass_of_engines(void **state) {
    (void)state;
    need_gl();
    static const char *const drawing[] = {"none",           "khronos", "khr-fuzz",
                                          "khr-fuzz-exact", "openpbr", "babylon-openpbr",
                                          "three",          "babylon", "filament-sheen"};
    for (int profile = 0; weft_profile_name(profile); profile++) {
        bool glass = false;
        for (size_t k = 0; k < sizeof drawing / sizeof *drawing; k++)
            glass |= strcmp(weft_profile_name(profile), drawing[k]) == 0;
        WeftScene *scene = test_scene();
        Material *sheet = test_material(scene, 0.8f);
        weft_material_choose(sheet, CHOICE_profile, profile);
        sheet->inputs[INPUT_transmission].value[0] = 1.0f;
        sheet->inputs[INPUT_roughness].value[0] = 0.3f;
        sheet->inputs[INPUT_thickness].value[0] = 0.2f;
        sheet->inputs[INPUT_attenuation_distance].value[0] = 0.2f;
        test_color(sheet, INPUT_attenuation_color, 0.5f);
        const float middle = middle_before_sky(scene);
        if (glass != (fabsf(middle - 0.4f) < 0.01f) || (!glass && middle < 0.6f))
            fail_msg("%s: %g", weft_profile_name(profile), (double)middle);
    }
}

static void put(WeftScene *scene, int index, float x, int corners) {
    WeftLight light = panel;
    light.position[0] = x;
    light.corners = corners;
    assert_int_equal(weft_scene_put_light(scene, index, &light, NULL), WEFT_OK);
}

static void change(WeftScene *scene, int step) {
    WeftLight light = panel;
    switch (step) {
    case 0: assert_int_equal(weft_scene_add_light(scene, &panel, NULL), WEFT_OK); break;
    case 1: put(scene, 0, 0.5f, 4); break;
    case 2: put(scene, 0, 0.5f, 7); break;
    case 3: assert_int_equal(weft_scene_add_light(scene, &lamp, NULL), WEFT_OK); break;
    case 4:
        light.position[2] = 1.0f;
        light.color[0] = 9.0f;
        assert_int_equal(weft_scene_add_light(scene, &light, NULL), WEFT_OK);
        break;
    case 5: assert_int_equal(weft_scene_remove_light(scene, 0, NULL), WEFT_OK); break;
    case 6: assert_int_equal(weft_scene_put_light(scene, 1, &lamp, NULL), WEFT_OK); break; /* another kind */
    case 7: put(scene, 0, -0.2f, 3); break;
    case 8:
        light = lamp;
        light.position[0] = -1.0f;
        assert_int_equal(weft_scene_put_light(scene, 1, &light, NULL), WEFT_OK);
        break;
    default: assert_int_equal(weft_scene_remove_light(scene, 0, NULL), WEFT_OK); break;
    }
}

static void updated_lights_draw_as_new_ones(void **state) {
    (void)state;
    need_gl();
    enum { CHANGES = 11 };
    WeftScene *scene = ball_scene(getenv("WEFT_TEST_LONG") != NULL);
    WeftRaster *raster = raster_of(scene);
    WeftError error;
    WeftImage before = drawn(raster, &view), first = drawn(raster, &view);
    for (int k = 0; k < CHANGES; k++) {
        change(scene, k);
        if (weft_raster_update(raster, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
        WeftRaster *fresh = raster_of(scene);
        WeftImage is = drawn(raster, &view), should = drawn(fresh, &view);
        if (!is_same(&is, &should)) fail_msg("change %d: not as a new raster draws it", k);
        if (is_same(&is, &before)) fail_msg("change %d: nothing has changed", k);
        weft_image_free(&before);
        weft_image_free(&should);
        weft_raster_free(fresh);
        before = is;
    }
    assert_true(is_same(&before, &first)); /* no light is left */
    weft_image_free(&before);
    weft_image_free(&first);
    weft_raster_free(raster);
    weft_scene_free(scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(polygon_lights_agree_with_the_path_tracer),
                                       cmocka_unit_test(polygons_of_different_corners_add_up),
                                       cmocka_unit_test(single_sided_surfaces_shade_what_they_face),
                                       cmocka_unit_test(soft_shadows_are_near_the_path_tracer),
                                       cmocka_unit_test(polygon_behind_shines_through_cloth),
                                       cmocka_unit_test(sky_behind_shines_through_cloth),
                                       cmocka_unit_test(sky_behind_shines_through_glass),
                                       cmocka_unit_test(sky_behind_shines_through_glass_of_engines),
                                       cmocka_unit_test(updated_lights_draw_as_new_ones)};
    return cmocka_run_group_tests(tests, gl_begin, NULL);
}
