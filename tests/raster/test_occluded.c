/* What neighbours and the floor leave of a sheen's light from a map: as bright in all as the path tracer's
 * direct light */
#include <unistd.h>

#include "shading/cases.h"

#include "raster/gl.h"
#include "weft/weft.h"

enum { WIDTH = 128, HEIGHT = 96, SAMPLES = 32 };

/* builtin:spheres with nothing but its sheens, of that lobe. */
static WeftScene *spheres(const char *map, const char *lobe) {
    WeftScene *scene;
    WeftError error;
    if (weft_scene_load("builtin:spheres", &scene, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    while (weft_scene_info(scene).light_count > 0)
        assert_int_equal(weft_scene_remove_light(scene, 0, NULL), WEFT_OK);
    assert_int_equal(weft_scene_set_environment_file(scene, map, NULL, NULL), WEFT_OK);
    assert_int_equal(weft_scene_set(scene, "*.base_color", "0", NULL, NULL), WEFT_OK);
    assert_int_equal(weft_scene_set(scene, "*.specular", "0", NULL, NULL), WEFT_OK);
    assert_int_equal(weft_scene_set(scene, "*.sheen_lobe", lobe, NULL, NULL), WEFT_OK);
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
    assert_int_equal(weft_raster_wait(raster, NULL), WEFT_OK);
    assert_int_equal(weft_raster_draw(raster, &view, NULL), WEFT_OK);
    assert_int_equal(weft_raster_image(raster, &image, NULL), WEFT_OK);
    weft_raster_free(raster);
    return sum_of(&image);
}

/* Returns the largest relative error of a sheen's light; lobes with a highlight are further off. */
static double bound_of(const char *lobe) {
    return strcmp(lobe, "ggx") == 0 || strcmp(lobe, "burley-coat") == 0 ? 0.10 : 0.08;
}

static bool is_near(const char *map, const char *lobe) {
    char path[512];
    snprintf(path, sizeof path, "%s/../shared/data/env/%s.hdr", WEFT_SOURCE_DIR, map);
    if (access(path, R_OK) != 0) {
        print_message("no %s\n", path);
        skip();
    }
    WeftScene *scene = spheres(path, lobe);
    double off = drawn(scene) / traced(scene) - 1.0, most = bound_of(lobe);
    print_message("%s, %s: %.1f %%\n", map, lobe, 100.0 * off);
    weft_scene_free(scene);
    return off > -most && off < most;
}

static void sheens_among_neighbours_are_as_bright_as_traced(void **state) {
    (void)state;
    need_gl();
    int far = 0, at = 0;
    for (int lobe = 0; weft_lobe_info(lobe); lobe++) {
        const WeftLobeInfo *info = weft_lobe_info(lobe);
        if (info->traits & (WEFT_LOBE_REFERENCE | WEFT_LOBE_DIFFUSE) || !test_turn(&at, 3, 9)) continue;
        far += !is_near("studio_small_03_1k", info->id);
        far += !is_near("venice_sunset_1k", info->id);
    }
    assert_int_equal(far, 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(sheens_among_neighbours_are_as_bright_as_traced)};
    return cmocka_run_group_tests(tests, gl_begin, NULL);
}
