/* A material without a scene: the default, presets and files, and what is set by name. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "weft/weft.h"

static int input(const char *name) {
    for (int k = 0; weft_material_input_name(k); k++)
        if (strcmp(weft_material_input_name(k), name) == 0) return k;
    fail_msg("%s", name);
    return -1;
}

static void default_material_has_the_default_inputs(void **state) {
    (void)state;
    WeftMaterial m;
    WeftInputInfo info;
    weft_material_default(&m);
    for (int k = 0; weft_material_input_info(k, &info); k++) {
        if (info.kind == WEFT_INPUT_ANGLE || info.kind == WEFT_INPUT_DIRECTION) continue;
        assert_float_equal(m.inputs[k].value[0], info.initial, 1e-6);
        assert_int_equal(m.inputs[k].given, 0);
    }
    for (int k = 0; weft_material_choice_name(k); k++) assert_int_equal(m.choices[k], -1);
}

/* What a preset is alone is what it is on a scene. */
static void preset_on_a_material_equals_preset_on_a_scene(void **state) {
    (void)state;
    WeftScene *scene;
    WeftError error;
    assert_int_equal(weft_scene_load("builtin:cloth", &scene, NULL, &error), WEFT_OK);
    for (int k = 0; weft_preset_name(k); k++) {
        char path[128];
        WeftMaterial alone, worn;
        WeftReflection *reflection;
        snprintf(path, sizeof path, "preset:%s", weft_preset_name(k));
        assert_int_equal(weft_material_read(path, &alone, NULL, &error), WEFT_OK);
        assert_int_equal(weft_scene_assign_material(scene, "0", path, NULL, &error), WEFT_OK);
        assert_int_equal(weft_scene_material(scene, 0, &worn, &error), WEFT_OK);
        for (int i = 0; weft_material_input_name(i); i++)
            if (i != input("normal") && i != input("occlusion") && i != input("opacity"))
                assert_memory_equal(alone.inputs[i].value, worn.inputs[i].value, sizeof worn.inputs[i].value);
        assert_memory_equal(alone.choices, worn.choices, sizeof worn.choices);
        assert_int_equal(weft_reflection_create(&alone, &reflection, &error), WEFT_OK);
        weft_reflection_free(reflection);
    }
    weft_scene_free(scene);
    WeftMaterial none;
    assert_int_equal(weft_material_read("preset:nothing", &none, NULL, &error), WEFT_USAGE);
    assert_int_equal(error.message, WEFT_MESSAGE_PRESET_NAME);
    assert_int_equal(weft_material_read("nothing.json", &none, NULL, &error), WEFT_INPUT);
}

static int warnings;
static void count(void *user, WeftMessage message, const char *text) {
    (void)user;
    (void)text;
    warnings += message == WEFT_MESSAGE_PARAM_RANGE;
}

static void inputs_and_choices_are_set_by_name(void **state) {
    (void)state;
    const WeftLog log = {.fn = count};
    WeftMaterial m, before;
    WeftError error;
    weft_material_default(&m);
    assert_int_equal(weft_material_set(&m, "sheen_color", "1,0.5,0.25", &log, &error), WEFT_OK);
    assert_float_equal(m.inputs[input("sheen_color")].value[1], 0.5f, 0.0);
    assert_int_equal(m.inputs[input("sheen_color")].given, 1);
    assert_int_equal(weft_material_set(&m, "profile", "three", &log, &error), WEFT_OK);
    assert_int_equal(warnings, 0);
    assert_int_equal(weft_material_set(&m, "roughness", "7", &log, &error), WEFT_OK);
    assert_int_equal(warnings, 1);
    before = m;
    assert_int_equal(weft_material_set(&m, "profile", "thre", &log, &error), WEFT_USAGE);
    assert_int_equal(weft_material_set(&m, "colour", "1", &log, &error), WEFT_USAGE);
    assert_int_equal(error.message, WEFT_MESSAGE_PARAM_NAME);
    assert_int_equal(weft_material_set(&m, "roughness", "inf", &log, &error), WEFT_USAGE);
    assert_memory_equal((const char *)&m, (const char *)&before, sizeof m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(default_material_has_the_default_inputs),
        cmocka_unit_test(preset_on_a_material_equals_preset_on_a_scene),
        cmocka_unit_test(inputs_and_choices_are_set_by_name),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
