/* The kinds of stacks: which materials they fit, and that they shade as the stack of any lobes does but for
 * the last bits */
#include "cases.h"
#include "shading/kinds/kind.h"

enum { PROFILE_KHRONOS = 7, CASES = 300 };

/* A surface with nothing that kinds leave out; half of them are coated. */
static Surface random_plain(Random *random) {
    Surface s = random_surface(random, true);
    s.clearcoat = random_unit(random) < 0.5f ? 0.0f : random_unit(random);
    return s;
}

/* Makes a random surface that lets light through. */
static Surface random_thin(Random *random) {
    Surface s = random_plain(random);
    s.clearcoat = 0.0f;
    s.diffuse_transmission = 0.05f + 0.95f * random_unit(random);
    s.diffuse_transmission_color = rgb(random_unit(random), random_unit(random), random_unit(random));
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
    s.clearcoat *= random_unit(random) < 0.2f ? 0.0f : random_unit(random);
    s.diffuse_transmission *= random_unit(random) < 0.2f ? 0.0f : random_unit(random);
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

static bool close(float a, float b) { return fabsf(a - b) <= 1e-5f + 2e-4f * fabsf(b); }

static void value_is(KindVertices *v, int direction, int k, StackValue expected) {
    assert_true(close(v->f[direction][0][k], expected.f_cos.r));
    assert_true(close(v->f[direction][1][k], expected.f_cos.g));
    assert_true(close(v->f[direction][2][k], expected.f_cos.b));
    assert_true(close(v->pdf[direction][k], expected.pdf));
}

/* Puts a random point of a thread into both. */
static void weave_both(Random *random, YarnRows *rows, size_t k, SeenStack *any, Dir o) {
    Lobe yarn = lobe_default(LOBE_YARN);
    yarn.params[YARN_SLOPE_X] = random_unit(random) - 0.5f;
    yarn.params[YARN_SLOPE_Y] = random_unit(random) - 0.5f;
    yarn.params[YARN_AZIMUTH] = 6.0f * random_unit(random);
    const Rgb once = rgb(random_unit(random), random_unit(random), 0.0f), again = rgb(0.3f, 0.0f, once.r);
    for (int p = 0; p < LOBE_PARAMS_MAX; p++) rows->params[p][k] = yarn.params[p];
    rows->single[0][k] = once.r, rows->single[1][k] = once.g, rows->single[2][k] = once.b;
    rows->multiple[0][k] = again.r, rows->multiple[1][k] = again.g, rows->multiple[2][k] = again.b;
    stack_put_base(&any->stack, &yarn, once, again);
    stack_see(&any->stack, &o, &any->view);
}

/* Shades textured points both ways, one light from above and one from below. */
static void shade_alike(Random *random, const StackKind *kind, const Surface *plain, const Choices *choices, TableRef e,
                        bool woven) {
    static KindVertices v;
    static SeenStack any[ROW_MOST];
    for (int k = 0; k < ROW_MOST; k++) {
        Surface s = textured(random, *plain);
        Dir o = random_direction(random), i = random_direction(random);
        seen_make(&any[k], &s, choices, e, o);
        if (woven) weave_both(random, &v.yarn, (size_t)k, &any[k], o);
        surface_to_row(&v.surface, (size_t)k, &s);
        v.o[0][k] = o.x, v.o[1][k] = o.y, v.o[2][k] = o.z;
        v.i[0][0][k] = i.x, v.i[0][1][k] = i.y, v.i[0][2][k] = i.z;
        v.i[2][0][k] = i.x, v.i[2][1][k] = i.y, v.i[2][2][k] = -i.z;
        v.u[k] = random_unit(random), v.v[k] = random_unit(random);
    }
    kind_shade(kind, &v, e, (const bool[KIND_LIGHTS]){true, false, true}, ROW_MOST);
    for (int k = 0; k < ROW_MOST; k++) {
        Dir i = dir(v.i[0][0][k], v.i[0][1][k], v.i[0][2][k]), expected = seen_sample(&any[k], v.u[k], v.v[k]);
        Dir drawn = dir(v.i[KIND_DRAWN][0][k], v.i[KIND_DRAWN][1][k], v.i[KIND_DRAWN][2][k]);
        value_is(&v, 0, k, seen_eval(&any[k], i, 1));
        value_is(&v, 2, k, seen_eval(&any[k], dir(i.x, i.y, -i.z), 1));
        bool none = !(seen_eval(&any[k], expected, 1).pdf > 0.0f) && !(drawn.z > 0.0f);
        assert_true(none ||
                    fabsf(drawn.x - expected.x) + fabsf(drawn.y - expected.y) + fabsf(drawn.z - expected.z) < 2e-3f);
        value_is(&v, KIND_DRAWN, k, seen_eval(&any[k], drawn, 1));
    }
}

static void kinds_shade_as_the_general_stack(void **state) {
    (void)state;
    Random random = {31};
    for (int n = 0; n < CASES; n++) {
        Surface plain = n % 4 ? random_plain(&random) : random_thin(&random);
        Choices choices = choices_unmade();
        if (n % 2) choices.profile = PROFILE_KHRONOS;
        TableRef e = albedo_table_ref(table_of(n % 2 ? LOBE_CHARLIE_KHRONOS : LOBE_CHARLIE_CONTY_KULLA));
        Stack stack;
        stack_make(&stack, &plain, &choices, e);
        const StackKind *kind = stack_kind(&stack, &choices);
        assert_non_null(kind); /* what has no dust has one */
        shade_alike(&random, kind, &plain, &choices, e, false);
    }
}

static void woven_kinds_shade_as_the_general_stack(void **state) {
    (void)state;
    Random random = {41};
    const Choices choices = choices_unmade();
    const TableRef e = albedo_table_ref(table_of(LOBE_CHARLIE_CONTY_KULLA));
    const Lobe yarn = lobe_default(LOBE_YARN);
    for (int n = 0; n < CASES; n++) {
        Surface plain = random_plain(&random);
        Stack stack;
        plain.clearcoat = n < 2 ? 0.5f : 0.0f;
        if (n % 2) plain.sheen_color = rgb_grey(0.0f);
        stack_make(&stack, &plain, &choices, e);
        stack_put_base(&stack, &yarn, rgb_grey(1.0f), rgb_grey(1.0f));
        const StackKind *kind = stack_kind(&stack, &choices);
        if (n < 2)
            assert_null(kind); /* no kind is woven and coated */
        else
            shade_alike(&random, kind, &plain, &choices, e, true);
    }
}

static void stack_outside_the_list_has_no_kind(void **state) {
    (void)state;
    Random random = {37};
    TableRef e = albedo_table_ref(table_of(LOBE_CHARLIE_CONTY_KULLA));
    for (int n = 0; n < 6; n++) {
        Surface s = n == 5 ? random_thin(&random) : random_plain(&random);
        if (n == 5) s.clearcoat = 0.5f;
        Choices c = choices_unmade();
        if (n == 0) c.profile = 1;
        if (n == 1) s = dusted(s, 1.0f);
        if (n == 2) c.diffuse = LOBE_OREN_NAYAR;
        if (n == 3) c.layer = LAYER_STOCHASTIC;
        if (n == 4) c.sheen_lobe = LOBE_FIBRE;
        Stack stack;
        stack_make(&stack, &s, &c, e);
        assert_null(stack_kind(&stack, &c));
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(kinds_shade_as_the_general_stack),
        cmocka_unit_test(woven_kinds_shade_as_the_general_stack),
        cmocka_unit_test(stack_outside_the_list_has_no_kind),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
