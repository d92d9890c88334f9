/* Hair at an outline: both engines see as much of it at each height over a cloth that is seen edge-on, near and from afar, and
 * in the same light; sums of frames have its light, where a texture has no room for all fibres too; a raster and a render
 * that are updated see what new ones see.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "raster/gl.h"
#include "raster/light/ray_scene.h"
#include "scene/material/hair.h"
#include "trace/scenes.h"

/* Pixels of half a millimetre, the lowest row at the cloth. */
enum { ACROSS = 256, ROWS = 16 };
static const char *const camera = "0,0.004,2;0,0.004,0;0.22918";

/* A level square with sides of so many metres. */
static WeftScene *square_of(float side) {
    WeftScene *scene = test_scene();
    test_material(scene, 0.5f);
    test_quad(scene, vec3(-0.5f * side, 0.0f, 0.5f * side), vec3(side, 0.0f, 0.0f), vec3(0.0f, 0.0f, -side));
    scene_bounds(scene);
    test_environment(scene, 1.0f);
    return scene;
}

static WeftScene *square(void) { return square_of(0.2f); }

static void set(WeftScene *scene, const char *target, const char *value) {
    WeftError error;
    if (weft_scene_set(scene, target, value, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
}

static WeftRaster *raster_of(const WeftScene *scene) {
    WeftRaster *raster;
    WeftError error;
    const WeftRasterDesc desc = {.threads = 1, .occlusion = 16, .no_cache = 1};
    if (weft_raster_create(scene, &desc, &raster, NULL, &error) != WEFT_OK ||
        weft_raster_wait(raster, &error) != WEFT_OK)
        fail_msg("%s", error.text);
    return raster;
}

static WeftImage drawn(WeftRaster *raster) {
    const WeftRasterView view = {
        .width = ACROSS, .height = ROWS, .samples = 8, .camera = camera, .background = WEFT_BACKGROUND_TRANSPARENT};
    WeftImage image = {0};
    WeftError error;
    if (weft_raster_draw(raster, &view, &error) != WEFT_OK || weft_raster_image(raster, &image, &error) != WEFT_OK)
        fail_msg("%s", error.text);
    return image;
}

static const WeftRenderDesc desc = {.width = ACROSS,
                                    .height = ROWS,
                                    .max_depth = 1,
                                    .camera = "0,0.004,2;0,0.004,0;0.22918",
                                    .background = WEFT_BACKGROUND_TRANSPARENT};

/* The part of each row that is covered, from the top, and the light of what covers it. */
typedef struct Profile {
    double covered[ROWS], light;
} Profile;

static Profile profile_of(WeftImage *image) {
    Profile profile = {.light = 0.0};
    double all = 0.0;
    for (int k = 0; k < ACROSS * ROWS; k++) {
        const float *pixel = (const float *)image->pixels + 4 * k;
        profile.covered[k / ACROSS] += (double)pixel[3] / ACROSS;
        profile.light += (double)(pixel[1] * pixel[3]), all += (double)pixel[3];
    }
    profile.light /= fmax(all, 1e-9);
    weft_image_free(image);
    return profile;
}

static void engines_see_as_much_hair_at_each_height(void **state) {
    (void)state;
    need_gl();
    WeftScene *scene = square();
    set(scene, "*.hair_density", "100000");
    set(scene, "*.hair_length", "0.006");
    WeftRaster *raster = raster_of(scene);
    WeftImage image = drawn(raster), reference = test_render(scene, desc, 64);
    const Profile is = profile_of(&image), should = profile_of(&reference);
    double worst = 0.0, sums[2] = {0.0, 0.0};
    for (int row = 0; row < ROWS; row++) {
        print_message("%4.2f mm: covered %.3f, traced %.3f\n", 0.5 * (ROWS - row - 0.5), is.covered[row],
                      should.covered[row]);
        worst = fmax(worst, fabs(is.covered[row] - should.covered[row]));
        sums[0] += is.covered[row], sums[1] += should.covered[row];
    }
    print_message("together %.3f and %.3f rows, light %.3f and %.3f\n", sums[0], sums[1], is.light, should.light);
    assert_true(should.covered[ROWS - 2] > 0.3 && should.covered[0] < 0.01);
    assert_true(worst < 0.06);
    assert_true(fabs(sums[0] / sums[1] - 1.0) < 0.03);
    /* a sky all around, of which the cloth hides half from its hair */
    assert_true(fabs(is.light / should.light - 1.0) < 0.1);
    weft_raster_free(raster);
    weft_scene_free(scene);
}

/* Pixels of 2 mm: a fibre is a thirtieth of one. The rows are those of 32 mm, the cloth below the last four. */
enum { FAR_ACROSS = 64, FAR_ROWS = 16, FAR_CLOTH = 4 };

/* Prints and returns the mean over the rows above the cloth, and sets the root of the mean square of the difference of
 * single pixels from those of the other picture. */
static double band_of(const WeftImage *image, const WeftImage *other, double *off) {
    double sum = 0.0, squares = 0.0;
    const int count = FAR_ACROSS * (FAR_ROWS - FAR_CLOTH);
    for (int k = 0; k < count; k++) {
        const double a = (double)((const float *)image->pixels)[4 * k + 3],
                     b = (double)((const float *)other->pixels)[4 * k + 3];
        sum += a, squares += (a - b) * (a - b);
    }
    *off = (sqrt)(squares / count);
    print_message("covered %.4f, off by %.4f a pixel\n", sum / count, *off);
    return sum / count;
}

static void hair_from_afar_is_no_scatter_of_dots(void **state) {
    (void)state;
    need_gl();
    WeftScene *scene = square();
    WeftError error;
    set(scene, "*.hair_density", "100000");
    set(scene, "*.hair_length", "0.006");
    WeftRaster *raster = raster_of(scene);
    WeftRasterView view = {.width = FAR_ACROSS,
                           .height = FAR_ROWS,
                           .samples = 4,
                           .camera = "0,0.008,2;0,0.008,0;0.91667",
                           .background = WEFT_BACKGROUND_TRANSPARENT};
    const WeftRenderDesc traced = {.width = FAR_ACROSS,
                                   .height = FAR_ROWS,
                                   .max_depth = 1,
                                   .camera = "0,0.008,2;0,0.008,0;0.91667",
                                   .background = WEFT_BACKGROUND_TRANSPARENT};
    WeftImage image = {0}, reference = test_render(scene, traced, 256);
    double off, none;
    const double should = band_of(&reference, &reference, &none);
    assert_true(should > 0.05);
    for (view.shading_rate = 1; view.shading_rate <= 2; view.shading_rate++) { /* at rest and in motion */
        if (weft_raster_draw(raster, &view, &error) != WEFT_OK || weft_raster_image(raster, &image, &error) != WEFT_OK)
            fail_msg("%s", error.text);
        const double is = band_of(&image, &reference, &off);
        assert_true(fabs(is / should - 1.0) < 0.08);
        assert_true(off < 0.03);
        weft_image_free(&image);
    }
    weft_image_free(&reference);
    weft_raster_free(raster);
    weft_scene_free(scene);
}

static double mean_of(WeftImage *image) {
    double sum = 0.0;
    const size_t count = (size_t)image->width * (size_t)image->height;
    for (size_t k = 0; k < count; k++) sum += (double)((const float *)image->pixels)[4 * k + 1] / (double)count;
    weft_image_free(image);
    return sum;
}

/* A quarter of a square metre of felt from above, of half a million fibres: more than the tree of rays takes. */
static void hair_shades_its_cloth(void **state) {
    (void)state;
    need_gl();
    enum { FRAMES = 6 };
    WeftScene *scene = square_of(0.5f);
    WeftError error;
    const WeftRasterView view = {.width = 48, .height = 32, .samples = 4, .camera = "0,0.7,0.7;0,0,0;20"};
    const WeftRenderDesc traced = {.width = 48, .height = 32, .max_depth = 1, .camera = "0,0.7,0.7;0,0,0;20"};
    WeftImage reference = test_render(scene, traced, 64), image = {0};
    const double bald = mean_of(&reference);
    set(scene, "*.hair_density", "1900000");
    set(scene, "*.hair_length", "0.002");
    assert_true(scene->meshes[1].triangle_count / HAIR_TRIANGLES > RAY_FIBRES_MOST);
    reference = test_render(scene, traced, 64);
    const double should = mean_of(&reference);
    WeftRaster *raster = raster_of(scene);
    if (weft_raster_draw(raster, &view, &error) != WEFT_OK || weft_raster_image(raster, &image, &error) != WEFT_OK)
        fail_msg("%s", error.text);
    const double frame = mean_of(&image);
    int done = 0;
    if (weft_raster_accumulate_begin(raster, &view, FRAMES, &error) != WEFT_OK) fail_msg("%s", error.text);
    while (done < FRAMES)
        if (weft_raster_accumulate(raster, 1.0, &done, &error) != WEFT_OK) fail_msg("%s", error.text);
    if (weft_raster_image(raster, &image, &error) != WEFT_OK) fail_msg("%s", error.text);
    const double sum = mean_of(&image);
    print_message("bald %.4f, with hair traced %.4f, summed %.4f, a frame %.4f\n", bald, should, sum, frame);
    assert_true(should < 0.95 * bald);
    assert_true(fabs(sum / should - 1.0) < 0.02);
    assert_true(fabs(frame / should - 1.0) < 0.03);
    weft_raster_free(raster);
    weft_scene_free(scene);
}

static bool is_same(WeftImage a, WeftImage b) {
    const size_t size = (size_t)ACROSS * ROWS * 4 * sizeof(float);
    const bool same = a.pixels && b.pixels && memcmp(a.pixels, b.pixels, size) == 0;
    weft_image_free(&a);
    weft_image_free(&b);
    return same;
}

static WeftImage rendered(WeftRender *render) {
    WeftImage image = {0};
    WeftError error;
    if (weft_render_run(render, 2, 0.0, NULL, NULL) != WEFT_OK || weft_render_image(render, &image, &error) != WEFT_OK)
        fail_msg("%s", error.text);
    return image;
}

static void updates_see_what_new_ones_see(void **state) {
    (void)state;
    need_gl();
    static const char *const steps[][2] = {{"*.hair_length", "0.006"},  {"*.hair_length", "0.003"},
                                           {"*.hair_density", "50000"}, {"*.hair_length", "0"},
                                           {"*.base_color", "0.9"},     {"*.hair_length", "0.004"}};
    WeftScene *scene = square();
    WeftError error;
    WeftRender *render = NULL;
    WeftRaster *raster = raster_of(scene);
    const WeftImage bare = drawn(raster);
    if (weft_render_create(scene, &desc, &render, &error) != WEFT_OK) fail_msg("%s", error.text);
    for (size_t k = 0; k < sizeof steps / sizeof *steps; k++) {
        set(scene, steps[k][0], steps[k][1]);
        if (weft_raster_update(raster, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
        if (weft_render_restart(render, &desc, WEFT_CHANGED_MATERIALS, &error) != WEFT_OK) fail_msg("%s", error.text);
        WeftRaster *fresh = raster_of(scene);
        WeftRender *other = NULL;
        if (weft_render_create(scene, &desc, &other, &error) != WEFT_OK) fail_msg("%s", error.text);
        if (!is_same(drawn(raster), drawn(fresh))) fail_msg("step %d: not as a new raster draws it", (int)k);
        if (!is_same(rendered(render), rendered(other))) fail_msg("step %d: not as a new render has it", (int)k);
        weft_raster_free(fresh);
        weft_render_free(other);
        if (k == 3) assert_true(is_same(drawn(raster), bare)); /* bald again */
    }
    weft_render_free(render);
    weft_raster_free(raster);
    weft_scene_free(scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(engines_see_as_much_hair_at_each_height),
                                       cmocka_unit_test(hair_from_afar_is_no_scatter_of_dots),
                                       cmocka_unit_test(hair_shades_its_cloth),
                                       cmocka_unit_test(updates_see_what_new_ones_see)};
    return cmocka_run_group_tests(tests, gl_begin, NULL);
}
