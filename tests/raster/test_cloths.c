/* Both engines weave the same cloth: near by pixel for pixel, and from afar as bright on the mean. At every distance the
 * pixels of the raster engine are as bright as those of many points of threads, and vary as they do.
 *
 * Numbers of many points are compared here; raster/motion, raster/backs and weave/cloth draw and shade cloth under sanitizers.
 *
 * Labels: slow unsanitized */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "raster/gl.h"

#include "base/random.h"
#include "scene/record/scene.h"
#include "shading/cases.h"
#include "trace/scenes.h"
#include "weave/cloth_base.h"
#include "weft/weft.h"

enum { WIDTH = 240, HEIGHT = 160, PIXELS = WIDTH * HEIGHT };

static WeftScene *scene_of(const char *weave) {
    WeftScene *scene;
    WeftError error;
    const WeftLight light = {.direction = {-1.0f, -2.0f, -1.0f}, .color = {3.0f, 3.0f, 3.0f}};
    if (weft_scene_load("builtin:cloth", &scene, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    while (weft_scene_info(scene).light_count > 0) assert_int_equal(weft_scene_remove_light(scene, 0, &error), WEFT_OK);
    assert_int_equal(weft_scene_add_light(scene, &light, &error), WEFT_OK);
    assert_int_equal(weft_scene_set_environment_color(scene, (const float[]){0.0f, 0.0f, 0.0f}, &error), WEFT_OK);
    if (weft_scene_assign_material_memory(scene, NULL, weave, strlen(weave), "mine.json", NULL, &error) != WEFT_OK)
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
        weft_raster_draw(raster, &view, &error) != WEFT_OK || weft_raster_image(raster, out, &error) != WEFT_OK)
        fail_msg("%s", error.text);
    assert_string_equal(weft_raster_info(raster).complaint, "");
    assert_true(weft_raster_info(raster).samplers <= 16);
    weft_raster_free(raster);
}

static const char *const denim = "{\"weave\": {\"draft\": \"twill 3/1 z; warp 1#26375c; weft 1#d8d4c8; sett 26 18\", "
                                 "\"warp\": \"cotton\", \"weft\": \"cotton\", \"metres\": 0.5}}";
static const char *const worn = "{\"weave\": {\"draft\": \"twill 3/1 z; warp 1#26375c; weft 1#d8d4c8; sett 26 18\", "
                                "\"warp\": \"cotton\", \"weft\": \"cotton\", \"metres\": 0.5}, \"wear\": 0.7}";
static const char *const tartan = "{\"weave\": {\"draft\": \"twill 2/2; both 8b 4r 8g 2w; sett 22\", "
                                  "\"warp\": \"wool\", \"weft\": \"wool\", \"metres\": 0.5}}";
static const WeftGl gls[] = {WEFT_GL_DESKTOP, WEFT_GL_ES};

/* A pixel is an eleventh of a thread that has no fibres, or fine enough for fibres, the loose ones too: one point. Edges may
 * lie on either side of its middle. */
static void threads_are_the_same_in_both_engines(void **state) {
    (void)state;
    need_gl();
    static const char smooth[] =
        "{\"weave\": {\"draft\": \"twill 3/1 z; warp 1#26375c; weft 1#d8d4c8; sett 26 18\", "
        "\"warp\": {\"yarn\": \"cotton\", \"streaks\": 0, \"hairiness\": 0}, "
        "\"weft\": {\"yarn\": \"cotton\", \"streaks\": 0, \"hairiness\": 0}, \"metres\": 0.5}}";
    static const char *const weaves[] = {smooth, denim};
    static const char *const cameras[] = {"0.25,0.62,0.65;0.03,0.42,0.15;0.35", "0.25,0.62,0.65;0.03,0.42,0.15;0.06"};
    for (size_t w = 0; w < 2; w++) {
        WeftScene *scene = scene_of(weaves[w]);
        WeftImage reference = {0}, picture = {0};
        trace(scene, cameras[w], 1, &reference);
        for (size_t g = 0; g < 2; g++) {
            int agree = 0, lit = 0;
            draw(scene, gls[g], cameras[w], &picture);
            const float *p = reference.pixels, *q = picture.pixels;
            for (int k = 0; k < PIXELS; k++) {
                bool same = true;
                for (int c = 0; c < 3; c++) same &= fabsf(p[4 * k + c] - q[4 * k + c]) <= 0.02f * p[4 * k + c] + 2e-3f;
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
    static const char *const weaves[] = {denim, tartan, worn};
    static const char *const cameras[] = {"0.25,0.62,0.65;0.03,0.42,0.15;1.5", "0.25,0.62,0.65;0.03,0.42,0.15;4",
                                          "0.25,0.62,0.65;0.03,0.42,0.15;14"};
    for (size_t w = 0; w < sizeof weaves / sizeof *weaves; w++) {
        WeftScene *scene = scene_of(weaves[w]);
        for (size_t d = 0; d < sizeof cameras / sizeof *cameras; d++) {
            WeftImage reference = {0}, picture = {0};
            trace(scene, cameras[d], 16, &reference);
            draw(scene, WEFT_GL_DESKTOP, cameras[d], &picture);
            for (int c = 0; c < 3; c++) {
                const double a = mean_of(&reference, c), b = mean_of(&picture, c);
                print_message("weave %zu, distance %zu, channel %d: %.4f and %.4f\n", w, d, c, a, b);
                assert_true(fabs(a - b) < 0.01 * a + 1e-4);
            }
            weft_image_free(&reference);
            weft_image_free(&picture);
        }
        weft_scene_free(scene);
    }
}

/* A flat cloth of 20 threads a centimetre that is looked at from above, so many threads a pixel. The long run has more
 * pixels, by which chance moves their mean less, as far as there is cloth. */
enum { SUNS = 3, FINE = 10 };
static const float SPAN = 5.0f; /* metres */
static int pixels_across(float side) {
    const int most = test_long() ? 384 : 96, cloth = (int)(2000.0f * SPAN / side);
    return cloth < most ? cloth & ~1 : most;
}
static const Dir suns[SUNS] = {{0.383f, 0.321f, 0.866f}, {-0.814f, -0.296f, 0.5f}, {0.163f, -0.926f, 0.342f}};

static WeftScene *flat_scene(const char *weave, Dir sun) {
    WeftScene *scene = test_scene();
    WeftError error;
    const WeftLight light = {.direction = {-sun.x, -sun.y, -sun.z}, .color = {3.0f, 3.0f, 3.0f}};
    const float half = 0.5f * SPAN;
    test_environment(scene, 0.0f);
    test_material(scene, 0.5f);
    (void)test_sheet(scene, vec3(-half, -half, 0.0f), vec3(SPAN, 0.0f, 0.0f), vec3(0.0f, SPAN, 0.0f));
    scene->low = vec3(-half, -half, 0.0f);
    scene->high = vec3(half, half, 0.0f);
    assert_int_equal(weft_scene_add_light(scene, &light, &error), WEFT_OK);
    if (weft_scene_assign_material_memory(scene, NULL, weave, strlen(weave), "mine.json", NULL, &error) != WEFT_OK)
        fail_msg("%s", error.text);
    return scene;
}

/* Adds a part of the mean over a pixel of FINE x FINE points of threads, in two channels. All points are looked at in one
 * call: each is padded to a vector. */
static void see_pixel(const WeftCloth *cloth, float x, float y, float side, Dir sun, uint64_t *random, double part,
                      double sum[2]) {
    enum { POINTS = FINE * FINE };
    static ClothLooks looks;
    static YarnRows yarn;
    const Angles a = angles_between(dir(0.0f, 0.0f, 1.0f), sun);
    for (int n = 0; n < POINTS; n++) {
        const int row = n / FINE, column = n % FINE;
        const float u = x + side * ((float)column + unit_float((uint32_t)(stream_next(random) >> 32))) / FINE,
                    v = y + side * ((float)row + unit_float((uint32_t)(stream_next(random) >> 32))) / FINE;
        looks.uv[0][n] = u / cloth->per_uv[WEFT_WARP];
        looks.uv[1][n] = -v / cloth->per_uv[WEFT_WEFT];
    }
    cloth_bases(cloth, &looks, POINTS, &yarn, NULL);
    for (int n = 0; n < POINTS; n++) {
        const Lobe lobe = yarn_of_row(&yarn, (size_t)n);
        const LobeValue value = lobe_value(&lobe, a);
        const double f = part * 3.0 * (double)(value.f * sun.z) / POINTS, s = (double)value.s;
        sum[0] += f * ((double)yarn.single[0][n] * (1.0 - s) + (double)yarn.multiple[0][n] * s);
        sum[1] += f * ((double)yarn.single[2][n] * (1.0 - s) + (double)yarn.multiple[2][n] * s);
    }
}

/* Means over the pixels of a picture, and of their squares. */
typedef struct Spread {
    double mean[2], square[2];
} Spread;

static void add_pixel(Spread *s, const double pixel[2], int count) {
    for (int c = 0; c < 2; c++) {
        s->mean[c] += pixel[c] / count;
        s->square[c] += pixel[c] * pixel[c] / count;
    }
}
static double variance(const Spread *s) {
    double sum = 0.0;
    for (int c = 0; c < 2; c++) sum += s->square[c] / (s->mean[c] * s->mean[c]) - 1.0;
    return sum;
}

/* The left edge of column k, and the lower one of row k, counted from the middle, in threads: picks count up to 0 at the
 * upper edge of the texture. */
static float left_of(float side, int k) { return 1000.0f * SPAN + side * (float)k; }
static float low_of(float side, int k) { return -1000.0f * SPAN + side * (float)k; }

/* Adds what a picture shows at such a distance, and what it should. */
static void compare(WeftRaster *raster, const WeftCloth *cloth, Dir sun, float side, Spread *seen, Spread *fine) {
    WeftError error;
    WeftImage picture = {0};
    char camera[96];
    const int across = pixels_across(side);
    const float height = side * (float)across / 2000.0f / (2.0f * tanf(2.0f * PI_FLOAT / 180.0f));
    uint64_t random = stream_start(1, 29);
    /* the farthest picture has few pixels, so the long run looks at each more often */
    const int looks = test_long() && side > 50.0f ? 16 : 1;
    snprintf(camera, sizeof camera, "0,0,%g;0,0,0;4", (double)height);
    const WeftRasterView view = {.width = across,
                                 .height = across,
                                 .samples = 1,
                                 .camera = camera,
                                 .background = WEFT_BACKGROUND_TRANSPARENT,
                                 .no_shadows = 1};
    if (weft_raster_draw(raster, &view, &error) != WEFT_OK || weft_raster_image(raster, &picture, &error) != WEFT_OK)
        fail_msg("%s", error.text);
    const float *p = picture.pixels;
    for (int row = 0; row < across; row++)
        for (int column = 0; column < across; column++) {
            const float *at = p + 4 * (row * across + column);
            double pixel[2] = {0.0, 0.0};
            add_pixel(seen, (const double[]){(double)at[0], (double)at[2]}, across * across);
            for (int k = 0; k < looks; k++)
                see_pixel(cloth, left_of(side, column - across / 2), low_of(side, across / 2 - 1 - row), side, sun,
                          &random, 1.0 / looks, pixel);
            add_pixel(fine, pixel, across * across);
        }
    weft_image_free(&picture);
}

static void pixels_vary_as_those_of_many_points_do(void **state) {
    (void)state;
    need_gl();
    static const char weave[] = "{\"weave\": {\"draft\": \"twill 3/1 z; warp 1#26375c; weft 1#d8d4c8; sett 20 20\", "
                                "\"warp\": \"cotton\", \"weft\": \"cotton\", \"metres\": 5}}";
    static const float sides[] = {0.11f, 0.27f, 0.53f, 1.07f, 1.5f, 1.9f, 4.1f, 16.3f, 100.0f};
    enum { SIDES = sizeof sides / sizeof *sides };
    Spread seen[SIDES][SUNS] = {{{{0.0}, {0.0}}}}, fine[SIDES][SUNS] = {{{{0.0}, {0.0}}}};
    for (int k = 0; k < SUNS; k++) {
        WeftScene *scene = flat_scene(weave, suns[k]);
        WeftRaster *raster = NULL;
        WeftError error;
        if (weft_raster_create(scene, &(WeftRasterDesc){.gl = WEFT_GL_DESKTOP}, &raster, NULL, &error) != WEFT_OK)
            fail_msg("%s", error.text);
        for (int d = 0; d < SIDES; d++) compare(raster, scene->cloths[0], suns[k], sides[d], &seen[d][k], &fine[d][k]);
        weft_raster_free(raster);
        weft_scene_free(scene);
    }
    double first = 0.0; /* variance of the picture nearest by, of single points */
    for (int d = 0; d < SIDES; d++) {
        double error = 0.0, worst = 0.0, kept = 0.0, spread = 0.0;
        for (int k = 0; k < SUNS; k++) {
            for (int c = 0; c < 2; c++) {
                const double e = fabs(seen[d][k].mean[c] / fine[d][k].mean[c] - 1.0);
                error += e / (2 * SUNS);
                worst = fmax(worst, e);
            }
            kept += variance(&seen[d][k]);
            spread += variance(&fine[d][k]);
        }
        print_message("%6.2f threads a pixel: mean %.4f worst %.4f, variance %.4f, %.3f of the reference's\n",
                      (double)sides[d], error, worst, kept / SUNS, kept / spread);
        /* the long run's chance is less */
        assert_true(error < (test_long() ? 0.005 : 0.009));
        assert_true(worst < (test_long() ? 0.009 : 0.012));
        first = d ? first : kept;
        if (sides[d] <= 2.0f)
            assert_true(kept > 0.75 * spread && kept < 1.25 * spread);
        else
            assert_true(kept < 0.1 * first);
    }
}

/* Returns the light of a floor below a loose cloth that the sun shines on from above. */
static double floor_below(const char *alpha_mode, int no_shadows) {
    WeftScene *scene = test_scene();
    WeftRaster *raster = NULL;
    WeftImage picture = {0};
    WeftError error;
    char weave[256];
    const WeftLight light = {.direction = {0.0f, 0.0f, -1.0f}, .color = {3.0f, 3.0f, 3.0f}};
    test_environment(scene, 0.0f);
    test_material(scene, 0.5f);
    (void)test_sheet(scene, vec3(-0.2f, -0.2f, 0.2f), vec3(0.4f, 0.0f, 0.0f), vec3(0.0f, 0.4f, 0.0f));
    scene->material_names[0] = "cloth";
    test_material(scene, 0.5f);
    (void)test_quad(scene, vec3(-0.2f, -0.2f, 0.0f), vec3(0.4f, 0.0f, 0.0f), vec3(0.0f, 0.4f, 0.0f));
    scene->low = vec3(-0.2f, -0.2f, 0.0f);
    scene->high = vec3(0.2f, 0.2f, 0.2f);
    snprintf(weave, sizeof weave,
             "{\"weave\": {\"draft\": \"plain; sett 4 4\", \"warp\": {\"yarn\": \"linen\", \"width\": 0.6}, "
             "\"weft\": {\"yarn\": \"linen\", \"width\": 0.6}, \"metres\": 0.4}, \"alpha_mode\": \"%s\"}",
             alpha_mode);
    const WeftRasterView view = {
        .width = WIDTH, .height = HEIGHT, .samples = 1, .camera = "0,0,0.15;0,0,0;30", .no_shadows = no_shadows};
    if (weft_scene_add_light(scene, &light, &error) != WEFT_OK ||
        weft_scene_assign_material_memory(scene, "cloth", weave, strlen(weave), "mine.json", NULL, &error) != WEFT_OK ||
        weft_raster_create(scene, &(WeftRasterDesc){.gl = WEFT_GL_DESKTOP}, &raster, NULL, &error) != WEFT_OK ||
        weft_raster_draw(raster, &view, &error) != WEFT_OK || weft_raster_image(raster, &picture, &error) != WEFT_OK)
        fail_msg("%s", error.text);
    const double mean = mean_of(&picture, 1);
    weft_image_free(&picture);
    weft_raster_free(raster);
    weft_scene_free(scene);
    return mean;
}

static void light_falls_through_gaps(void **state) {
    (void)state;
    need_gl();
    const double bare = floor_below("mask", 1), closed = floor_below("opaque", 0), holed = floor_below("mask", 0);
    print_message("below a cloth: %.3f of the light through gaps, %.3f without\n", holed / bare, closed / bare);
    assert_true(closed < 0.01 * bare);
    assert_true(holed > 0.08 * bare && holed < 0.3 * bare);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pixels_vary_as_those_of_many_points_do), cmocka_unit_test(light_falls_through_gaps),
        cmocka_unit_test(threads_are_the_same_in_both_engines), cmocka_unit_test(a_cloth_is_as_bright_in_both_engines)};
    return cmocka_run_group_tests(tests, gl_begin, NULL);
}
