/* The kinds of stacks: which materials they fit, and that they shade as the stack of any lobes does */
#include "cases.h"
#include "shading/kind.h"

enum { PROFILE_KHRONOS = 7, CASES = 3000 };

static bool is_any(const StackKind *kind) { return kind->see == stack_see; }

/* A surface with nothing that kinds leave out. */
static Surface random_plain(Random *random) {
    Surface s = random_surface(random, true);
    s.clearcoat = 0.0f;
    return s;
}

/* What textures may make of it: factors from 0 to 1 of some of its inputs. */
static Surface textured(Random *random, Surface s) {
    const float k = random_unit(random) < 0.2f ? 0.0f : random_unit(random);
    s.base_color = rgb_scale(s.base_color, k);
    s.metallic *= random_unit(random);
    s.roughness *= random_unit(random);
    s.specular *= random_unit(random) < 0.2f ? 0.0f : 1.0f;
    s.sheen_color = rgb_scale(s.sheen_color, random_unit(random) < 0.2f ? 0.0f : k);
    s.sheen_roughness *= random_unit(random);
    return s;
}

static const AlbedoTable *table_of(int lobe) {
    static AlbedoTable tables[2];
    static bool filled[2];
    int k = lobe == LOBE_CHARLIE_KHRONOS;
    if (!filled[k]) albedo_table_fill(&tables[k], &(Lobe){lobe, {0.25f}}, 0.005f, 1.0f, 0);
    filled[k] = true;
    return &tables[k];
}

/* Makes, sees, evaluates and samples a textured point both ways. */
static void shade_alike(Random *random, const StackKind *kind, const Surface *plain, const Choices *choices,
                        TableRef e) {
    SeenStack any;
    Stack stack;
    StackView view;
    Surface s = textured(random, *plain);
    Dir o = random_direction(random), i = random_direction(random), sample;
    float u = random_unit(random), v = random_unit(random);
    seen_make(&any, &s, choices, e, o);
    kind->make(&stack, &s, choices, e);
    kind->see(&stack, &o, &view);
    for (int k = 0; k < 2; k++) {
        StackValue value, expected = seen_eval(&any, i, 1);
        kind->eval(&stack, &view, &i, 1, &value);
        assert_memory_equal(&value, &expected, sizeof value);
        kind->sample(&stack, &view, u, v, &sample);
        i = seen_sample(&any, u, v);
        assert_memory_equal(&i, &sample, sizeof i);
    }
}

static void kinds_shade_alike(void **state) {
    (void)state;
    Random random = {31};
    int known = 0;
    for (int n = 0; n < CASES; n++) {
        Surface plain = random_plain(&random);
        Choices choices = choices_unmade();
        if (n % 2) choices.profile = PROFILE_KHRONOS;
        TableRef e = albedo_table_ref(table_of(n % 2 ? LOBE_CHARLIE_KHRONOS : LOBE_CHARLIE_CONTY_KULLA));
        Stack stack;
        stack_make(&stack, &plain, &choices, e);
        const StackKind *kind = stack_kind(&stack, &choices);
        known += !is_any(kind);
        for (int k = 0; k < 4; k++) shade_alike(&random, kind, &plain, &choices, e);
    }
    assert_int_equal(known, CASES); /* but what has neither a coat nor dust has a kind */
}

static void others_have_the_stack_of_any_lobes(void **state) {
    (void)state;
    Random random = {37};
    TableRef e = albedo_table_ref(table_of(LOBE_CHARLIE_CONTY_KULLA));
    for (int n = 0; n < 5; n++) {
        Surface s = random_plain(&random);
        Choices c = choices_unmade();
        if (n == 0) s.clearcoat = 0.5f;
        if (n == 1) s = dusted(s, 1.0f);
        if (n == 2) c.diffuse = LOBE_OREN_NAYAR;
        if (n == 3) c.layer = LAYER_STOCHASTIC;
        if (n == 4) c.sheen_lobe = LOBE_FIBRE;
        Stack stack;
        stack_make(&stack, &s, &c, e);
        assert_true(is_any(stack_kind(&stack, &c)));
    }
    assert_true(is_any(stack_kind(NULL, &(Choices){0})));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(kinds_shade_alike),
        cmocka_unit_test(others_have_the_stack_of_any_lobes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
