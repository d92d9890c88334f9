/* A soft shadow is smooth, neither the same for four pixels nor grainy, and only of what is in the way. */
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
        weft_raster_draw(raster, &view, &error) != WEFT_OK ||
        weft_raster_image(raster, &image, &error) != WEFT_OK)
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

static float at(const WeftImage *image, int x, int y) {
    return ((const float *)image->pixels)[4 * (y * SIDE + x)];
}

static void penumbra_steps_within_quads_are_as_large_as_between_them(void **state) {
    (void)state;
    need_gl();
    WeftImage image = edge();
    double within = 0.0, between = 0.0;
    for (int y = 1; y + 2 < SIDE; y++)
        for (int x = 1; x + 2 < SIDE; x++) {
            double step = (double)fabsf(at(&image, x + 1, y) - at(&image, x, y));
            *(x % 2 ? &between : &within) += step;
        }
    assert_true(between > 1.0);
    if (!(within > 0.7 * between)) fail_msg("within quads %g, between them %g", within, between);
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
            double c = (double)at(&image, x, y),
                   off = c - 0.5 * (double)(at(&image, x, y - 1) + at(&image, x, y + 1));
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

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(penumbra_steps_within_quads_are_as_large_as_between_them),
        cmocka_unit_test(penumbra_is_even_along_the_edge),
        cmocka_unit_test(floor_before_a_wall_does_not_shade_it),
    };
    return cmocka_run_group_tests(tests, gl_begin, NULL);
}
