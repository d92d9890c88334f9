/* Both engines weave the same cloth: near by pixel for pixel, and from afar as bright on the mean. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "raster/gl.h"

#include "weft/weft.h"

enum { WIDTH = 240, HEIGHT = 160, PIXELS = WIDTH * HEIGHT };

static WeftScene *scene_of(const char *weave) {
    WeftScene *scene;
    WeftError error;
    const WeftLight light = {.direction = {-1.0f, -2.0f, -1.0f}, .color = {3.0f, 3.0f, 3.0f}};
    if (weft_scene_load("builtin:cloth", &scene, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    while (weft_scene_info(scene).light_count > 0)
        assert_int_equal(weft_scene_remove_light(scene, 0, &error), WEFT_OK);
    assert_int_equal(weft_scene_add_light(scene, &light, &error), WEFT_OK);
    assert_int_equal(weft_scene_set_environment_color(scene, (const float[]){0.0f, 0.0f, 0.0f}, &error),
                     WEFT_OK);
    if (weft_scene_assign_material_memory(scene, NULL, weave, strlen(weave), "mine.json", NULL, &error) !=
        WEFT_OK)
        fail_msg("%s", error.text);
    return scene;
}

static void trace(const WeftScene *scene, const char *camera, int samples, WeftImage *out) {
    WeftRender *render;
    WeftError error;
    const WeftRenderDesc desc = {.width = WIDTH,
                                 .height = HEIGHT,
                                 .max_depth = 1,
                                 .camera = camera,
                                 .background = WEFT_BACKGROUND_TRANSPARENT,
                                 .pixel_centre = samples == 1,
                                 .no_shadows = 1,
                                 .no_roulette = 1};
    if (weft_render_create(scene, &desc, &render, &error) != WEFT_OK) fail_msg("%s", error.text);
    assert_int_equal(weft_render_run(render, samples, 0.0, NULL, NULL), WEFT_OK);
    assert_int_equal(weft_render_image(render, out, &error), WEFT_OK);
    weft_render_free(render);
}

static void draw(const WeftScene *scene, WeftGl gl, const char *camera, WeftImage *out) {
    WeftRaster *raster;
    WeftError error;
    const WeftRasterView view = {.width = WIDTH,
                                 .height = HEIGHT,
                                 .samples = 1,
                                 .camera = camera,
                                 .background = WEFT_BACKGROUND_TRANSPARENT,
                                 .no_shadows = 1,
                                 .plain_textures = 1};
    if (weft_raster_create(scene, &(WeftRasterDesc){.gl = gl}, &raster, NULL, &error) != WEFT_OK ||
        weft_raster_draw(raster, &view, &error) != WEFT_OK ||
        weft_raster_image(raster, out, &error) != WEFT_OK)
        fail_msg("%s", error.text);
    assert_string_equal(weft_raster_info(raster).complaint, "");
    assert_true(weft_raster_info(raster).samplers <= 16);
    weft_raster_free(raster);
}

static const char *const denim =
    "{\"weave\": {\"draft\": \"twill 3/1 z; warp 1#26375c; weft 1#d8d4c8; sett 26 18\", "
    "\"warp\": \"cotton\", \"weft\": \"cotton\", \"metres\": 0.5}}";
static const char *const tartan = "{\"weave\": {\"draft\": \"twill 2/2; both 8b 4r 8g 2w; sett 22\", "
                                  "\"warp\": \"wool\", \"weft\": \"wool\", \"metres\": 0.5}}";
static const WeftGl gls[] = {WEFT_GL_DESKTOP, WEFT_GL_ES};

/* A pixel is a tenth of a thread: one point of it. Edges of threads may lie on either side of a pixel's middle. */
static void threads_are_the_same_in_both_engines(void **state) {
    (void)state;
    need_gl();
    WeftScene *scene = scene_of(denim);
    static const char camera[] = "0.25,0.62,0.65;0.03,0.42,0.15;0.4";
    WeftImage reference, picture;
    trace(scene, camera, 1, &reference);
    for (size_t g = 0; g < 2; g++) {
        int agree = 0, lit = 0;
        draw(scene, gls[g], camera, &picture);
        const float *p = reference.pixels, *q = picture.pixels;
        for (int k = 0; k < PIXELS; k++) {
            bool same = true;
            for (int c = 0; c < 3; c++)
                same &= fabsf(p[4 * k + c] - q[4 * k + c]) <= 0.02f * p[4 * k + c] + 2e-3f;
            agree += same;
            lit += p[4 * k] > 1e-3f;
        }
        print_message("threads: %.2f %% of the pixels agree\n", 100.0 * agree / PIXELS);
        assert_true(lit > PIXELS / 2);
        assert_true(agree > 0.97 * PIXELS);
        weft_image_free(&picture);
    }
    weft_image_free(&reference);
    weft_scene_free(scene);
}

/* The mean over a picture's pixels of a channel. */
static double mean_of(const WeftImage *image, int c) {
    const float *p = image->pixels;
    double sum = 0.0;
    for (int k = 0; k < PIXELS; k++) sum += (double)p[4 * k + c] / PIXELS;
    return sum;
}

static void a_cloth_is_as_bright_in_both_engines(void **state) {
    (void)state;
    need_gl();
    static const char *const weaves[] = {denim, tartan};
    static const char *const cameras[] = {"0.25,0.62,0.65;0.03,0.42,0.15;1.5",
                                          "0.25,0.62,0.65;0.03,0.42,0.15;4",
                                          "0.25,0.62,0.65;0.03,0.42,0.15;14"};
    for (size_t w = 0; w < 2; w++) {
        WeftScene *scene = scene_of(weaves[w]);
        for (size_t d = 0; d < sizeof cameras / sizeof *cameras; d++) {
            WeftImage reference, picture;
            trace(scene, cameras[d], 16, &reference);
            draw(scene, WEFT_GL_DESKTOP, cameras[d], &picture);
            for (int c = 0; c < 3; c++) {
                const double a = mean_of(&reference, c), b = mean_of(&picture, c);
                print_message("weave %zu, distance %zu, channel %d: %.4f and %.4f\n", w, d, c, a, b);
                assert_true(fabs(a - b) < 0.03 * a + 1e-4);
            }
            weft_image_free(&reference);
            weft_image_free(&picture);
        }
        weft_scene_free(scene);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(threads_are_the_same_in_both_engines),
                                       cmocka_unit_test(a_cloth_is_as_bright_in_both_engines)};
    return cmocka_run_group_tests(tests, gl_begin, NULL);
}
