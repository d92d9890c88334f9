/* A woven material of a scene that is baked in its place: it gets textures, what lies over its threads stays, and its other
 * materials too; what cannot be baked is refused */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "scratch.h"
#include "weft/weft.h"

static char folder[SCRATCH_SIZE];

static int begin(void **state) {
    (void)state;
    return scratch_enter(folder) ? 0 : -1;
}
static int end(void **state) {
    (void)state;
    return chdir("/") == 0 && scratch_remove(folder) ? 0 : -1;
}

static WeftMaterial material_of(const WeftScene *scene) {
    WeftMaterial material;
    assert_int_equal(weft_scene_material(scene, 0, &material, NULL), WEFT_OK);
    return material;
}

static WeftScene *scene_of(const char *preset) {
    WeftScene *scene;
    WeftError error;
    WeftResult result = weft_scene_load("builtin:bend", &scene, NULL, &error);
    if (result == WEFT_OK) result = weft_scene_assign_material(scene, NULL, preset, NULL, &error);
    if (result == WEFT_OK) result = weft_scene_set(scene, "0.fuzz", "0.25", NULL, &error);
    if (result != WEFT_OK) fail_msg("%s", error.text);
    return scene;
}

static const WeftBaking small = {.pixels = 48};

static void textures_take_the_place_of_threads_below_the_fuzz(void **state) {
    (void)state;
    WeftScene *scene = scene_of("preset:woven-poplin");
    WeftBaked found = {0};
    WeftError error;
    assert_int_not_equal(material_of(scene).cloth, 0);
    if (weft_scene_bake(scene, 0, &small, "maps", &found, &error) != WEFT_OK) fail_msg("%s", error.text);
    assert_int_equal(system("rm -r maps"), 0); /* the scene has read them */
    const WeftMaterial baked = material_of(scene);
    assert_int_equal(baked.cloth, 0);
    assert_int_not_equal(baked.inputs[weft_material_input_find("base_color")].texture, 0);
    assert_int_not_equal(baked.inputs[weft_material_input_find("normal")].texture, 0);
    assert_float_equal(baked.inputs[weft_material_input_find("fuzz")].value[0], 0.25f, 1e-6f);
    assert_true(found.fitted > 0.0 && found.fitted < 0.3);
    if (weft_scene_save(scene, "baked.glb", &error) != WEFT_OK) fail_msg("%s", error.text);
    weft_scene_free(scene);
}

static void an_unwoven_material_is_refused(void **state) {
    (void)state;
    WeftError error;
    WeftScene *scene = scene_of("preset:velvet");
    assert_int_not_equal(weft_scene_bake(scene, 0, &small, "maps", NULL, &error), WEFT_OK);
    assert_non_null(strstr(error.text, "not woven"));
    assert_int_not_equal(weft_scene_bake(scene, 7, &small, "maps", NULL, &error), WEFT_OK);
    assert_int_not_equal(access("maps", F_OK), 0);
    weft_scene_free(scene);
    scene = scene_of("preset:woven-poplin");
    assert_int_not_equal(weft_scene_bake(scene, 0, &(WeftBaking){.pixels = 3}, "maps", NULL, &error), WEFT_OK);
    assert_int_not_equal(material_of(scene).cloth, 0);
    assert_int_not_equal(access("maps", F_OK), 0);
    weft_scene_free(scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(textures_take_the_place_of_threads_below_the_fuzz),
                                       cmocka_unit_test(an_unwoven_material_is_refused)};
    return cmocka_run_group_tests_name("measure/scene_bake", tests, begin, end);
}
