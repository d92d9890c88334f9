/* One picture by several renders: tiles that are copied, samples that are added later, runs that were stopped. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "trace/scenes.h"

enum { MODES = 3 };

/* A crop whose sides are no multiples of a tile, with all that a film may record. */
static WeftRenderDesc desc_of(int mode) {
    return (WeftRenderDesc){.width = 70,
                            .height = 60,
                            .crop = {3, 5, 61, 50},
                            .camera = "0,1,8;0,0,0;40",
                            .floor = {.on = mode > 0, .reflection = 0.2f, .roughness = 0.2f},
                            .halves = mode,
                            .first_hits = mode > 0,
                            .places = mode > 0,
                            .mattes = mode > 0,
                            .slots = mode > 0,
                            .threads = 2};
}

static WeftScene *scene_of_two(void) {
    WeftScene *scene = test_scene();
    test_material(scene, 0.6f);
    test_sphere(scene, vec3(0, 0, 0), 1);
    Material *lamp = test_material(scene, 0.0f);
    test_color(lamp, INPUT_emission, 8.0f);
    test_quad(scene, vec3(-1, 4.5f, -1), vec3(0, 0, 2), vec3(2, 0, 0));
    test_environment(scene, 0.2f);
    scene_bounds(scene);
    return scene;
}

static WeftRender *begin(const WeftScene *scene, int mode) {
    const WeftRenderDesc desc = desc_of(mode);
    WeftRender *render = NULL;
    WeftError error;
    if (weft_render_create(scene, &desc, &render, &error) != WEFT_OK) fail_msg("%s", error.text);
    return render;
}

/* Compares all that two renders show, bit by bit. */
static void assert_same(const WeftRender *a, const WeftRender *b, int mode) {
    const unsigned aovs = mode ? (1u << WEFT_AOV_COUNT) - 1u : 1u << WEFT_AOV_SAMPLES;
    WeftError error;
    WeftRenderLayers first, second;
    WeftImage x, y;
    assert_int_equal(weft_render_image(a, &x, &error), WEFT_OK);
    assert_int_equal(weft_render_image(b, &y, &error), WEFT_OK);
    assert_memory_equal(x.pixels, y.pixels, 61 * 50 * 4 * sizeof(float));
    weft_image_free(&x);
    weft_image_free(&y);
    assert_int_equal(weft_render_layers(a, aovs, &first, &error), WEFT_OK);
    assert_int_equal(weft_render_layers(b, aovs, &second, &error), WEFT_OK);
    assert_int_equal(first.layer_count, second.layer_count);
    for (int k = 0; k < first.layer_count; k++)
        assert_memory_equal(first.layers[k].image->pixels, second.layers[k].image->pixels,
                            61 * 50 * (size_t)first.layers[k].image->channels * sizeof(float));
    weft_render_layers_free(&first);
    weft_render_layers_free(&second);
}

static size_t tile_size(const WeftRender *render) {
    return WEFT_RENDER_TILE_HEAD + WEFT_RENDER_TILE * WEFT_RENDER_TILE * (size_t)weft_render_tile_numbers(render);
}

/* Copies every tile for which there is a byte; NULL: all. */
static void copy_tiles(const WeftRender *from, const unsigned char *wanted, WeftRender *to) {
    WeftError error;
    assert_true(weft_render_tile_numbers(from) <= WEFT_RENDER_NUMBERS);
    float *numbers = test_calloc(tile_size(from), sizeof *numbers);
    for (int k = 0; k < weft_render_tile_count(from); k++) {
        if (wanted && !wanted[k]) continue;
        weft_render_tile(from, k, numbers);
        if (weft_render_tile_set(to, k, numbers, &error) != WEFT_OK) fail_msg("%s", error.text);
    }
    test_free(numbers);
}

/* Renders 100 samples by one run. */
static WeftRender *whole_of(const WeftScene *scene, int mode) {
    WeftRender *render = begin(scene, mode);
    assert_int_equal(weft_render_run(render, 100, 0.0, NULL, NULL), WEFT_OK);
    assert_int_equal(weft_render_samples(render), 100);
    return render;
}

static void samples_that_are_added_later_are_those_of_one_run(void **state) {
    (void)state;
    WeftScene *scene = scene_of_two();
    for (int mode = 0; mode < MODES; mode++) {
        WeftRender *whole = whole_of(scene, mode), *early = begin(scene, mode), *late = begin(scene, mode);
        assert_int_equal(weft_render_run(early, 32, 0.0, NULL, NULL), WEFT_OK);
        copy_tiles(early, NULL, late);
        assert_int_equal(weft_render_samples(late), 32);
        assert_int_equal(weft_render_run(late, 32, 0.0, NULL, NULL), WEFT_OK);
        assert_int_equal(weft_render_tiles_run(late, NULL, 100, NULL, NULL), WEFT_OK);
        assert_same(whole, late, mode);
        weft_render_free(early);
        weft_render_free(late);
        weft_render_free(whole);
    }
    weft_scene_free(scene);
}

static void tiles_of_several_renders_are_those_of_one(void **state) {
    (void)state;
    WeftScene *scene = scene_of_two();
    for (int mode = 0; mode < MODES; mode++) {
        WeftRender *whole = whole_of(scene, mode), *joined = begin(scene, mode);
        for (int k = 0; k < 3; k++) {
            WeftRender *part = begin(scene, mode);
            unsigned char wanted[16] = {0};
            assert_int_equal(weft_render_tile_count(part), 16);
            for (int tile = k; tile < 16; tile += 3) wanted[tile] = 1;
            assert_int_equal(weft_render_tiles_run(part, wanted, 100, NULL, NULL), WEFT_OK);
            assert_int_equal(weft_render_samples(part), 0);
            copy_tiles(part, wanted, joined);
            weft_render_free(part);
        }
        assert_same(whole, joined, mode);
        weft_render_free(joined);
        weft_render_free(whole);
    }
    weft_scene_free(scene);
}

/* Stops a run at the call that it counts down to. */
static int stop_at(void *user, double fraction) {
    int *left = user;
    assert_true(fraction >= 0.0 && fraction <= 1.0);
    return --*left < 0;
}

static void run_that_is_stopped_anywhere_goes_on_as_if_it_were_not(void **state) {
    (void)state;
    WeftScene *scene = scene_of_two();
    for (int mode = 0; mode < MODES; mode++) {
        WeftRender *whole = whole_of(scene, mode), *stopped = begin(scene, mode), *tiles = begin(scene, mode);
        int runs = 0;
        for (int left = 3; weft_render_samples(stopped) < 100 && runs < 1000;
             left = 3 + runs, runs++) { /* longer, for slow machines */
            weft_render_run(stopped, 100 - weft_render_samples(stopped), 0.0, stop_at, &left);
            WeftRender *next = begin(scene, mode); /* another process */
            copy_tiles(stopped, NULL, next);
            weft_render_free(stopped);
            stopped = next;
        }
        assert_true(runs > 3);
        assert_same(whole, stopped, mode);
        for (int left = 3, more = 3; weft_render_tiles_run(tiles, NULL, 100, stop_at, &left) == WEFT_INTERRUPTED;)
            left = ++more;
        assert_same(whole, tiles, mode);
        weft_render_free(stopped);
        weft_render_free(tiles);
        weft_render_free(whole);
    }
    weft_scene_free(scene);
}

static void sums_that_cannot_be_are_refused(void **state) {
    (void)state;
    WeftScene *scene = scene_of_two();
    WeftRender *render = whole_of(scene, 1), *other = begin(scene, 1);
    WeftError error;
    const size_t size = tile_size(render);
    float *numbers = test_calloc(size, sizeof *numbers);
    weft_render_tile(render, 5, numbers);
    const struct {
        size_t at;
        float value;
    } wrong[] = {{0, -1.0f},    {0, 0.5f},       {1, NAN},         {1, 1e20f},          {2, -3.0f},
                 {3, INFINITY}, {size / 2, NAN}, {size - 1, 0.5f}, {size - 2, 65536.0f}};
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        const float kept = numbers[wrong[k].at];
        numbers[wrong[k].at] = wrong[k].value;
        assert_int_equal(weft_render_tile_set(other, 5, numbers, &error), WEFT_USAGE);
        assert_non_null(strstr(error.text, "sums of a tile"));
        numbers[wrong[k].at] = kept;
    }
    assert_int_equal(weft_render_tile_set(other, 16, numbers, &error), WEFT_USAGE);
    assert_int_equal(weft_render_tile_set(other, -1, numbers, &error), WEFT_USAGE);
    assert_int_equal(weft_render_info(other).samples_per_pixel > 0.0, 0);
    assert_int_equal(weft_render_tile_set(other, 5, numbers, &error), WEFT_OK);
    test_free(numbers);
    weft_render_free(other);
    weft_render_free(render);
    weft_scene_free(scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(samples_that_are_added_later_are_those_of_one_run),
        cmocka_unit_test(tiles_of_several_renders_are_those_of_one),
        cmocka_unit_test(run_that_is_stopped_anywhere_goes_on_as_if_it_were_not),
        cmocka_unit_test(sums_that_cannot_be_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
