/* What neighbours and the floor leave of a sheen's light from a map: as bright in all as the path tracer's
 * direct light
 *
 * Labels: slow unsanitized */
#include <unistd.h>

#include "shading/cases.h"

#include "raster/gl.h"
#include "raster/sheens.h"
#include "weft/weft.h"

enum { WIDTH = 128, HEIGHT = 96, SAMPLES = 32 };

/* A scene with nothing but its sheens, under a map, or, for NULL, an even sky. */
static WeftScene *bare(const char *name, const char *map) {
    static const float white[3] = {1.0f, 1.0f, 1.0f};
    WeftScene *scene;
    WeftError error;
    if (weft_scene_load(name, &scene, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    while (weft_scene_info(scene).light_count > 0) assert_int_equal(weft_scene_remove_light(scene, 0, NULL), WEFT_OK);
    assert_int_equal(map ? weft_scene_set_environment_file(scene, map, NULL, NULL)
                         : weft_scene_set_environment_color(scene, white, NULL),
                     WEFT_OK);
    assert_int_equal(weft_scene_set(scene, "*.base_color", "0", NULL, NULL), WEFT_OK);
    assert_int_equal(weft_scene_set(scene, "*.specular", "0", NULL, NULL), WEFT_OK);
    return scene;
}

/* The sum over the picture, in pixels of the traced one. */
static double sum_of(WeftImage *image) {
    const float *p = image->pixels;
    double sum = 0.0;
    const int pixels = image->width * image->height;
    for (int k = 0; k < pixels; k++, p += 4) sum += (double)((p[0] + p[1] + p[2]) * p[3]);
    weft_image_free(image);
    return sum * WIDTH * HEIGHT / pixels;
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

/* Rays are traced once for all lobes. */
static WeftRaster *raster_of(const WeftScene *scene) {
    const WeftRasterDesc desc = {.occlusion = 64, .no_cache = 1, .threads = 2};
    WeftRaster *raster;
    assert_int_equal(weft_raster_create(scene, &desc, &raster, NULL, NULL), WEFT_OK);
    assert_int_equal(weft_raster_wait(raster, NULL), WEFT_OK);
    return raster;
}

/* fine: pixels along the side of a traced one. */
static double drawn(WeftRaster *raster, int fine) {
    const WeftRasterView view = {
        .width = fine * WIDTH, .height = fine * HEIGHT, .camera = "0", .background = WEFT_BACKGROUND_TRANSPARENT};
    WeftImage image;
    assert_int_equal(weft_raster_update(raster, NULL, NULL), WEFT_OK);
    assert_int_equal(weft_raster_draw(raster, &view, NULL), WEFT_OK);
    assert_int_equal(weft_raster_image(raster, &image, NULL), WEFT_OK);
    return sum_of(&image);
}

/* Returns the largest relative error of a sheen's light. Lobes of yarns are twice as far off. */
static double bound_of(const char *lobe, double most) {
    return strcmp(lobe, "yarn") == 0 || strcmp(lobe, "woven") == 0 ? 2.0 * most : most;
}

static bool is_near(WeftScene *scene, WeftRaster *raster, int fine, const char *lobe, double most) {
    assert_int_equal(sheens_set_lobe(scene, lobe, NULL), WEFT_OK);
    double off = drawn(raster, fine) / traced(scene) - 1.0;
    print_message("%s: %.1f %%\n", lobe, 100.0 * off);
    return off > -most && off < most;
}

/* most: relative error of a sheen but a yarn's. */
static void sheens_are_as_bright_as_traced(const char *map, double most) {
    char path[512];
    need_gl();
    snprintf(path, sizeof path, "%s/../shared/data/env/%s.hdr", WEFT_SOURCE_DIR, map);
    if (access(path, R_OK) != 0) {
        print_message("no %s\n", path);
        skip();
    }
    WeftScene *scene = bare("builtin:spheres", path);
    WeftRaster *raster = raster_of(scene);
    int far = 0, at = 0;
    for (int lobe = 0; weft_lobe_info(lobe); lobe++) {
        const WeftLobeInfo *info = weft_lobe_info(lobe);
        if (info->traits & (WEFT_LOBE_REFERENCE | WEFT_LOBE_DIFFUSE) || !test_turn(&at, 5, 9)) continue;
        far += !is_near(scene, raster, 1, info->id, bound_of(info->id, most));
    }
    weft_raster_free(raster);
    weft_scene_free(scene);
    assert_int_equal(far, 0);
}

static void sheens_in_a_studio_are_as_bright_as_traced(void **state) {
    (void)state;
    sheens_are_as_bright_as_traced("studio_small_03_1k", 0.025);
}

static void sheens_under_a_sunset_are_as_bright_as_traced(void **state) {
    (void)state;
    sheens_are_as_bright_as_traced("venice_sunset_1k", 0.055);
}

/* The smooth normals of folds face away from the eye at silhouettes, where these sheens are brightest: what comes from below
 * the smooth surface does not count. */
static void silhouettes_are_as_bright_as_traced(void **state) {
    (void)state;
    need_gl();
    WeftScene *scene = bare("builtin:cloth", NULL);
    WeftRaster *raster = raster_of(scene);
    assert_true(is_near(scene, raster, 4, "ltc-fibre", 0.06));
    assert_true(is_near(scene, raster, 4, "fibre", 0.2));
    /* light from beyond a fold or the floor: what hides it has a sharp edge */
    assert_true(is_near(scene, raster, 4, "burley-sheen", 0.06));
    weft_raster_free(raster);
    weft_scene_free(scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(silhouettes_are_as_bright_as_traced),
                                       cmocka_unit_test(sheens_in_a_studio_are_as_bright_as_traced),
                                       cmocka_unit_test(sheens_under_a_sunset_are_as_bright_as_traced)};
    return cmocka_run_group_tests(tests, gl_begin, NULL);
}
