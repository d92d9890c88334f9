/* The raster engine draws numbers for every sheen lobe under the sky: for half of them at their least roughness, where
 * their light is next to nothing, and for all in long runs.
 *
 * Labels: slow unsanitized */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "shading/cases.h"

#include "raster/gl.h"
#include "raster/spheres.h"
#include "weft/weft.h"

enum { WIDTH = 320, HEIGHT = 180 };

/* Spheres of sheen roughness 0.1 to 1 and nothing but the environment. */
static WeftScene *spheres(void) {
    WeftScene *scene;
    WeftError error;
    if (weft_scene_load("builtin:spheres", &scene, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    while (weft_scene_info(scene).light_count > 0) assert_int_equal(weft_scene_remove_light(scene, 0, NULL), WEFT_OK);
    spheres_cover_floor(scene);
    return scene;
}

static int count_odd(WeftRaster *raster) {
    const WeftRasterView view = {
        .width = WIDTH, .height = HEIGHT, .samples = 1, .camera = "0", .part = WEFT_PART_SHEEN};
    WeftImage image;
    WeftError error;
    if (weft_raster_draw(raster, &view, &error) != WEFT_OK) fail_msg("%s", error.text);
    assert_int_equal(weft_raster_image(raster, &image, NULL), WEFT_OK);
    const float *p = image.pixels;
    int odd = 0;
    for (int k = 0; k < 4 * WIDTH * HEIGHT; k++) odd += !isfinite(p[k]);
    weft_image_free(&image);
    return odd;
}

static int odd_of(WeftScene *scene, WeftRaster *raster, const char *lobe, const char *roughness) {
    assert_int_equal(weft_scene_set(scene, "*.sheen_lobe", lobe, NULL, NULL), WEFT_OK);
    assert_int_equal(weft_raster_update(raster, NULL, NULL), WEFT_OK);
    int odd = count_odd(raster);
    assert_string_equal(weft_raster_info(raster).complaint, ""); /* else the lobe before is drawn */
    if (odd) print_message("%s, roughness %s: %d values odd\n", lobe, roughness, odd);
    return odd;
}

static void pixels_of_extreme_materials_are_finite(void **state) {
    (void)state;
    need_gl();
    const WeftRasterDesc desc = {.occlusion = 0, .threads = 2};
    WeftScene *scenes[2] = {spheres(), spheres()};
    WeftRaster *rasters[2];
    WeftError error;
    int odd = 0, at = 0;
    assert_int_equal(weft_scene_set(scenes[1], "*.sheen_roughness", "0.01", NULL, NULL), WEFT_OK);
    for (int k = 0; k < 2; k++)
        if (weft_raster_create(scenes[k], &desc, &rasters[k], NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    for (int lobe = 0; weft_lobe_info(lobe); lobe++) {
        const WeftLobeInfo *info = weft_lobe_info(lobe);
        if (info->traits & (WEFT_LOBE_REFERENCE | WEFT_LOBE_DIFFUSE) || !test_turn(&at, 1, 9)) continue;
        for (int k = test_long() ? 0 : lobe % 2; k < 2; k += test_long() ? 1 : 2)
            odd += odd_of(scenes[k], rasters[k], info->id, k ? "0.01" : "0.1 to 1");
    }
    for (int k = 0; k < 2; k++) {
        weft_raster_free(rasters[k]);
        weft_scene_free(scenes[k]);
    }
    assert_int_equal(odd, 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(pixels_of_extreme_materials_are_finite)};
    return cmocka_run_group_tests(tests, gl_begin, NULL);
}
