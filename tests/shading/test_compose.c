/* Choices beside a workflow or a profile: what they replace, and what they leave alone */
#include "cases.h"

static Surface plain(void) {
    return (Surface){.base_color = {1.0f, 1.0f, 1.0f},
                     .specular_color = {1.0f, 1.0f, 1.0f},
                     .specular = 1.0f,
                     .reflectance = 0.26f,
                     .sheen = 1.0f,
                     .sheen_density = 1.0f,
                     .sheen_second = {1.0f, 1.0f, 1.0f},
                     .normal = {0.0f, 0.0f, 1.0f},
                     .clearcoat_normal = {0.0f, 0.0f, 1.0f},
                     .anisotropy_direction = {1.0f, 0.0f, 0.0f}};
}

static Stack made(const Surface *surface, Choices choices, Dir o) {
    static AlbedoTable table;
    static bool filled;
    if (!filled) fill_albedo(&table, LOBE_CHARLIE_CONTY_KULLA);
    filled = true;
    Stack stack;
    stack_make(&stack, surface, &choices, albedo_table_ref(&table), o);
    return stack;
}

static double furnace(const Surface *surface, Choices choices, double cos_o) {
    enum { CELLS = 200 };
    Dir o = direction_cos(cos_o, 0.0);
    Stack stack = made(surface, choices, o);
    Grid grid = grid_about(o);
    double step = 2.0 / CELLS, sum = 0.0;
    for (int j = 0; j < CELLS; j++)
        for (int k = 0; k < CELLS; k++) {
            double area;
            Dir i = grid_direction(grid, -1.0 + step * (j + 0.5), -1.0 + step * (k + 0.5), &area);
            if (i.z > 0.0f) sum += (double)stack_eval(&stack, o, i, 0).f_cos.g * area * step * step;
        }
    return sum;
}

static const double cosines[] = {1.0, 0.4, 0.15, 0.05};
enum { COSINES = sizeof cosines / sizeof cosines[0] };

/* Rule seed leaves what wears no sheen as it is, and gains nothing on dielectrics or metals. */
static void seed_gains_nothing(void **state) {
    (void)state;
    for (int metal = 0; metal < 2; metal++)
        for (int c = 0; c < COSINES; c++) {
            Surface surface = plain();
            surface.roughness = 0.3f;
            surface.metallic = (float)metal;
            Choices any = test_choices(CHOICE_AUTO, CHOICE_AUTO),
                    seed = test_choices(CHOICE_AUTO, LAYER_SEED);
            assert_float_equal(furnace(&surface, seed, cosines[c]), furnace(&surface, any, cosines[c]), 1e-6);
            surface.sheen_color = (Rgb){1.0f, 1.0f, 1.0f};
            surface.sheen_roughness = 0.8f;
            double all = furnace(&surface, seed, cosines[c]);
            if (all > 1.0 + 1e-3) fail_msg("metal %d at cos_o %g: %.4f", metal, cosines[c], all);
        }
}

/* F that has an index of refraction takes that of the reflectance where none is given. */
static void fresnel_follows_the_reflectance(void **state) {
    (void)state;
    Surface surface = plain();
    surface.base_color = (Rgb){0.0f, 0.0f, 0.0f};
    surface.roughness = 0.1f;
    Choices choices = test_choices(CHOICE_AUTO, CHOICE_AUTO);
    choices.f = F_DIELECTRIC;
    assert_float_equal(furnace(&surface, choices, 1.0), 0.03, 1e-3);
    assert_true(furnace(&surface, choices, 0.15) > 0.3);
}

/* A choice of F alone keeps the shape of the highlight, brushed or not. */
static void brushed_metal_stays_brushed(void **state) {
    (void)state;
    Dir o = direction(0.0, 0.0), along = direction(0.5, 0.0), across = direction(0.5, 0.5 * TEST_PI);
    for (int silk = 0; silk < 2; silk++) {
        Surface surface = plain();
        surface.metallic = silk ? 0.0f : 1.0f;
        if (silk) surface.base_color = (Rgb){0.0f, 0.0f, 0.0f};
        surface.roughness = 0.3f;
        surface.anisotropy = 0.7f;
        Choices plainly = test_choices(CHOICE_AUTO, CHOICE_AUTO), chosen = plainly;
        if (silk) plainly.profile = chosen.profile = 3; /* hdrp-silk */
        chosen.f = F_SCHLICK;
        Stack a = made(&surface, plainly, o), b = made(&surface, chosen, o);
        assert_true(stack_eval(&a, o, along, 0).f_cos.g > 4.0f * stack_eval(&a, o, across, 0).f_cos.g);
        for (int k = 0; k < 2; k++) {
            Dir i = k ? across : along;
            float f = stack_eval(&a, o, i, 0).f_cos.g;
            assert_float_equal(stack_eval(&b, o, i, 0).f_cos.g, f, 1e-3f * f);
        }
    }
    assert_string_equal(weft_profile_id(3), "hdrp-silk");
}

/* A rule that asks for more than an engine's own E gets the table of the lobe. */
static void reciprocal_asks_the_table(void **state) {
    (void)state;
    for (int profile = 1; weft_profile_id(profile); profile++)
        for (int layer = 0; layer < 2; layer++) {
            Surface surface = plain();
            surface.sheen_color = (Rgb){1.0f, 1.0f, 1.0f};
            surface.sheen_roughness = 0.5f;
            Choices choices = test_choices(CHOICE_AUTO, layer ? LAYER_STOCHASTIC : LAYER_RECIPROCAL);
            choices.profile = profile;
            Stack stack = made(&surface, choices, direction_cos(0.5, 0.0));
            if (stack.sheen.pick > 0.0f) assert_true(stack.albedo <= ALBEDO_KHRONOS && stack.e_avg.e > 0.0f);
        }
}

/* The azimuth of shading text is the C library's. */
static void azimuth_is_atan2(void **state) {
    (void)state;
    Random random = {17};
    for (int k = 0; k < 20000; k++) {
        double phi = 2.0 * TEST_PI * (double)random_unit(&random), r = k & 1 ? 1.0 : 1e-3;
        if (k < 16) phi = 0.125 * TEST_PI * k;
        Dir w = dir((float)(r * (cos)(phi)), (float)(r * (sin)(phi)), 0.0f);
        double expected = atan2((double)w.y, (double)w.x);
        if (expected < 0.0) expected += 2.0 * TEST_PI;
        float found = azimuth_of(w);
        if (!(fabs((double)found - expected) < 1e-6 && found >= 0.0f && found <= 2.0f * PI))
            fail_msg("%.9g is not %.9g", (double)found, expected);
    }
    assert_true(azimuth_of(dir(0.0f, 0.0f, 1.0f)) <= 0.0f);
}

/* Density and nap go where a lobe has them, clamped; all else is as roughness makes it. */
static void fibres_find_their_parameters(void **state) {
    (void)state;
    static const char *const names[] = {"density", "tilt", "azimuth"};
    const float values[] = {3.0f, 0.5f, 2.0f}, far[] = {1e3f, 1e3f, 1e3f};
    for (int id = 0; id < LOBE_COUNT; id++)
        for (int beyond = 0; beyond < 2; beyond++) {
            const float *given = beyond ? far : values;
            Lobe plainly = lobe_rough(id, 0.6f), lobe = lobe_fibres(plainly, given[0], given[1], given[2]);
            for (int k = 0; k < weft_lobe_info(id)->param_count; k++) {
                const WeftParamInfo *info = &weft_lobe_info(id)->params[k];
                float expected = plainly.params[k];
                for (int n = 0; n < 3 && k > 0; n++)
                    if (strcmp(info->name, names[n]) == 0) expected = min(given[n], info->hard_high);
                assert_true(lobe.params[k] >= expected && lobe.params[k] <= expected);
            }
        }
    Surface surface = plain();
    surface.sheen_color = (Rgb){1.0f, 1.0f, 1.0f};
    surface.sheen_density = 2.0f;
    surface.nap = 0.6f;
    surface.nap_direction = dir(0.0f, -1.0f, 0.0f);
    Stack stack = made(&surface, test_choices(LOBE_FIBRE_WALK, LAYER_ADDITIVE), direction_cos(0.5, 0.0));
    const float *params = stack.sheen.lobe.params;
    assert_float_equal(params[lobe_param(LOBE_FIBRE_WALK, "density")], 2.0f, 0.0f);
    assert_float_equal(params[lobe_param(LOBE_FIBRE_WALK, "tilt")], 0.6f, 0.0f);
    assert_float_equal(params[lobe_param(LOBE_FIBRE_WALK, "azimuth")], 1.5f * PI, 1e-6f);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(seed_gains_nothing),
        cmocka_unit_test(fresnel_follows_the_reflectance),
        cmocka_unit_test(brushed_metal_stays_brushed),
        cmocka_unit_test(reciprocal_asks_the_table),
        cmocka_unit_test(azimuth_is_atan2),
        cmocka_unit_test(fibres_find_their_parameters),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
