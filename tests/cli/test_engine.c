/* `weft render` with the raster engine: its options, sheets of both, turntables, lights; and what is refused
 */
#include "run.h"

#include <jansson.h>

#include "weft/image.h"

#define TINY "--width=48", "--height=36"

/* Skips where there is no OpenGL. */
static void need_gl(void) {
    Ran ran = run_with(NULL, LIST("render", "builtin:spheres", TINY, "-o", "probe.png", "--engine=raster", "--quiet"));
    bool none = ran.code != 0 && strstr(ran.err, "OpenGL");
    if (none) print_message("%s", ran.err);
    if (!none && ran.code != 0) fail_msg("exit %d: %s", ran.code, ran.err);
    ran_free(&ran);
    if (none) skip();
}

static void engine_raster_writes_a_picture(void **state) {
    (void)state;
    need_gl();
    Ran ran = run_with(NULL, LIST("render", "builtin:spheres", TINY, "-o", "a.png", "-o", "a.exr", "--engine", "raster",
                                  "--gl=es", "--json", "--light", "sun;-1,-2,-1;3,3,3", "--polygons=0", "--occlusion=4",
                                  "--ambient=irradiance", "--crop=10,5,20,15", "--part=sheen", "--light=none",
                                  "--light=polygon;0,3,0;0,-1,0;1,2;5,5,5", "--light",
                                  "polygon;0,3,0;0,-1,0;1,2;5,5,5;6,30"));
    if (ran.code != 0) fail_msg("exit %d: %s", ran.code, ran.err);
    json_t *all = json_loads(ran.out, 0, NULL);
    assert_non_null(all);
    assert_string_equal(json_string_value(json_object_get(all, "engine")), "raster");
    assert_true(strlen(json_string_value(json_object_get(all, "driver"))) > 3);
    json_decref(all);
    ran_free(&ran);
}

static void engine_both_writes_both_pictures_and_their_difference(void **state) {
    (void)state;
    need_gl();
    Ran ran =
        run_with(NULL, LIST("render", "builtin:spheres", TINY, "-o", "both.png", "--engine=both", "--spp=4", "--json"));
    if (ran.code != 0) fail_msg("exit %d: %s", ran.code, ran.err);
    json_t *all = json_loads(ran.out, 0, NULL);
    assert_int_equal(json_array_size(all), 2);
    json_t *difference = json_object_get(json_array_get(all, 1), "difference");
    assert_true(json_number_value(json_object_get(difference, "relmse")) > 0.0);
    json_decref(all);
    ran_free(&ran);
}

/* Whatever the exposure: a background is no part of the scene. */
static void white_background_is_white_in_both(void **state) {
    (void)state;
    need_gl();
    static const char *const engines[] = {"trace", "raster"};
    for (int k = 0; k < 2; k++) {
        WeftImage shown, linear;
        Ran ran = run_with(NULL, LIST("render", "builtin:spheres", TINY, "-o", "white.png", "-o", "white.exr",
                                      "--engine", engines[k], "--background=1,1,1", "--exposure=-2", "--spp=1",
                                      "--camera=0,100,0;0,200,1;20"));
        if (ran.code != 0) fail_msg("exit %d: %s", ran.code, ran.err);
        ran_free(&ran);
        assert_int_equal(weft_image_read("white.png", &shown, NULL, NULL), WEFT_OK);
        assert_int_equal(weft_image_read("white.exr", &linear, NULL, NULL), WEFT_OK);
        for (int c = 0; c < 3; c++) {
            assert_int_equal(((const unsigned char *)shown.pixels)[c], 255);
            assert_true(((const float *)linear.pixels)[c] > 0.999f);
        }
        weft_image_free(&shown);
        weft_image_free(&linear);
    }
}

/* The path tracer's picture of direct light is nearer with more frames. */
static void accumulated_frames_come_near_the_path_tracer(void **state) {
    (void)state;
    need_gl();
    static const char *const frames[] = {"--accumulate=1", "--accumulate=24"};
    double off[2];
    for (int k = 0; k < 2; k++) {
        Ran ran = run_with(NULL, LIST("render", "builtin:spheres", TINY, "-o", "both.png", "--engine=both", "--spp=64",
                                      "--max-depth=1", "--json", frames[k]));
        if (ran.code != 0) fail_msg("exit %d: %s", ran.code, ran.err);
        json_t *all = json_loads(ran.out, 0, NULL), *raster = json_array_get(all, 1);
        assert_true(json_number_value(json_object_get(raster, "samples_per_pixel")) > (k ? 23.0 : 0.0));
        off[k] = json_number_value(json_object_get(json_object_get(raster, "difference"), "relmse"));
        json_decref(all);
        ran_free(&ran);
    }
    assert_true(off[1] < 0.25 * off[0]);
}

static void turntable_numbers_its_pictures(void **state) {
    (void)state;
    need_gl();
    Ran ran =
        run_with(NULL, LIST("render", "builtin:spheres", TINY, "-o", "turn.png", "--engine=raster", "--turntable=3"));
    if (ran.code != 0) fail_msg("exit %d: %s", ran.code, ran.err);
    ran_free(&ran);
    for (int k = 0; k < 3; k++) {
        char name[32];
        snprintf(name, sizeof name, "turn-%03d.png", k);
        assert_int_equal(access(name, R_OK), 0);
    }
    assert_true(access("turn-003.png", R_OK) != 0);
    assert_true(access("turn.png", R_OK) != 0);
    ran = run_with(NULL, LIST("render", "builtin:spheres", TINY, "-o", "one.png", "--turntable=2", "--spp=1"));
    assert_int_equal(ran.code, 0);
    ran_free(&ran);
    assert_int_equal(access("one-001.png", R_OK), 0);
}

static void refuses(const char *const *arguments, const char *words) {
    Ran ran = run_with(NULL, arguments);
    if (ran.code != 2 || !strstr(ran.err, words)) fail_msg("exit %d: %s", ran.code, ran.err);
    ran_free(&ran);
}

static void engine_options_without_sense_are_refused(void **state) {
    (void)state;
    static const char *const lights[] = {"sun",
                                         "moon;1,2,3;1,1,1",
                                         "sun;1,2;1,1,1",
                                         "point;1,2,3",
                                         "spot;0,0,0;0,1,0;1,1,1;9",
                                         "sun;1,2,3;1,1,1;4",
                                         "sun;0,0,x;1,1,1",
                                         "polygon;0,3,0;0,-1,0;1;5,5,5",
                                         "polygon;0,3,0;0,-1,0;1,2;5,5,5;9,0",
                                         "polygon;0,3,0;0,-1,0;1,2;5,5,5;4.5,0"};
    for (size_t k = 0; k < sizeof lights / sizeof lights[0]; k++)
        refuses(LIST("render", "builtin:spheres", "-o", "x.png", "--light", lights[k]), "--light");
    refuses(LIST("render", "builtin:spheres", "-o", "x.png", "--light", "sun;0,0,0;1,1,1"), "light");
    refuses(LIST("render", "builtin:spheres", "-o", "x.png", "--light", "polygon;0,3,0;0,-1,0;0,2;5,5,5"), "size");
    refuses(LIST("render", "builtin:spheres", "-o", "x.png", "--engine=vulkan"), "--engine");
    refuses(LIST("render", "builtin:spheres", "-o", "x.png", "--engine=raster", "--part=gloss"), "--part");
    refuses(LIST("render", "builtin:spheres", "-o", "x.png", "--part=sheen"), "--part");
    refuses(LIST("render", "builtin:spheres", "-o", "x.png", "--ambient=dark"), "--ambient");
    refuses(LIST("render", "builtin:spheres", "-o", "x.png", "--accumulate=8"), "--accumulate: needs --engine raster");
    refuses(LIST("render", "builtin:spheres", "-o", "x.png", "--engine=raster", "--accumulate=0"), "--accumulate");
    refuses(LIST("render", "builtin:spheres", "-o", "x.png", "--engine=raster", "--bounces=1"), "add --accumulate 256");
    refuses(LIST("render", "builtin:spheres", "-o", "x.png", "--engine=raster", "--accumulate=8", "--bounces=2"),
            "--bounces");
    refuses(LIST("render", "builtin:spheres", "-o", "x.png", "--engine=raster", "--accumulate=8", "--bounces=some"),
            "--bounces");
    refuses(LIST("render", "builtin:spheres", "-o", "x.png", "--engine=both", "--layer", "additive,seed"), "both");
    refuses(LIST("render", "builtin:spheres", "-o", "x.exr", "--engine=both"), "sheet");
    refuses(LIST("render", "builtin:spheres", "-o", "x.png", "--engine=both", "--turntable=3"), "--turntable");
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(engine_raster_writes_a_picture),
                                       cmocka_unit_test(engine_both_writes_both_pictures_and_their_difference),
                                       cmocka_unit_test(white_background_is_white_in_both),
                                       cmocka_unit_test(accumulated_frames_come_near_the_path_tracer),
                                       cmocka_unit_test(turntable_numbers_its_pictures),
                                       cmocka_unit_test(engine_options_without_sense_are_refused)};
    return cmocka_run_group_tests(tests, work_begin, work_end);
}
