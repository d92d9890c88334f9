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

static int input(const char *name) { return weft_material_input_find(name); }

/* Counts warnings, and keeps the last. */
typedef struct Warned {
    int count;
    char last[256];
} Warned;

static void warned(void *user, WeftMessage message, const char *text) {
    Warned *self = user;
    (void)message;
    self->count++;
    snprintf(self->last, sizeof self->last, "%s", text);
}

/* Bakes poplin below what is given. Returns what the fit found. */
static WeftBaked bake_below(float emission, float dust, const char *to, WeftMaterial *baked, Warned *warnings) {
    const WeftLog log = {.fn = warned, .user = warnings};
    WeftBaking baking = small;
    WeftBaked found = {0};
    WeftError error;
    WeftScene *scene = scene_of("preset:woven-poplin");
    WeftMaterial material = material_of(scene);
    baking.log = &log;
    material.inputs[input("emission")].value[0] = emission;
    material.inputs[input("emission_strength")].value[0] = 2.0f;
    material.inputs[input("dust")].value[0] = dust;
    assert_int_equal(weft_scene_put_material(scene, 0, &material, &error), WEFT_OK);
    if (weft_scene_bake(scene, 0, &baking, to, &found, &error) != WEFT_OK) fail_msg("%s", error.text);
    *baked = material_of(scene);
    weft_scene_free(scene);
    return found;
}

/* Emission stays; dust changes nothing of the textures and their numbers, and is said to be lost. */
static void inputs_over_threads_are_kept_or_said_to_be_lost(void **state) {
    (void)state;
    WeftMaterial glowing, dusty;
    Warned none = {0}, one = {0};
    const WeftBaked without = bake_below(1.0f, 0.0f, "glowing", &glowing, &none);
    assert_float_equal(glowing.inputs[input("emission")].value[0], 1.0f, 1e-6f);
    assert_float_equal(glowing.inputs[input("emission_strength")].value[0], 2.0f, 1e-6f);
    assert_int_equal(none.count, 0);
    const WeftBaked with = bake_below(0.0f, 0.8f, "dusty", &dusty, &one);
    assert_true(with.sky <= without.sky && with.sky >= without.sky);
    assert_float_equal(dusty.inputs[input("dust")].value[0], 0.0f, 0.0f);
    assert_int_equal(system("cmp glowing/base_color.png dusty/base_color.png"), 0);
    assert_int_equal(one.count, 1);
    if (!strstr(one.last, "dust of 0.8 is not baked")) fail_msg("%s", one.last);
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
                                       cmocka_unit_test(inputs_over_threads_are_kept_or_said_to_be_lost),
                                       cmocka_unit_test(an_unwoven_material_is_refused)};
    return cmocka_run_group_tests_name("measure/scene_bake", tests, scratch_group_begin, scratch_group_end);
}
