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

/* A scene with some numbers set, a cloth of a preset if it has one, and the largest difference of a picture in motion. */
typedef struct Case {
    const char *scene, *settings[3][2], *preset;
    WeftFloor floor;
    float opacity; /* of all materials, which blend; 0: they are as they come */
    int rate;
    double most;
} Case;

static void check_case(const Case *at, WeftGl gl) {
    WeftScene *scene = load(at->scene);
    WeftError error;
    for (int k = 0; k < 3 && at->settings[k][0]; k++) set(scene, at->settings[k][0], at->settings[k][1]);
    if (at->preset && weft_scene_assign_material(scene, "Cloth", at->preset, NULL, &error) != WEFT_OK)
        fail_msg("%s", error.text);
    for (int k = 0; k < scene->material_count && at->opacity > 0.0f; k++) {
        scene->materials[k].alpha_mode = WEFT_ALPHA_BLEND;
        scene->materials[k].inputs[INPUT_opacity].value[0] = at->opacity;
    }
    WeftRaster *raster = raster_of(scene, gl);
    WeftRasterView view = {.width = WIDTH, .height = HEIGHT, .samples = 1, .camera = "0", .floor = at->floor};
    view.background = WEFT_BACKGROUND_TRANSPARENT;
    WeftImage rest = picture(raster, &view);
    view.shading_rate = at->rate;
    WeftImage moving = picture(raster, &view);
    const double off = difference(&moving, &rest);
    print_message("%s%s%s %s%s, one point for %d x %d pixels: %.4f\n", at->scene, at->preset ? ", " : "",
                  at->preset ? at->preset : "", at->settings[0][0] ? at->settings[0][1] : "as it comes",
                  at->floor.on         ? ", floor"
                  : at->opacity > 0.0f ? ", blended"
                                       : "",
                  at->rate, at->rate, off);
    assert_true(off < at->most && (off > 0.0 || at->opacity > 0.0f)); /* what blends has all its points */
    if (!at->floor.on) assert_same_outline(&moving, &rest);
    weft_image_free(&rest);
    weft_image_free(&moving);
    weft_raster_free(raster);
    weft_scene_free(scene);
}

static void moving_pictures_are_those_at_rest(void **state) {
    (void)state;
    need_gl();
    static const Case cases[] = {
        {.scene = "builtin:cloth", .rate = 2, .most = 0.04},
        {.scene = "builtin:cloth", .rate = 4, .most = 0.06},
        {.scene = "builtin:cloth", .settings = {{"*.sheen_lobe", "fibre-table"}}, .rate = 4, .most = 0.06},
        {.scene = "builtin:spheres", .settings = {{"*.sheen_lobe", "charlie-neubelt"}}, .rate = 3, .most = 0.08},
        {.scene = "builtin:cloth", .preset = "preset:woven-denim", .rate = 3, .most = 0.08},
        {.scene = "builtin:cloth", .preset = "preset:woven-charmeuse", .rate = 3, .most = 0.08},
        {.scene = "builtin:cloth", .preset = "preset:woven-linen", .rate = 4, .most = 0.08}};
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++)
        check_case(&cases[k], k % 2 ? WEFT_GL_ES : WEFT_GL_DESKTOP);
}

/* Highlights narrower than the points of a square of pixels, a floor that mirrors, and what blends. */
static void narrow_mirrored_and_blended_light_is_near(void **state) {
    (void)state;
    need_gl();
    static const Case cases[] = {
        {.scene = "builtin:spheres",
         .settings = {{"*.roughness", "0.1"}, {"*.metallic", "1"}, {"*.sheen_color", "0"}},
         .rate = 3,
         .most = 0.03},
        {.scene = "builtin:spheres",
         .settings = {{"*.roughness", "0.2"}, {"*.clearcoat", "1"}, {"*.clearcoat_roughness", "0.1"}},
         .rate = 4,
         .most = 0.03},
        {.scene = "builtin:spheres", .floor = {.on = 1, .reflection = 0.3f}, .rate = 3, .most = 0.03},
        {.scene = "builtin:spheres", .opacity = 0.6f, .rate = 3, .most = 0.03}};
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++)
        check_case(&cases[k], k % 2 ? WEFT_GL_ES : WEFT_GL_DESKTOP);
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
        cmocka_unit_test(moving_pictures_are_those_at_rest),
        cmocka_unit_test(narrow_mirrored_and_blended_light_is_near), cmocka_unit_test(outlines_have_all_their_pixels),
        cmocka_unit_test(strips_are_parts_of_the_whole), cmocka_unit_test(other_rates_are_refused)};
    return cmocka_run_group_tests(tests, gl_begin, NULL);
}
