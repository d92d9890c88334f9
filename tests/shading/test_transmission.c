/* Light through cloth: how much goes where, both ways, and by which workflows */
#include "cases.h"

enum { PAIRS = 4000 };

static Dir mirrored(Dir i) { return dir(i.x, i.y, -i.z); }

/* A surface that lets a share through of what it would reflect, in the same colour. */
static Surface thin(Surface s, float share) {
    s.diffuse_transmission = share;
    s.diffuse_transmission_color = s.base_color;
    return s;
}

static const AlbedoTable *sheen_table(void) {
    static AlbedoTable table;
    static bool filled;
    if (!filled) fill_albedo(&table, LOBE_CHARLIE_CONTY_KULLA);
    filled = true;
    return &table;
}

static SeenStack seen_by(const Surface *s, int workflow, int layer, Dir o) {
    Choices choices = test_choices(LOBE_CHARLIE_CONTY_KULLA, layer);
    SeenStack seen;
    choices.workflow = workflow;
    seen_make(&seen, s, &choices, albedo_table_ref(sheen_table()), o);
    return seen;
}

static void close_to(Rgb a, Rgb b, float relative) {
    const float pairs[3][2] = {{a.r, b.r}, {a.g, b.g}, {a.b, b.b}};
    for (int c = 0; c < 3; c++)
        if (!(fabsf(pairs[c][0] - pairs[c][1]) <= relative * fabsf(pairs[c][1]) + 1e-6f))
            fail_msg("%g is not %g", (double)pairs[c][0], (double)pairs[c][1]);
}

static int workflow_named(const char *id) {
    int k = 0;
    while (strcmp(weft_workflow_name(k), id) != 0) k++;
    return k;
}

/* If nothing but the share changes, wi and its mirror image together send what wi sent. */
static void both_sides_receive_what_one_did(void **state) {
    (void)state;
    static const char *const workflows[] = {"metallic", "specular", "cloth", "free"};
    Random random = {3};
    for (int n = 0; n < PAIRS; n++) {
        Surface whole = random_surface(&random, n % 2);
        if (n % 3 == 0) whole = dusted(whole, random_unit(&random));
        Surface split = thin(whole, random_unit(&random));
        int workflow = workflow_named(workflows[n % 4]), layer = n / 4 % LAYER_COUNT;
        if (layer == LAYER_STOCHASTIC) continue; /* its walk meets another base */
        Dir o = random_direction(&random), i = random_direction(&random);
        SeenStack a = seen_by(&whole, workflow, layer, o), b = seen_by(&split, workflow, layer, o);
        close_to(rgb_add(seen_eval(&b, i, 1).f_cos, seen_eval(&b, mirrored(i), 1).f_cos), seen_eval(&a, i, 1).f_cos,
                 1e-4f);
        close_to(seen_eval(&a, mirrored(i), 1).f_cos, rgb_grey(0.0f), 0.0f);
    }
}

/* R + T of white cloth under a white sheen by the rule that conserves; midpoint sum on the grid of cases.h. */
static void white_cloth_sends_on_all_light(void **state) {
    (void)state;
    enum { CELLS = 150 };
    double worst = 0.0;
    for (int n = 0; n < 24; n++) {
        Surface cloth = thin(white_cloth(0.3f + 0.1f * (float)(n % 8)), 0.25f + 0.25f * (float)(n % 4));
        if (n >= 16) cloth.sheen_color = rgb_grey(0.0f);
        Dir o = direction_cos(0.1 + 0.035 * n, 0.0);
        SeenStack seen = seen_by(&cloth, workflow_named("cloth"), LAYER_ALBEDO_VIEW, o);
        if (seen.view.e_o.e > 1.0f) continue;
        Grid grid = grid_about(o);
        double step = 2.0 / CELLS, side[2] = {0.0};
        for (int j = 0; j < CELLS; j++)
            for (int k = 0; k < CELLS; k++) {
                double area;
                Dir i = grid_direction(grid, -1.0 + step * (j + 0.5), -1.0 + step * (k + 0.5), &area);
                side[0] += (double)seen_eval(&seen, i, 1).f_cos.g * area * step * step;
                side[1] += (double)seen_eval(&seen, mirrored(i), 1).f_cos.g * area * step * step;
            }
        double below = (double)cloth.diffuse_transmission * (1.0 - (double)seen.view.e_o.e);
        if (!(fabs(side[1] - below) < 1e-3)) fail_msg("case %d: %.5f below, not %.5f", n, side[1], below);
        worst = fmax(worst, fabs(side[0] + side[1] - 1.0));
    }
    print_message("R + T is 1 within %.1e\n", worst);
    assert_true(worst < 1e-3);
}

/* Light from i behind reaches o as strongly as light from o reaches i, seen from the back. */
static void light_goes_through_alike_both_ways(void **state) {
    (void)state;
    static const int layers[] = {LAYER_ADDITIVE, LAYER_SEED, LAYER_SIDE_BY_SIDE};
    Random random = {5};
    for (int n = 0; n < PAIRS; n++) {
        Surface s = thin(random_surface(&random, false), random_unit(&random));
        s.clearcoat = 0.0f; /* which dims by wo alone */
        Dir o = random_direction(&random), i = random_direction(&random);
        SeenStack front = seen_by(&s, 0, layers[n % 3], o), back = seen_by(&s, 0, layers[n % 3], i);
        close_to(rgb_scale(seen_eval(&front, mirrored(i), 1).f_cos, 1.0f / i.z),
                 rgb_scale(seen_eval(&back, mirrored(o), 1).f_cos, 1.0f / o.z), 1e-4f);
    }
}

/* Samples on both sides estimate what a uniform sum of f cos finds: no direction is drawn too often, or never. */
static void samples_find_all_light_of_both_sides(void **state) {
    (void)state;
    enum { SAMPLES = 200000 };
    Random random = {7};
    for (int n = 0; n < 6; n++) {
        Surface s = thin(random_surface(&random, false), 0.2f + 0.15f * (float)n);
        s.roughness = 0.5f + 0.5f * s.roughness;
        if (n == 5) s.base_color = rgb_grey(0.0f); /* it reflects nothing, and lets light through */
        Dir o = direction_cos(0.3 + 0.1 * n, 1.0);
        SeenStack seen = seen_by(&s, 0, n % 2 ? CHOICE_AUTO : LAYER_ALBEDO_MAX, o);
        double drawn[2] = {0.0}, uniform[2] = {0.0}, square[2] = {0.0};
        for (int k = 0; k < SAMPLES; k++) {
            Dir i = seen_sample(&seen, random_unit(&random), random_unit(&random));
            StackValue v = seen_eval(&seen, i, 1);
            double x = v.pdf > 0.0f ? (double)(v.f_cos.g / v.pdf) : 0.0;
            drawn[i.z < 0.0f] += x / SAMPLES;
            square[i.z < 0.0f] += x * x / SAMPLES;
            Dir any = random_direction(&random); /* over the hemisphere, evenly */
            uniform[0] += 2.0 * PI_DOUBLE * (double)seen_eval(&seen, any, 1).f_cos.g / SAMPLES;
            uniform[1] += 2.0 * PI_DOUBLE * (double)seen_eval(&seen, mirrored(any), 1).f_cos.g / SAMPLES;
        }
        for (int side = 0; side < 2; side++) {
            double error = (sqrt)(square[side] / SAMPLES) + 0.004 * uniform[side];
            if (!(fabs(drawn[side] - uniform[side]) < 5.0 * error))
                fail_msg("surface %d, side %d: %.5f, not %.5f", n, side, drawn[side], uniform[side]);
        }
    }
}

static void engines_without_transmission_let_nothing_through(void **state) {
    (void)state;
    Random random = {11};
    for (int n = 0; weft_profile_name(n); n++) {
        Surface s = thin(random_surface(&random, false), 0.5f);
        Choices choices = choices_unmade();
        SeenStack seen;
        s.metallic = 0.0f;
        choices.profile = n;
        if (n == 0) choices.workflow = workflow_named("disney"); /* of weft's own, all do */
        seen_make(&seen, &s, &choices, albedo_table_ref(sheen_table()), random_direction(&random));
        bool through = seen_eval(&seen, dir(0.0f, 0.0f, -1.0f), 1).f_cos.g > 0.0f;
        assert_int_equal(through, n == 0 || strncmp(weft_profile_name(n), "khr", 3) == 0);
    }
}

/* Woven bases are divided too. */
static void base_put_in_place_shares_its_light(void **state) {
    (void)state;
    Surface s = thin(white_cloth(0.5f), 0.25f);
    SeenStack seen = seen_by(&s, workflow_named("cloth"), LAYER_ADDITIVE, dir(0.0f, 0.6f, 0.8f));
    Lobe lambert = lobe_default(LOBE_LAMBERT);
    stack_put_base(&seen.stack, &lambert, rgb_grey(0.8f), rgb_grey(0.0f));
    seen_prepare(&seen, dir(0.0f, 0.6f, 0.8f));
    close_to(seen.stack.diffuse.f0, rgb_grey(0.6f), 1e-6f);
    assert_true(seen.stack.transmitted_p > 0.1f && seen.stack.transmitted_p < 0.9f);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(both_sides_receive_what_one_did),
        cmocka_unit_test(white_cloth_sends_on_all_light),
        cmocka_unit_test(light_goes_through_alike_both_ways),
        cmocka_unit_test(samples_find_all_light_of_both_sides),
        cmocka_unit_test(engines_without_transmission_let_nothing_through),
        cmocka_unit_test(base_put_in_place_shares_its_light),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
