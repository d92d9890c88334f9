/* A soft shadow is smooth, only of what is in the way, and that of the path tracer where things touch. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "gl.h"
#include "trace/scenes.h"

enum { SIDE = 64 };

/* Draws a scene under one lamp, and frees it. */
static WeftImage picture(WeftScene *scene, const WeftLight *lamp, const char *camera) {
    WeftRaster *raster;
    WeftImage image = {0};
    WeftError error;
    const WeftRasterView view = {.width = SIDE, .height = SIDE, .samples = 1, .camera = camera};
    scene_bounds(scene);
    test_environment(scene, 0.0f);
    weft_scene_add_light(scene, lamp, NULL);
    if (weft_raster_create(scene, &(WeftRasterDesc){0}, &raster, NULL, &error) != WEFT_OK ||
        weft_raster_draw(raster, &view, &error) != WEFT_OK || weft_raster_image(raster, &image, &error) != WEFT_OK)
        fail_msg("%s", error.text);
    weft_raster_free(raster);
    weft_scene_free(scene);
    return image;
}

/* A roof over one half of a plane, and a lamp over the roof; seen is the plane along the shadow's edge. */
static WeftImage edge(void) {
    WeftScene *scene = test_scene();
    const WeftLight lamp = {.kind = WEFT_LIGHT_POLYGON,
                            .position = {0.0f, 2.0f, 0.0f},
                            .direction = {0.0f, -1.0f, 0.0f},
                            .size = {0.3f, 0.3f},
                            .color = {30.0f, 30.0f, 30.0f}};
    test_material(scene, 0.8f);
    test_quad(scene, vec3(-2.0f, 0.0f, 2.0f), vec3(4.0f, 0.0f, 0.0f), vec3(0.0f, 0.0f, -4.0f));
    test_quad(scene, vec3(-2.0f, 1.0f, 2.0f), vec3(2.0f, 0.0f, 0.0f), vec3(0.0f, 0.0f, -4.0f));
    return picture(scene, &lamp, "0,0.9,0.001;0,0,0;30");
}

static float at(const WeftImage *image, int x, int y) { return ((const float *)image->pixels)[4 * (y * SIDE + x)]; }

/* From light to dark in steps too small to be seen as such: at most a few times as large as if all were the same. */
static void penumbra_has_no_bands(void **state) {
    (void)state;
    need_gl();
    WeftImage image = edge();
    double most = 0.0, low = (double)at(&image, 0, SIDE / 2), high = low;
    for (int x = 1; x < SIDE; x++) {
        double here = (double)at(&image, x, SIDE / 2), before = (double)at(&image, x - 1, SIDE / 2);
        most = fmax(most, fabs(here - before));
        low = fmin(low, here), high = fmax(high, here);
    }
    assert_true(high - low > 0.1 * high);
    if (!(most * SIDE < 4.0 * (high - low))) fail_msg("a step of %g from %g to %g", most, low, high);
    weft_image_free(&image);
}

/* The shadow is the same along its edge. */
static void penumbra_is_even_along_the_edge(void **state) {
    (void)state;
    need_gl();
    WeftImage image = edge();
    double grain = 0.0, most = 0.0;
    for (int x = 0; x < SIDE; x++)
        for (int y = SIDE / 4; y < 3 * SIDE / 4; y++) {
            double c = (double)at(&image, x, y), off = c - 0.5 * (double)(at(&image, x, y - 1) + at(&image, x, y + 1));
            grain = fmax(grain, fabs(off));
            most = fmax(most, c);
        }
    if (!(grain < 0.01 * most)) fail_msg("grain %g of %g", grain, most);
    weft_image_free(&image);
}

/* A low wall that a lamp before it lights, with a floor at its foot or without: what the wall looks like. */
static WeftImage wall(bool floor) {
    WeftScene *scene = test_scene();
    const WeftLight lamp = {.kind = WEFT_LIGHT_POLYGON,
                            .position = {0.0f, 1.4f, 1.7f},
                            .direction = {0.0f, -0.7f, -0.7f},
                            .size = {0.8f, 0.8f},
                            .color = {30.0f, 30.0f, 30.0f}};
    test_material(scene, 0.8f);
    test_quad(scene, vec3(-1.0f, 0.0f, 0.0f), vec3(2.0f, 0.0f, 0.0f), vec3(0.0f, 0.3f, 0.0f));
    if (floor) test_quad(scene, vec3(-1.0f, 0.0f, 1.5f), vec3(2.0f, 0.0f, 0.0f), vec3(0.0f, 0.0f, -1.5f));
    return picture(scene, &lamp, "0,0.06,1;0,0.06,0;5");
}

/* The floor is nearer to the lamp than the wall, but on no line from one to the other. */
static void floor_before_a_wall_does_not_shade_it(void **state) {
    (void)state;
    need_gl();
    WeftImage alone = wall(false), above = wall(true);
    for (int k = 0; k < SIDE * SIDE; k++) {
        float a = at(&alone, k % SIDE, k / SIDE), b = at(&above, k % SIDE, k / SIDE);
        if (!(a > 0.0f && fabsf(a - b) < 0.01f * a))
            fail_msg("at %d, %d: %g alone, %g above a floor", k % SIDE, k / SIDE, (double)a, (double)b);
    }
    weft_image_free(&alone);
    weft_image_free(&above);
}

/* A roof over ground that reaches so far to all sides, beside a lamp aslant; what is seen is at the roof's foot. */
static WeftImage ground(float reach) {
    WeftScene *scene = test_scene();
    const WeftLight lamp = {.kind = WEFT_LIGHT_POLYGON,
                            .position = {-1.5f, 2.0f, 0.0f},
                            .direction = {0.6f, -0.8f, 0.0f},
                            .size = {0.3f, 0.3f},
                            .color = {30.0f, 30.0f, 30.0f}};
    test_material(scene, 0.8f);
    test_quad(scene, vec3(-0.2f, 0.5f, 0.2f), vec3(0.4f, 0.0f, 0.0f), vec3(0.0f, 0.0f, -0.4f));
    test_quad(scene, vec3(-reach, 0.0f, reach), vec3(2.0f * reach, 0.0f, 0.0f), vec3(0.0f, 0.0f, -2.0f * reach));
    return picture(scene, &lamp, "0.5,0.4,0.001;0.5,0,0;120");
}

/* What is near the lamp keeps its shadow however far the ground reaches. */
static void shadows_do_not_mind_far_ground(void **state) {
    (void)state;
    need_gl();
    WeftImage small = ground(4.0f), large = ground(400.0f);
    double off = 0.0, sum = 0.0, low = HUGE_VAL, high = 0.0;
    for (int k = 0; k < SIDE * SIDE; k++) {
        double a = (double)at(&small, k % SIDE, k / SIDE), b = (double)at(&large, k % SIDE, k / SIDE);
        off += fabs(a - b);
        sum += a;
        low = fmin(low, a), high = fmax(high, a);
    }
    assert_true(low < 0.1 * high);
    if (!(off < 0.001 * sum)) fail_msg("%g of %g off", off, sum);
    weft_image_free(&small);
    weft_image_free(&large);
}

/* The soft box of builtin:cloth is alone, and light is direct: |drawn - traced| is little of the sum of what is traced. */
static void shadows_of_a_cloth_are_the_path_tracers(void **state) {
    (void)state;
    need_gl();
    WeftScene *scene;
    WeftRaster *raster;
    WeftError error;
    WeftImage image = {0};
    const WeftRasterView view = {.width = SIDE, .height = SIDE, .camera = "0"};
    const WeftRenderDesc desc = {.width = SIDE, .height = SIDE, .max_depth = 1, .camera = "0"};
    assert_int_equal(weft_scene_load("builtin:cloth", &scene, NULL, &error), WEFT_OK);
    test_environment(scene, 0.0f);
    if (weft_raster_create(scene, &(WeftRasterDesc){0}, &raster, NULL, &error) != WEFT_OK ||
        weft_raster_draw(raster, &view, &error) != WEFT_OK || weft_raster_image(raster, &image, &error) != WEFT_OK)
        fail_msg("%s", error.text);
    WeftImage traced = test_render(scene, desc, 64);
    double off = 0.0, sum = 0.0;
    for (int k = 0; k < SIDE * SIDE; k++) {
        double t = (double)((const float *)traced.pixels)[4 * k];
        off += fabs((double)at(&image, k % SIDE, k / SIDE) - t);
        sum += t;
    }
    print_message("the cloth under its soft box: %.1f %% from the path tracer\n", 100.0 * off / sum);
    assert_true(off < 0.06 * sum);
    weft_image_free(&image);
    weft_image_free(&traced);
    weft_raster_free(raster);
    weft_scene_free(scene);
}

/* Returns sum |drawn - traced| over the sum of what is traced, of a lamp at a height over the middle of three walls, on
 * a ground that reaches as far as this, or none. */
static double off_by_point(float height, float ground) {
    static const char camera[] = "0.2,2,1.5;0,0,0;50";
    const WeftLight lamp = {.kind = WEFT_LIGHT_POINT, .position = {0.1f, height, 0.05f}, .color = {3.0f, 3.0f, 3.0f}};
    WeftScene *scene = test_scene();
    WeftRaster *raster;
    WeftImage drawn = {0};
    const WeftRasterView view = {.width = SIDE, .height = SIDE, .samples = 4, .camera = camera};
    const WeftRenderDesc desc = {.width = SIDE, .height = SIDE, .max_depth = 1, .camera = camera};
    double off = 0.0, sum = 0.0;
    test_material(scene, 0.8f);
    test_quad(scene, vec3(-1.0f, 0.0f, 1.0f), vec3(2.0f, 0.0f, 0.0f), vec3(0.0f, 0.0f, -2.0f));
    test_quad(scene, vec3(-0.3f, 0.0f, 0.3f), vec3(0.0f, 0.0f, -0.6f), vec3(0.0f, 0.4f, 0.0f));
    test_quad(scene, vec3(0.4f, 0.0f, 0.3f), vec3(0.0f, 0.0f, -0.6f), vec3(0.0f, 0.4f, 0.0f));
    test_quad(scene, vec3(-0.3f, 0.0f, -0.4f), vec3(0.6f, 0.0f, 0.0f), vec3(0.0f, 0.3f, 0.0f));
    if (ground > 0.0f)
        test_quad(scene, vec3(-ground, -0.01f, ground), vec3(2.0f * ground, 0.0f, 0.0f),
                  vec3(0.0f, 0.0f, -2.0f * ground));
    scene_bounds(scene);
    test_environment(scene, 0.0f);
    assert_int_equal(weft_scene_add_light(scene, &lamp, NULL), WEFT_OK);
    assert_int_equal(weft_raster_create(scene, &(WeftRasterDesc){0}, &raster, NULL, NULL), WEFT_OK);
    assert_int_equal(weft_raster_draw(raster, &view, NULL), WEFT_OK);
    assert_int_equal(weft_raster_image(raster, &drawn, NULL), WEFT_OK);
    WeftImage traced = test_render(scene, desc, 64);
    for (int k = 0; k < SIDE * SIDE; k++) {
        const double t = (double)at(&traced, k % SIDE, k / SIDE);
        off += fabs((double)at(&drawn, k % SIDE, k / SIDE) - t);
        sum += t;
    }
    weft_image_free(&drawn);
    weft_image_free(&traced);
    weft_raster_free(raster);
    weft_scene_free(scene);
    print_message("a point light at height %.1f: %.1f %% from the path tracer\n", (double)height, 100.0 * off / sum);
    return off / sum;
}

/* Above the walls, near them, and between them, also on a wide ground. Without shadows 20 % are off. */
static void point_light_casts_the_path_tracers_shadow(void **state) {
    (void)state;
    need_gl();
    assert_true(off_by_point(2.5f, 0.0f) < 0.04);
    assert_true(off_by_point(0.8f, 0.0f) < 0.05);
    assert_true(off_by_point(0.2f, 0.0f) < 0.05);
    assert_true(off_by_point(0.2f, 100.0f) < 0.05);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(penumbra_has_no_bands),
        cmocka_unit_test(penumbra_is_even_along_the_edge),
        cmocka_unit_test(floor_before_a_wall_does_not_shade_it),
        cmocka_unit_test(shadows_do_not_mind_far_ground),
        cmocka_unit_test(shadows_of_a_cloth_are_the_path_tracers),
        cmocka_unit_test(point_light_casts_the_path_tracers_shadow),
    };
    return cmocka_run_group_tests(tests, gl_begin, NULL);
}
