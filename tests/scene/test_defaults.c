/* Workflows' own defaults come and go with them, and never over what somebody gave */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "scene/record/scene.h"
#include "shading/material/choice.h"

static void choose(Material *material, ChoiceId choice, const char *id) {
    material_choose(material, choice, id ? choice_find(choice, id) : CHOICE_AUTO);
}

static float value(const Material *material, InputId id) { return material->inputs[id].value[0]; }

static void untouched_inputs_follow_the_defaults_of_the_workflow(void **state) {
    (void)state;
    Material m = material_default();
    choose(&m, CHOICE_workflow, "disney");
    assert_float_equal(value(&m, INPUT_specular), 0.5f, 0.0f);
    assert_float_equal(value(&m, INPUT_sheen), 0.0f, 0.0f);
    choose(&m, CHOICE_workflow, "specular");
    assert_float_equal(value(&m, INPUT_specular), 1.0f, 0.0f);
    assert_float_equal(value(&m, INPUT_sheen), 1.0f, 0.0f);
    assert_float_equal(m.inputs[INPUT_specular_color].value[2], 0.03f, 0.0f);
    choose(&m, CHOICE_profile, "disney-2012"); /* above any workflow */
    assert_float_equal(value(&m, INPUT_specular), 0.5f, 0.0f);
    assert_float_equal(value(&m, INPUT_specular_color), 1.0f, 0.0f);
    choose(&m, CHOICE_profile, NULL);
    choose(&m, CHOICE_workflow, NULL);
    assert_float_equal(value(&m, INPUT_specular_color), 1.0f, 0.0f);
    assert_float_equal(value(&m, INPUT_sheen), 1.0f, 0.0f);
}

static void given_inputs_keep_their_values(void **state) {
    (void)state;
    Material m = material_default();
    m.inputs[INPUT_sheen].given = true;       /* the default itself, but meant */
    m.inputs[INPUT_specular].value[0] = 0.7f; /* an asset's */
    m.inputs[INPUT_specular_color].texture = 1;
    choose(&m, CHOICE_workflow, "disney");
    assert_float_equal(value(&m, INPUT_sheen), 1.0f, 0.0f);
    assert_float_equal(value(&m, INPUT_specular), 0.7f, 1e-7f);
    choose(&m, CHOICE_workflow, "specular");
    assert_float_equal(value(&m, INPUT_specular_color), 1.0f, 0.0f);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(untouched_inputs_follow_the_defaults_of_the_workflow),
        cmocka_unit_test(given_inputs_keep_their_values),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
