/* Panes of thin, smooth glass in the raster engine: sums of frames have the path tracer's tinted light behind them, and
 * in a first frame they cast no shadow
 *
 * Labels: slow unsanitized */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "panes.h"
#include "raster/sums.h"

static const WeftRasterView seen = {
    .width = WIDTH, .height = HEIGHT, .camera = PANE_CAMERA, .background = WEFT_BACKGROUND_TRANSPARENT};

static void put_pane(WeftScene *scene) {
    pane_material(scene, pane_tint, 0.0f, 0.0f);
    pane_put(scene, 1.0f);
}

/* Sets the means of a sum of frames, or of a first frame, and frees the scene. */
static void means_of(WeftScene *scene, int frames, double mean[3]) {
    WeftRaster *raster = raster_of(scene);
    WeftImage image;
    if (frames) image = summed(raster, &seen, frames);
    if (!frames) assert_int_equal(weft_raster_draw(raster, &seen, NULL), WEFT_OK);
    if (!frames) assert_int_equal(weft_raster_image(raster, &image, NULL), WEFT_OK);
    pane_means(&image, mean);
    weft_image_free(&image);
    weft_raster_free(raster);
    weft_scene_free(scene);
}

/* Compares a floor under a tinted pane with a bare one. */
static void floor_has_tinted_light(void (*light)(WeftScene *), double cosine, int frames, const char *what) {
    double mean[2][3];
    for (int k = 0; k < 2; k++) {
        WeftScene *scene = pane_floor();
        if (k) put_pane(scene);
        light(scene);
        means_of(scene, frames, mean[k]);
    }
    for (int c = 0; c < 3; c++) {
        const double part = mean[1][c] / mean[0][c],
                     expected = frames ? pane_clear(cosine) * (double)pane_tint[c] : 1.0;
        print_message("%s, channel %d: %.4f of the light, %.4f expected\n", what, c, part, expected);
        if (!(fabs(part / expected - 1.0) < 0.01)) fail_msg("%s: %g for %g", what, part, expected);
    }
}

static void sums_are_tinted(void **state) {
    (void)state;
    need_gl();
    floor_has_tinted_light(pane_sun, 0.8, 64, "sun, a sum");
    floor_has_tinted_light(pane_lamp, 1.0, 64, "lamp, a sum");
}

/* It lets through .51 of the light of the mean channel; the maps have all of it. */
static void first_frames_have_no_shadow(void **state) {
    (void)state;
    need_gl();
    floor_has_tinted_light(pane_sun, 0.8, 0, "sun, a frame");
    floor_has_tinted_light(pane_lamp, 1.0, 0, "lamp, a frame");
}

/* A pane that lets through less than half keeps its shadow in a first frame, and glass that becomes one loses it. */
static void dark_panes_keep_their_shadow(void **state) {
    static const float dark[3] = {0.3f, 0.3f, 0.3f};
    (void)state;
    need_gl();
    WeftScene *scene = pane_floor();
    Material *glass = pane_material(scene, dark, 0.0f, 0.0f);
    pane_put(scene, 1.0f);
    pane_sun(scene);
    WeftRaster *raster = raster_of(scene);
    for (int k = 0; k < 2; k++) {
        double mean[3];
        WeftImage image;
        assert_int_equal(weft_raster_draw(raster, &seen, NULL), WEFT_OK);
        assert_int_equal(weft_raster_image(raster, &image, NULL), WEFT_OK);
        pane_means(&image, mean);
        weft_image_free(&image);
        assert_true(k ? mean[0] > 0.1 : mean[0] < 1e-3);
        test_color(glass, INPUT_base_color, 0.9f);
        assert_int_equal(weft_raster_update(raster, NULL, NULL), WEFT_OK);
    }
    weft_raster_free(raster);
    weft_scene_free(scene);
}

/* Sky, lamp and sun behind a pane, over a glossy floor and a ball; then with one bounce. */
static void sums_agree_with_the_path_tracer(void **state) {
    (void)state;
    need_gl();
    for (int bounces = 0; bounces < 2; bounces++) {
        WeftScene *scene = pane_floor();
        scene->materials[0].inputs[INPUT_specular].value[0] = 1.0f;
        scene->materials[0].inputs[INPUT_roughness].value[0] = 0.4f;
        test_environment(scene, 0.3f);
        test_material(scene, 0.4f);
        test_ball(scene, vec3(0.1f, 0.1f, 0.1f), 0.1f, 24);
        put_pane(scene);
        pane_sun(scene);
        pane_lamp(scene);
        WeftRasterView view = seen;
        view.bounces = bounces;
        agrees(scene, &view, 256, 1024, bounces ? "one bounce" : "sky, lamp and sun", 0.03, 0.01);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sums_are_tinted),
        cmocka_unit_test(first_frames_have_no_shadow),
        cmocka_unit_test(dark_panes_keep_their_shadow),
        cmocka_unit_test(sums_agree_with_the_path_tracer),
    };
    return cmocka_run_group_tests(tests, gl_begin, NULL);
}
