/* Fuzz: where it is seen and the sheen is not, and what lies over what */
#include "cases.h"
#include "scene/record/material_at.h"

static int profile_named(const char *id) {
    int k = 0;
    while (strcmp(weft_profile_name(k), id) != 0) k++;
    return k;
}

/* A material of white fuzz over black, with a red sheen for engines without. */
static Material fuzzy(void) {
    Material m = material_default();
    material_set_color(&m, INPUT_base_color, 0.0f, 0.0f, 0.0f);
    m.inputs[INPUT_specular].value[0] = 0.0f;
    material_set_color(&m, INPUT_sheen_color, 1.0f, 0.0f, 0.0f);
    m.inputs[INPUT_sheen_roughness].value[0] = 0.5f;
    m.inputs[INPUT_fuzz].value[0] = 1.0f;
    return m;
}

static SeenStack seen_of(const Surface *s, const Choices *choices, Dir o) {
    SeenStack seen;
    seen_make(&seen, s, choices, (TableRef){.kind = TABLE_NONE}, o);
    return seen;
}

static Rgb light_of(const Surface *s, const Choices *choices) {
    const SeenStack seen = seen_of(s, choices, direction(1.2, 0.0));
    return seen_eval(&seen, direction(0.9, 2.0), 1).f_cos;
}

static void fuzz_wins_and_the_sheen_is_for_those_without(void **state) {
    (void)state;
    static const char *const with[] = {"none", "khr-fuzz", "khr-fuzz-exact", "openpbr"}, *const without[] = {
                                                                                             "khronos", "three",
                                                                                             "babylon",
                                                                                             "filament-sheen"};
    Material m = fuzzy();
    for (size_t k = 0; k < 4; k++) {
        m.choices[CHOICE_profile] = profile_named(with[k]);
        Choices choices = material_choices(&m);
        Surface s = material_plain(&m);
        Rgb f = light_of(&s, &choices);
        if (!(f.r > 0.01f && f.g > 0.99f * f.r)) fail_msg("%s shows no fuzz: %g %g", with[k], (double)f.r, (double)f.g);
        s.fuzz = 0.0f; /* as where a texture of it is black: there is no sheen either */
        f = light_of(&s, &choices);
        if (f.r > f.g + 1e-6f) fail_msg("%s shows a sheen of %g beside its fuzz", with[k], (double)f.r);
    }
    for (size_t k = 0; k < 4; k++) {
        m.choices[CHOICE_profile] = profile_named(without[k]);
        const Choices choices = material_choices(&m);
        const Surface s = material_plain(&m);
        const Rgb f = light_of(&s, &choices);
        if (!(f.r > 0.01f && f.g < 1e-6f)) fail_msg("%s does not show the sheen", without[k]);
    }
    m.choices[CHOICE_profile] = profile_named("core");
    const Choices choices = material_choices(&m);
    const Surface s = material_plain(&m);
    assert_true(light_of(&s, &choices).r > 0.0f); /* its highlight of 4 % alone */
    assert_float_equal(light_of(&s, &choices).r, light_of(&s, &choices).g, 1e-7f);
    m.choices[CHOICE_profile] = CHOICE_AUTO;
    m.choices[CHOICE_rim] = RIM_SHEEN;
    const Choices chosen = material_choices(&m);
    assert_true(light_of(&s, &chosen).g < 1e-6f);
}

/* Black fuzz over a coat that is a mirror: what the coat shows is dimmed. Under a coat fuzz would not be seen there. */
static void fuzz_lies_over_the_coat(void **state) {
    (void)state;
    Material m = fuzzy();
    material_set_color(&m, INPUT_fuzz_color, 0.0f, 0.0f, 0.0f);
    m.inputs[INPUT_clearcoat].value[0] = 1.0f;
    m.inputs[INPUT_clearcoat_roughness].value[0] = 0.2f;
    m.choices[CHOICE_profile] = profile_named("khr-fuzz");
    const Choices choices = material_choices(&m);
    const Dir o = direction(1.4, 0.0), i = direction(1.4, PI_DOUBLE);
    Surface s = material_plain(&m), bare = s;
    bare.fuzz = 0.0f;
    Lobe lobe = lobe_default(LOBE_LTC_FIBRE_PUBLISHED);
    lobe_set(&lobe, 0, s.fuzz_roughness);
    AlbedoTable *table = calloc(1, sizeof *table);
    albedo_table_fill(table, &lobe, s.fuzz_roughness, s.fuzz_roughness, 0);
    SeenStack over, none;
    seen_make(&over, &s, &choices, albedo_table_ref(table), o);
    seen_make(&none, &bare, &choices, albedo_table_ref(table), o);
    const double e = (double)albedo_quadrature(&lobe, o, 1e-4).f0;
    const double kept = (double)(seen_eval(&over, i, 1).f_cos.g / seen_eval(&none, i, 1).f_cos.g);
    free(table);
    assert_true(e > 0.2);
    if (!(fabs(kept - 1.0 + e) < 5e-3)) fail_msg("the coat keeps %g, not %g", kept, 1.0 - e);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fuzz_wins_and_the_sheen_is_for_those_without),
        cmocka_unit_test(fuzz_lies_over_the_coat),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
