/* First frames of real assets under real maps beside the path tracer's direct light: the sum of differences over the sum,
 * and the mean of each ninth of the picture
 *
 * Labels: slow unsanitized */
#include <math.h>
#include <unistd.h>

#include "shading/cases.h"

#include "raster/gl.h"
#include "weft/weft.h"

enum { WIDTH = 240, HEIGHT = 160, SAMPLES = 512, NINTH_PIXELS = 50 };

/* An asset, and the largest error under any of the maps. */
typedef struct Case {
    const char *asset;
    double most, ninth;
} Case;

static const char *const maps[] = {"studio_small_03_1k", "venice_sunset_1k"};

/* Returns the path of a file beside the source tree. */
static const char *beside(char path[512], const char *folder, const char *name, const char *ending) {
    snprintf(path, 512, "%s/../shared/data/%s/%s%s", WEFT_SOURCE_DIR, folder, name, ending);
    return path;
}

static WeftScene *scene_under(const char *asset, const char *map) {
    char path[512], sky[512];
    WeftScene *scene;
    WeftError error;
    const char *name = strncmp(asset, "builtin:", 8) == 0 ? asset : beside(path, "gltf", asset, "");
    if (weft_scene_load(name, &scene, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    while (weft_scene_info(scene).light_count > 0) assert_int_equal(weft_scene_remove_light(scene, 0, NULL), WEFT_OK);
    assert_int_equal(weft_scene_set_environment_file(scene, beside(sky, "env", map, ".hdr"), NULL, NULL), WEFT_OK);
    return scene;
}

static WeftImage traced(const WeftScene *scene) {
    const WeftRenderDesc desc = {
        .width = WIDTH, .height = HEIGHT, .max_depth = 1, .background = WEFT_BACKGROUND_TRANSPARENT, .threads = 2};
    WeftRender *render;
    WeftImage image;
    assert_int_equal(weft_render_create(scene, &desc, &render, NULL), WEFT_OK);
    assert_int_equal(weft_render_run(render, SAMPLES, 0.0, NULL, NULL), WEFT_OK);
    assert_int_equal(weft_render_image(render, &image, NULL), WEFT_OK);
    weft_render_free(render);
    return image;
}

static WeftImage drawn(const WeftScene *scene) {
    const WeftRasterDesc desc = {.occlusion = 64, .no_cache = 1, .threads = 2};
    const WeftRasterView view = {
        .width = WIDTH, .height = HEIGHT, .samples = 4, .background = WEFT_BACKGROUND_TRANSPARENT};
    WeftRaster *raster;
    WeftImage image;
    assert_int_equal(weft_raster_create(scene, &desc, &raster, NULL, NULL), WEFT_OK);
    assert_int_equal(weft_raster_wait(raster, NULL), WEFT_OK);
    assert_int_equal(weft_raster_draw(raster, &view, NULL), WEFT_OK);
    assert_int_equal(weft_raster_image(raster, &image, NULL), WEFT_OK);
    weft_raster_free(raster);
    return image;
}

/* The sums over the pixels that both pictures cover: of |difference|, and of either picture. */
typedef struct Sums {
    double difference, drawn, traced;
    int pixels;
} Sums;

static void add_pixel(const float *a, const float *b, Sums *to) {
    const float opaque = 0.99f;
    if (a[3] < opaque || b[3] < opaque) return;
    for (int c = 0; c < 3; c++) {
        to->difference += (double)fabsf(a[c] - b[c]);
        to->drawn += (double)a[c];
        to->traced += (double)b[c];
    }
    to->pixels++;
}

/* Returns the sum of differences over the sum; ninth: gets the largest relative error of the mean of a ninth. */
static double compare(const WeftImage *a, const WeftImage *b, double *ninth) {
    Sums all = {0}, part[9] = {0};
    for (int k = 0; k < WIDTH * HEIGHT; k++) {
        const float *p = (const float *)a->pixels + 4 * k, *q = (const float *)b->pixels + 4 * k;
        add_pixel(p, q, &all);
        add_pixel(p, q, &part[3 * (k / WIDTH * 3 / HEIGHT) + k % WIDTH * 3 / WIDTH]);
    }
    *ninth = 0.0;
    for (int k = 0; k < 9; k++)
        if (part[k].pixels > NINTH_PIXELS) *ninth = fmax(*ninth, fabs(part[k].drawn / part[k].traced - 1.0));
    return all.difference / all.traced;
}

static void check(const Case *at) {
    for (size_t k = 0; k < sizeof maps / sizeof *maps; k++) {
        double ninth;
        WeftScene *scene = scene_under(at->asset, maps[k]);
        WeftImage a = drawn(scene), b = traced(scene);
        const double off = compare(&a, &b, &ninth);
        print_message("%s under %s: %.3f, ninths within %.1f %%\n", at->asset, maps[k], off, 100.0 * ninth);
        weft_image_free(&a);
        weft_image_free(&b);
        weft_scene_free(scene);
        assert_true(off < at->most && ninth < at->ninth);
    }
}

/* Skips, and says so, without the data. */
static void need_data(void) {
    char path[512];
    need_gl();
    if (access(beside(path, "env", maps[1], ".hdr"), R_OK) == 0) return;
    print_message("no %s\n", path);
    skip();
}

static void cloth_is_as_traced(void **state) {
    (void)state;
    need_data();
    check(&(Case){"builtin:cloth", 0.065, 0.05});
}

/* The chair and the sofa have occlusion maps, which make dark what rays have found already, and fine normal maps. */
static void chair_is_as_traced(void **state) {
    (void)state;
    need_data();
    check(&(Case){"SheenChair/SheenChair.gltf", 0.05, 0.1});
}
static void sofa_is_as_traced(void **state) {
    (void)state;
    need_data();
    check(&(Case){"GlamVelvetSofa.glb", 0.075, 0.1});
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(cloth_is_as_traced), cmocka_unit_test(chair_is_as_traced),
                                       cmocka_unit_test(sofa_is_as_traced)};
    return cmocka_run_group_tests(tests, gl_begin, NULL);
}
