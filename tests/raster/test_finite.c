/* What the raster engine draws is a number: of every sheen lobe under the sky, at its least roughness too,
 * where its light is next to nothing */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "raster/gl.h"
#include "raster/spheres.h"
#include "weft/weft.h"

enum { WIDTH = 320, HEIGHT = 180 };

/* Spheres of sheen roughness 0.1 to 1 and nothing but the environment. */
static WeftScene *spheres(const char *lobe) {
    WeftScene *scene;
    WeftError error;
    if (weft_scene_load("builtin:spheres", &scene, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    while (weft_scene_info(scene).light_count > 0)
        assert_int_equal(weft_scene_remove_light(scene, 0, NULL), WEFT_OK);
    assert_int_equal(weft_scene_set(scene, "*.sheen_lobe", lobe, NULL, NULL), WEFT_OK);
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

static int odd_pixels(const char *lobe) {
    const WeftRasterDesc desc = {.occlusion = 0, .threads = 2};
    WeftScene *scene = spheres(lobe);
    WeftRaster *raster;
    WeftError error;
    if (weft_raster_create(scene, &desc, &raster, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    int odd = count_odd(raster);
    assert_int_equal(weft_scene_set(scene, "*.sheen_roughness", "0.01", NULL, NULL), WEFT_OK);
    assert_int_equal(weft_raster_update(raster, NULL, NULL), WEFT_OK);
    int least = count_odd(raster);
    if (odd || least) print_message("%s: %d values odd, at the least roughness %d\n", lobe, odd, least);
    weft_raster_free(raster);
    weft_scene_free(scene);
    return odd + least;
}

static void pixels_of_extreme_materials_are_finite(void **state) {
    (void)state;
    need_gl();
    int odd = 0;
    for (int lobe = 0; weft_lobe_info(lobe); lobe++) {
        const WeftLobeInfo *info = weft_lobe_info(lobe);
        if (!(info->traits & (WEFT_LOBE_REFERENCE | WEFT_LOBE_DIFFUSE))) odd += odd_pixels(info->id);
    }
    assert_int_equal(odd, 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(pixels_of_extreme_materials_are_finite)};
    return cmocka_run_group_tests(tests, gl_begin, NULL);
}
