/* One bounce of light in sums of frames: what surfaces send to each other is what the path tracer finds at depth 2, the
 * chair is nearer to the full path tracer than any constant ambient brings it, and without bounces nothing changes
 *
 * Labels: slow unsanitized */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <unistd.h>

#include <cmocka.h>

#define SUMS_WIDTH  72
#define SUMS_HEIGHT 48
#include "raster/sums.h"

enum { FRAMES = 256, SPP = 2048 };

static const WeftRasterView corner_view = {.width = WIDTH,
                                           .height = HEIGHT,
                                           .camera = "-0.6,0.7,2.6;0.1,0.1,0;30",
                                           .background = WEFT_BACKGROUND_TRANSPARENT,
                                           .bounces = 1};

static void colored(Material *material, float r, float g, float b) {
    float *to = material->inputs[INPUT_base_color].value;
    to[0] = r, to[1] = g, to[2] = b;
}

/* A white floor and a red wall that stands on its right side, in even light and the sun, which comes from the left. */
static WeftScene *red_corner(void) {
    WeftScene *scene = test_scene();
    test_environment(scene, 0.3f);
    test_material(scene, 0.8f);
    test_quad(scene, vec3(-1.0f, -0.3f, 1.0f), vec3(1.6f, 0.0f, 0.0f), vec3(0.0f, 0.0f, -2.0f));
    colored(test_material(scene, 0.0f), 0.8f, 0.1f, 0.05f);
    test_quad(scene, vec3(0.6f, -0.3f, 1.0f), vec3(0.0f, 1.0f, 0.0f), vec3(0.0f, 0.0f, -2.0f));
    test_sun(scene, vec3(0.8f, -0.6f, 0.0f), 3.0f);
    scene_bounds(scene);
    return scene;
}

/* Returns how much redder than blue the floor is beside the wall. */
static double redness(const WeftImage *image) {
    double red = 0.0, blue = 0.0;
    for (int y = 27; y < 33; y++)
        for (int x = 33; x < 39; x++) {
            const float *p = (const float *)image->pixels + 4 * (y * WIDTH + x);
            red += (double)p[0], blue += (double)p[2];
        }
    return red / blue;
}

static void a_red_wall_colors_the_floor(void **state) {
    (void)state;
    need_gl();
    WeftScene *scene = red_corner();
    WeftRaster *raster = raster_of(scene);
    WeftRasterView direct = corner_view;
    direct.bounces = 0;
    WeftImage with = summed(raster, &corner_view, 64), without = summed(raster, &direct, 64);
    print_message("red over blue of the floor: %.3f, without a bounce %.3f\n", redness(&with), redness(&without));
    assert_true(redness(&with) > 1.05 && fabs(redness(&without) - 1.0) < 0.01);
    weft_image_free(&with);
    weft_image_free(&without);
    weft_raster_free(raster);
    agrees(scene, &corner_view, FRAMES, SPP, "red wall", 0.02, 0.004);
}

/* A grey box without a front, with a panel below its ceiling. */
static void a_grey_box(void **state) {
    (void)state;
    need_gl();
    static const WeftLight panel = {.kind = WEFT_LIGHT_POLYGON,
                                    .position = {0.0f, 0.45f, 0.0f},
                                    .direction = {0.0f, -1.0f, 0.0f},
                                    .color = {6.0f, 5.0f, 4.0f},
                                    .size = {0.4f, 0.4f}};
    WeftRasterView view = corner_view;
    WeftScene *scene = test_scene();
    view.camera = "0,0,2.6;0,0,0;28";
    test_environment(scene, 0.0f);
    test_material(scene, 0.5f);
    test_box(scene, 0.5f);
    scene->meshes[3] = scene->meshes[--scene->mesh_count]; /* the front */
    scene_bounds(scene);
    assert_int_equal(weft_scene_add_light(scene, &panel, NULL), WEFT_OK);
    agrees(scene, &view, FRAMES, SPP, "grey box", 0.025, 0.006);
}

static void set(WeftScene *scene, const char *target, const char *value) {
    WeftError error;
    if (weft_scene_set(scene, target, value, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
}

/* A ball of fuzz on a white floor: what the fuzz sends back lights the floor. */
static WeftScene *fuzzy_ball(void) {
    WeftScene *scene = test_scene();
    test_environment(scene, 0.0f);
    test_material(scene, 0.3f);
    test_ball(scene, vec3(0.0f, 0.0f, 0.0f), 0.4f, 32);
    test_material(scene, 0.8f);
    test_quad(scene, vec3(-1.5f, -0.4f, 1.5f), vec3(3.0f, 0.0f, 0.0f), vec3(0.0f, 0.0f, -3.0f));
    scene_bounds(scene);
    assert_int_equal(weft_scene_set_environment_studio(scene, NULL), WEFT_OK);
    return scene;
}

static void sheen_lobes_send_light_back(void **state) {
    (void)state;
    need_gl();
    static const char *const lobes[] = {"charlie-neubelt", "ltc-fibre", "burley-sheen", "ashikhmin-neubelt"};
    for (size_t k = 0; k < sizeof lobes / sizeof *lobes; k++) {
        WeftScene *scene = fuzzy_ball();
        WeftError error;
        set(scene, "0.sheen_color", "0.8,0.6,0.4");
        set(scene, "0.sheen_roughness", "0.4");
        if (weft_scene_set(scene, "0.sheen_lobe", lobes[k], NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
        agrees(scene, &corner_view, 64, 1024, lobes[k], 0.045, 0.008);
    }
    WeftScene *scene = fuzzy_ball();
    WeftError error;
    if (weft_scene_assign_material(scene, "0", "preset:woven-denim", NULL, &error) != WEFT_OK)
        fail_msg("%s", error.text);
    agrees(scene, &corner_view, 64, 1024, "woven-denim", 0.045, 0.008);
}

static bool same_bytes(const WeftImage *a, const WeftImage *b) {
    return memcmp(a->pixels, b->pixels, (size_t)WIDTH * HEIGHT * 4 * sizeof(float)) == 0;
}

/* A raster that has bounced light draws direct light as one that never has, also when materials have changed between. */
static void without_bounces_nothing_changes(void **state) {
    (void)state;
    need_gl();
    WeftScene *scene = red_corner();
    WeftRaster *raster = raster_of(scene), *other = raster_of(scene);
    WeftRasterView direct = corner_view;
    direct.bounces = 0;
    WeftImage bounced = summed(raster, &corner_view, 4), after = summed(raster, &direct, 4),
              alone = summed(other, &direct, 4), later = summed(other, &corner_view, 4);
    assert_true(same_bytes(&after, &alone));
    assert_true(same_bytes(&bounced, &later));
    assert_false(same_bytes(&bounced, &alone));
    set(scene, "1.base_color", "0.05,0.1,0.8");
    assert_int_equal(weft_raster_update(raster, NULL, NULL), WEFT_OK);
    WeftImage blue = summed(raster, &corner_view, 16);
    assert_true(redness(&blue) < 0.97);
    WeftImage *const all[] = {&bounced, &after, &alone, &later, &blue};
    for (size_t k = 0; k < sizeof all / sizeof(WeftImage *); k++) weft_image_free(all[k]);
    weft_raster_free(raster);
    weft_raster_free(other);
    weft_scene_free(scene);
}

/* The first frames of a sum are mixed with the picture from before, which has no bounced light. */
static void begins_without_a_jump(void **state) {
    (void)state;
    need_gl();
    WeftScene *scene = red_corner();
    WeftRaster *raster = raster_of(scene);
    WeftImage before, first;
    WeftError error;
    int done = 0;
    if (weft_raster_draw(raster, &corner_view, &error) != WEFT_OK ||
        weft_raster_image(raster, &before, &error) != WEFT_OK ||
        weft_raster_accumulate_begin(raster, &corner_view, FRAMES, &error) != WEFT_OK)
        fail_msg("%s", error.text);
    while (done < 1) assert_int_equal(weft_raster_accumulate(raster, 0.0, &done, NULL), WEFT_OK);
    if (weft_raster_image(raster, &first, &error) != WEFT_OK) fail_msg("%s", error.text);
    const Off off = compare(&first, &before);
    print_message("first frame %.2f %% off\n", 100.0 * off.pixels);
    assert_true(done == 1 && off.pixels < 0.02);
    weft_image_free(&before);
    weft_image_free(&first);
    weft_raster_free(raster);
    weft_scene_free(scene);
}

static void other_numbers_are_refused(void **state) {
    (void)state;
    need_gl();
    static const int wrong[] = {-1, 2, 1000000};
    WeftScene *scene = red_corner();
    WeftRaster *raster = raster_of(scene);
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        WeftRasterView view = corner_view;
        WeftError error;
        view.bounces = wrong[k];
        assert_int_equal(weft_raster_accumulate_begin(raster, &view, 4, &error), WEFT_USAGE);
        assert_non_null(strstr(error.text, "bounces"));
        assert_null(strchr(error.text, '\n'));
    }
    weft_raster_free(raster);
    weft_scene_free(scene);
}

/* Returns the sum of |a + ambient part - b| over the sum of b. part: NULL: without. */
static double error_of(const WeftImage *a, const WeftImage *part, float ambient, const WeftImage *b) {
    double off = 0.0, sum = 0.0;
    for (int k = 0; k < WIDTH * HEIGHT; k++) {
        const float *p = (const float *)a->pixels + 4 * k, *q = (const float *)b->pixels + 4 * k;
        const float *added = part ? (const float *)part->pixels + 4 * k : NULL;
        for (int c = 0; c < 3; c++) {
            const float is = (p[c] + (added ? ambient * added[c] * (added[3] > 0.0f ? 1.0f : 0.0f) : 0.0f)) * p[3];
            off += (double)fabsf(is - q[c] * q[3]);
            sum += (double)(q[c] * q[3]);
        }
    }
    return off / sum;
}

/* Compares the chair with the full path tracer: one bounce leaves at most half of the error, and no constant times the base
 * colour, the ambient light of old renderers, does. */
static void chair_is_nearer_the_truth_than_with_any_constant(void **state) {
    (void)state;
    need_gl();
    static const char path[] = WEFT_SOURCE_DIR "/../shared/data/gltf/SheenChair/SheenChair.gltf";
    WeftScene *scene;
    if (access(path, R_OK) != 0) {
        print_message("no %s\n", path);
        skip();
    }
    assert_int_equal(weft_scene_load(path, &scene, NULL, NULL), WEFT_OK);
    WeftRasterView view = corner_view, direct = corner_view, base = corner_view;
    view.camera = direct.camera = base.camera = NULL;
    direct.bounces = base.bounces = 0;
    base.part = WEFT_PART_BASE_COLOR;
    WeftRaster *raster = raster_of(scene);
    WeftImage with = summed(raster, &view, FRAMES), without = summed(raster, &direct, FRAMES),
              color = summed(raster, &base, 16);
    WeftImage full = test_render(
        scene, (WeftRenderDesc){.width = WIDTH, .height = HEIGHT, .background = WEFT_BACKGROUND_TRANSPARENT}, 4096);
    const double one = error_of(&with, NULL, 0.0f, &full), none = error_of(&without, NULL, 0.0f, &full);
    double best = none;
    for (int k = 1; k <= 100; k++) best = fmin(best, error_of(&without, &color, 0.005f * (float)k, &full));
    print_message("chair: %.4f without a bounce, %.4f with one, %.4f with the best constant ambient\n", none, one,
                  best);
    assert_true(one <= 0.5 * none);
    assert_true(best > 0.5 * none);
    WeftImage *const all[] = {&with, &without, &color, &full};
    for (size_t k = 0; k < sizeof all / sizeof(WeftImage *); k++) weft_image_free(all[k]);
    weft_raster_free(raster);
    weft_scene_free(scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_red_wall_colors_the_floor),
        cmocka_unit_test(a_grey_box),
        cmocka_unit_test(sheen_lobes_send_light_back),
        cmocka_unit_test(without_bounces_nothing_changes),
        cmocka_unit_test(begins_without_a_jump),
        cmocka_unit_test(other_numbers_are_refused),
        cmocka_unit_test(chair_is_nearer_the_truth_than_with_any_constant),
    };
    return cmocka_run_group_tests(tests, gl_begin, NULL);
}
