/* Hair at an outline: both engines see as much of it at each height over a cloth that is seen edge-on, and in the same
 * light; a raster and a render that are updated see what new ones see.
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
#include "trace/scenes.h"

/* Pixels of half a millimetre, the lowest row at the cloth. */
enum { ACROSS = 256, ROWS = 16 };
static const char *const camera = "0,0.004,2;0,0.004,0;0.22918";

/* A level square, 20 cm a side. */
static WeftScene *square(void) {
    WeftScene *scene = test_scene();
    test_material(scene, 0.5f);
    test_quad(scene, vec3(-0.1f, 0.0f, 0.1f), vec3(0.2f, 0.0f, 0.0f), vec3(0.0f, 0.0f, -0.2f));
    scene_bounds(scene);
    test_environment(scene, 1.0f);
    return scene;
}

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
        profile.light += (double)pixel[1], all += (double)pixel[3];
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
    /* a sky all around: in the raster engine no fibre hides it from another */
    assert_true(is.light / should.light > 0.9 && is.light / should.light < 1.3);
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
                                       cmocka_unit_test(updates_see_what_new_ones_see)};
    return cmocka_run_group_tests(tests, gl_begin, NULL);
}
