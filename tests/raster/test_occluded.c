/* What neighbours and the floor leave of a sheen's light from a map: as bright in all as the path tracer's
 * direct light */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "raster/gl.h"
#include "weft/weft.h"

enum { WIDTH = 128, HEIGHT = 96, SAMPLES = 32 };

/* builtin:spheres with nothing but its sheens. */
static WeftScene *spheres(const char *map) {
    WeftScene *scene;
    WeftError error;
    if (weft_scene_load("builtin:spheres", &scene, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    while (weft_scene_info(scene).light_count > 0)
        assert_int_equal(weft_scene_remove_light(scene, 0, NULL), WEFT_OK);
    assert_int_equal(weft_scene_set_environment_file(scene, map, NULL, NULL), WEFT_OK);
    assert_int_equal(weft_scene_set(scene, "*.base_color", "0", NULL, NULL), WEFT_OK);
    assert_int_equal(weft_scene_set(scene, "*.specular", "0", NULL, NULL), WEFT_OK);
    assert_int_equal(weft_scene_set(scene, "*.sheen_lobe", "charlie-neubelt", NULL, NULL), WEFT_OK);
    return scene;
}

static double sum_of(WeftImage *image) {
    const float *p = image->pixels;
    double sum = 0.0;
    for (int k = 0; k < WIDTH * HEIGHT; k++, p += 4) sum += (double)((p[0] + p[1] + p[2]) * p[3]);
    weft_image_free(image);
    return sum;
}

static double traced(const WeftScene *scene) {
    const WeftRenderDesc desc = {.width = WIDTH,
                                 .height = HEIGHT,
                                 .max_depth = 1,
                                 .camera = "0",
                                 .background = WEFT_BACKGROUND_TRANSPARENT,
                                 .threads = 2};
    WeftRender *render;
    WeftImage image;
    assert_int_equal(weft_render_create(scene, &desc, &render, NULL), WEFT_OK);
    assert_int_equal(weft_render_run(render, SAMPLES, 0.0, NULL, NULL), WEFT_OK);
    assert_int_equal(weft_render_image(render, &image, NULL), WEFT_OK);
    weft_render_free(render);
    return sum_of(&image);
}

static double drawn(const WeftScene *scene) {
    const WeftRasterDesc desc = {.occlusion = 64, .no_cache = 1, .threads = 2};
    const WeftRasterView view = {
        .width = WIDTH, .height = HEIGHT, .camera = "0", .background = WEFT_BACKGROUND_TRANSPARENT};
    WeftRaster *raster;
    WeftImage image;
    assert_int_equal(weft_raster_create(scene, &desc, &raster, NULL, NULL), WEFT_OK);
    assert_int_equal(weft_raster_settle(raster, NULL), WEFT_OK);
    assert_int_equal(weft_raster_draw(raster, &view, NULL), WEFT_OK);
    assert_int_equal(weft_raster_image(raster, &image, NULL), WEFT_OK);
    weft_raster_free(raster);
    return sum_of(&image);
}

static void sheens_among_neighbours_are_as_bright_as_traced(void **state) {
    (void)state;
    static const char *const maps[] = {"studio_small_03_1k", "venice_sunset_1k"};
    need_gl();
    for (int k = 0; k < 2; k++) {
        char path[512];
        snprintf(path, sizeof path, "%s/../shared/data/env/%s.hdr", WEFT_SOURCE_DIR, maps[k]);
        if (access(path, R_OK) != 0) {
            print_message("no %s\n", path);
            skip();
        }
        WeftScene *scene = spheres(path);
        double truth = traced(scene), got = drawn(scene);
        print_message("%s: %.1f %%\n", maps[k], 100.0 * (got / truth - 1.0));
        assert_true(got > 0.92 * truth && got < 1.08 * truth);
        weft_scene_free(scene);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(sheens_among_neighbours_are_as_bright_as_traced)};
    return cmocka_run_group_tests(tests, gl_begin, NULL);
}
