/* A picture in motion has a shading point for a square of pixels: it is the picture at rest but for a few parts in a
 * hundred, with all of its outlines, and what blends, in strips as in one piece, by both kinds of OpenGL. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "gl.h"
#include "trace/scenes.h"

enum { WIDTH = 320, HEIGHT = 180 };

static WeftRaster *raster_of(const WeftScene *scene, WeftGl gl) {
    WeftRaster *raster;
    WeftError error;
    if (weft_raster_create(scene, &(WeftRasterDesc){.gl = gl, .threads = 2}, &raster, NULL, &error) != WEFT_OK)
        fail_msg("%s", error.text);
    return raster;
}

static WeftImage picture(WeftRaster *raster, const WeftRasterView *view) {
    WeftImage image = {0};
    WeftError error;
    if (weft_raster_draw(raster, view, &error) != WEFT_OK || weft_raster_image(raster, &image, &error) != WEFT_OK)
        fail_msg("%s", error.text);
    return image;
}

static size_t numbers(const WeftImage *image) { return 4 * (size_t)image->width * (size_t)image->height; }

/* Returns the sum of absolute differences of colours over their sum. */
static double difference(const WeftImage *image, const WeftImage *reference) {
    const float *a = image->pixels, *b = reference->pixels;
    double off = 0.0, sum = 0.0;
    for (size_t k = 0; k < numbers(reference); k++) {
        if (k % 4 == 3) continue;
        off += fabs((double)a[k] - (double)b[k]);
        sum += (double)b[k];
    }
    return off / sum;
}

static void assert_same_outline(const WeftImage *image, const WeftImage *reference) {
    const float *a = image->pixels, *b = reference->pixels;
    for (size_t k = 3; k < numbers(reference); k += 4) assert_float_equal(a[k], b[k], 1e-3f);
}

static WeftScene *load(const char *name) {
    WeftScene *scene;
    WeftError error;
    if (weft_scene_load(name, &scene, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    return scene;
}

static void set(WeftScene *scene, const char *key, const char *value) {
    WeftError error;
    if (weft_scene_set(scene, key, value, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
}

static void moving_pictures_are_those_at_rest(void **state) {
    (void)state;
    need_gl();
    static const struct {
        const char *scene, *key, *value;
        int rate;
        double most;
    } cases[] = {{"builtin:cloth", NULL, NULL, 2, 0.04},
                 {"builtin:cloth", NULL, NULL, 4, 0.06},
                 {"builtin:cloth", "*.sheen_lobe", "fibre-table", 4, 0.06},
                 {"builtin:spheres", "*.sheen_lobe", "charlie-neubelt", 3, 0.08},
                 {"builtin:cloth", "preset", "woven-denim", 3, 0.08}};
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        WeftScene *scene = load(cases[k].scene);
        WeftError error;
        if (cases[k].key && cases[k].key[0] == '*') set(scene, cases[k].key, cases[k].value);
        if (cases[k].key && cases[k].key[0] == 'p' &&
            weft_scene_assign_material(scene, "Cloth", "preset:woven-denim", NULL, &error) != WEFT_OK)
            fail_msg("%s", error.text);
        WeftRaster *raster = raster_of(scene, k % 2 ? WEFT_GL_ES : WEFT_GL_DESKTOP);
        WeftRasterView view = {.width = WIDTH, .height = HEIGHT, .samples = 1, .camera = "0"};
        view.background = WEFT_BACKGROUND_TRANSPARENT;
        WeftImage rest = picture(raster, &view);
        view.shading_rate = cases[k].rate;
        WeftImage moving = picture(raster, &view);
        const double off = difference(&moving, &rest);
        print_message("%s, %s, one point for %d x %d pixels: %.4f\n", cases[k].scene,
                      cases[k].value ? cases[k].value : "as it comes", cases[k].rate, cases[k].rate, off);
        assert_true(off > 0.0 && off < cases[k].most);
        assert_same_outline(&moving, &rest);
        weft_image_free(&rest);
        weft_image_free(&moving);
        weft_raster_free(raster);
        weft_scene_free(scene);
    }
}

/* Two unlit quads with slanting sides, one before the other and of other brightness, and a veil over both. */
static WeftScene *slanting(float veil) {
    WeftScene *scene = test_scene();
    test_material(scene, 1.0f)->unlit = true;
    test_quad(scene, vec3(-1.0f, -0.8f, 0.5f), vec3(1.3f, 0.4f, 0.0f), vec3(-0.1f, 1.1f, 0.0f));
    test_material(scene, 0.25f)->unlit = true;
    test_quad(scene, vec3(-0.7f, -1.1f, -1.0f), vec3(1.7f, 0.3f, 0.0f), vec3(0.2f, 1.9f, 0.0f));
    if (veil > 0.0f) {
        Material *material = test_material(scene, 0.5f);
        material->unlit = true;
        material->alpha_mode = WEFT_ALPHA_BLEND;
        material->inputs[INPUT_opacity].value[0] = veil;
        test_quad(scene, vec3(-0.5f, -0.6f, 1.0f), vec3(1.0f, 0.1f, 0.0f), vec3(0.0f, 1.0f, 0.0f));
    }
    scene_bounds(scene);
    test_environment(scene, 0.0f);
    return scene;
}

/* Light of one surface does not come to another, if a point lies on each. */
static void outlines_have_all_their_pixels(void **state) {
    (void)state;
    need_gl();
    WeftRasterView view = {.width = 97, .height = 61, .samples = 1, .camera = "0,0,4;0,0,0;40"};
    view.background = WEFT_BACKGROUND_TRANSPARENT;
    for (int veil = 0; veil < 2; veil++) {
        WeftScene *scene = slanting(veil ? 0.6f : 0.0f);
        WeftRaster *raster = raster_of(scene, WEFT_GL_DESKTOP);
        view.shading_rate = 0;
        WeftImage rest = picture(raster, &view);
        for (int rate = 2; rate <= 7; rate++) {
            view.shading_rate = rate;
            WeftImage moving = picture(raster, &view);
            assert_same_outline(&moving, &rest);
            assert_true(difference(&moving, &rest) < 2e-3);
            weft_image_free(&moving);
        }
        weft_image_free(&rest);
        weft_raster_free(raster);
        weft_scene_free(scene);
    }
}

static void strips_are_parts_of_the_whole(void **state) {
    (void)state;
    need_gl();
    WeftScene *scene = load("builtin:cloth");
    WeftRaster *raster = raster_of(scene, WEFT_GL_DESKTOP);
    WeftRasterView view = {.width = 160, .height = 90, .samples = 1, .camera = "0", .shading_rate = 3};
    WeftImage whole = picture(raster, &view);
    const int strip[4] = {20, 31, 101, 26};
    memcpy(view.crop, strip, sizeof strip);
    WeftImage part = picture(raster, &view);
    for (int y = strip[1]; y < strip[1] + strip[3]; y++) {
        const size_t at = 4 * ((size_t)y * 160 + (size_t)strip[0]);
        assert_memory_equal((const float *)part.pixels + at, (const float *)whole.pixels + at,
                            (size_t)strip[2] * 4 * sizeof(float));
    }
    weft_image_free(&whole);
    weft_image_free(&part);
    weft_raster_free(raster);
    weft_scene_free(scene);
}

static void other_rates_are_refused(void **state) {
    (void)state;
    need_gl();
    WeftScene *scene = slanting(0.0f);
    WeftRaster *raster = raster_of(scene, WEFT_GL_DESKTOP);
    for (int k = 0; k < 2; k++) {
        const WeftRasterView view = {.width = 16, .height = 16, .shading_rate = k ? 9 : -1};
        WeftError error = {0};
        assert_int_not_equal(weft_raster_draw(raster, &view, &error), WEFT_OK);
        assert_int_equal(error.message, WEFT_MESSAGE_DESC);
        assert_non_null(strstr(error.text, "shading rate"));
    }
    weft_raster_free(raster);
    weft_scene_free(scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(moving_pictures_are_those_at_rest), cmocka_unit_test(outlines_have_all_their_pixels),
        cmocka_unit_test(strips_are_parts_of_the_whole), cmocka_unit_test(other_rates_are_refused)};
    return cmocka_run_group_tests(tests, gl_begin, NULL);
}
