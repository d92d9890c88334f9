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

/* An asset, in the preset of a weave unless NULL, and the largest error under any of the maps. */
typedef struct Case {
    const char *asset, *preset;
    double most, ninth;
} Case;

static const char *const maps[] = {"studio_small_03_1k", "venice_sunset_1k"};

/* Returns the path of a file beside the source tree. */
static const char *beside(char path[512], const char *folder, const char *name, const char *ending) {
    snprintf(path, 512, "%s/../shared/data/%s/%s%s", WEFT_SOURCE_DIR, folder, name, ending);
    return path;
}

static WeftScene *scene_under(const Case *at, const char *map) {
    char path[512], sky[512];
    WeftScene *scene;
    WeftError error;
    const bool builtin = strncmp(at->asset, "builtin:", 8) == 0;
    if (weft_scene_load(builtin ? at->asset : beside(path, "gltf", at->asset, ""), &scene, NULL, &error) != WEFT_OK ||
        (at->preset && weft_scene_assign_material(scene, NULL, at->preset, NULL, &error) != WEFT_OK))
        fail_msg("%s", error.text);
    while (weft_scene_info(scene).light_count > 0) assert_int_equal(weft_scene_remove_light(scene, 0, NULL), WEFT_OK);
    assert_int_equal(weft_scene_set_environment_file(scene, beside(sky, "env", map, ".hdr"), NULL, NULL), WEFT_OK);
    return scene;
}

/* Returns the first camera, or that which frames a scene without any. */
static const char *camera_of(const WeftScene *scene) { return weft_scene_info(scene).camera_count ? "0" : NULL; }

static WeftImage traced(const WeftScene *scene) {
    const WeftRenderDesc desc = {.width = WIDTH,
                                 .height = HEIGHT,
                                 .max_depth = 1,
                                 .camera = camera_of(scene),
                                 .background = WEFT_BACKGROUND_TRANSPARENT,
                                 .threads = 2};
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
    const WeftRasterView view = {.width = WIDTH,
                                 .height = HEIGHT,
                                 .samples = 4,
                                 .camera = camera_of(scene),
                                 .background = WEFT_BACKGROUND_TRANSPARENT};
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

/* Returns true if the asset is as traced under each map. */
static bool is_as_traced(const Case *at) {
    bool all = true;
    for (size_t k = 0; k < sizeof maps / sizeof *maps; k++) {
        double ninth;
        WeftScene *scene = scene_under(at, maps[k]);
        WeftImage a = drawn(scene), b = traced(scene);
        const double off = compare(&a, &b, &ninth);
        print_message("%s under %s: %.3f, ninths within %.1f %%\n", at->preset ? at->preset : at->asset, maps[k], off,
                      100.0 * ninth);
        weft_image_free(&a);
        weft_image_free(&b);
        weft_scene_free(scene);
        all = all && off < at->most && ninth < at->ninth;
    }
    return all;
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
    assert_true(is_as_traced(&(Case){"builtin:cloth", NULL, 0.05, 0.05}));
}

/* Both systems of a weave reflect the sky as they do in the path tracer, along the threads and across them. */
static void woven_cloths_are_as_traced(void **state) {
    (void)state;
    need_data();
    static const char *const few[] = {"preset:woven-denim", "preset:woven-charmeuse", "preset:woven-linen"};
    static const char *const more[] = {"preset:woven-corduroy", "preset:woven-gabardine", "preset:woven-poplin",
                                       "preset:woven-shantung", "preset:woven-shot-silk", "preset:woven-tartan",
                                       "preset:woven-twill",    "preset:woven-velvet",    "preset:woven-wool"};
    bool all = true;
    for (size_t k = 0; k < sizeof few / sizeof *few; k++)
        all = is_as_traced(&(Case){"builtin:cloth", few[k], 0.05, 0.1}) && all;
    for (size_t k = 0; k < sizeof more / sizeof *more && test_long(); k++)
        all = is_as_traced(&(Case){"builtin:cloth", more[k], 0.05, 0.1}) && all;
    assert_true(all);
}

/* The chair and the sofa have occlusion maps, which make dark what rays have found already, and fine normal maps. */
static void chair_is_as_traced(void **state) {
    (void)state;
    need_data();
    assert_true(is_as_traced(&(Case){"SheenChair/SheenChair.gltf", NULL, 0.05, 0.1}));
}
static void sofa_is_as_traced(void **state) {
    (void)state;
    need_data();
    assert_true(is_as_traced(&(Case){"GlamVelvetSofa.glb", NULL, 0.075, 0.1}));
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(cloth_is_as_traced),
                                       cmocka_unit_test(woven_cloths_are_as_traced),
                                       cmocka_unit_test(chair_is_as_traced), cmocka_unit_test(sofa_is_as_traced)};
    return cmocka_run_group_tests(tests, gl_begin, NULL);
}
