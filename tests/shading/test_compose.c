/* Choices beside a workflow or a profile: what they replace, and what they leave alone */
#include "cases.h"
#include "shading/material/choice.h"

static Surface plain(void) {
    return (Surface){.base_color = {1.0f, 1.0f, 1.0f},
                     .specular_color = {1.0f, 1.0f, 1.0f},
                     .specular = 1.0f,
                     .reflectance = 0.26f,
                     .sheen = 1.0f,
                     .sheen_density = 1.0f,
                     .sheen_tail = 0.6f,
                     .sheen_rise = 3.0f,
                     .diffuse_retro = 0.3f,
                     .diffuse_lift = 0.3f,
                     .sheen_second = {1.0f, 1.0f, 1.0f},
                     .normal = {0.0f, 0.0f, 1.0f},
                     .clearcoat_normal = {0.0f, 0.0f, 1.0f},
                     .anisotropy_direction = {1.0f, 0.0f, 0.0f}};
}

static SeenStack made(const Surface *surface, Choices choices, Dir o) {
    static AlbedoTable table;
    static bool filled;
    if (!filled) fill_albedo(&table, LOBE_CHARLIE_CONTY_KULLA);
    filled = true;
    SeenStack stack;
    seen_make(&stack, surface, &choices, albedo_table_ref(&table), o);
    return stack;
}

static double furnace(const Surface *surface, Choices choices, double cos_o) {
    enum { CELLS = 200 };
    Dir o = direction_cos(cos_o, 0.0);
    SeenStack stack = made(surface, choices, o);
    Grid grid = grid_about(o);
    double step = 2.0 / CELLS, sum = 0.0;
    for (int j = 0; j < CELLS; j++)
        for (int k = 0; k < CELLS; k++) {
            double area;
            Dir i = grid_direction(grid, -1.0 + step * (j + 0.5), -1.0 + step * (k + 0.5), &area);
            if (i.z > 0.0f) sum += (double)seen_eval(&stack, i, 0).f_cos.g * area * step * step;
        }
    return sum;
}

static const double cosines[] = {1.0, 0.4, 0.15, 0.05};
enum { COSINES = sizeof cosines / sizeof cosines[0] };

static double power5(double x) { return x * x * x * x * x; }

/* D, V and F of the metallic workflow's highlight, and charlie-neubelt, as their papers print them. */
static double ggx_dv(double alpha, Dir o, Dir i, double cos_h) {
    double a2 = alpha * alpha, q = cos_h * cos_h * (a2 - 1.0) + 1.0, z_o = (double)o.z, z_i = (double)i.z;
    double seen = z_o * (sqrt)(z_i * z_i * (1.0 - a2) + a2) + z_i * (sqrt)(z_o * z_o * (1.0 - a2) + a2);
    return a2 / (PI_DOUBLE * q * q) * 0.5 / seen;
}
static double charlie_neubelt_dv(double alpha, Dir o, Dir i, double cos_h) {
    double d = (2.0 + 1.0 / alpha) * (pow)(1.0 - cos_h * cos_h, 0.5 / alpha) / (2.0 * PI_DOUBLE);
    return d / (4.0 * ((double)o.z + (double)i.z - (double)o.z * (double)i.z));
}

/* f = (1 - F)(1 - k) diffuse + specular + (1 - F) k sheen, of one channel. */
static double seed_by_hand(double base, double color, const Surface *s, Dir o, Dir i) {
    double x = (double)o.x + (double)i.x, y = (double)o.y + (double)i.y, z = (double)o.z + (double)i.z;
    double length = (sqrt)(x * x + y * y + z * z), cos_h = z / length, d = 0.5 * length;
    double m = (double)s->metallic, f_0 = 0.03 * (1.0 - m) + base * m, k = (double)s->sheen;
    double f = f_0 + (1.0 - f_0) * power5(1.0 - d), diffuse = base * (1.0 - m) / PI_DOUBLE;
    double r = (double)s->roughness, r_s = (double)s->sheen_roughness;
    double specular = f * ggx_dv(r * r, o, i, cos_h);
    double sheen = color * charlie_neubelt_dv(r_s * r_s, o, i, cos_h);
    return (1.0 - f) * (1.0 - k) * diffuse + specular + (1.0 - f) * k * sheen;
}

/* Rule seed is its formula, to the letter, for dielectrics and coloured metals. */
static void rule_seed_is_its_formula(void **state) {
    (void)state;
    Random random = {71};
    Choices choices = test_choices(LOBE_CHARLIE_NEUBELT, LAYER_SEED);
    double worst = 0.0;
    for (int n = 0; n < 5000; n++) {
        Surface s = plain();
        s.base_color = (Rgb){random_unit(&random), random_unit(&random), random_unit(&random)};
        s.sheen_color = (Rgb){random_unit(&random), 0.1f + random_unit(&random), random_unit(&random)};
        s.sheen = random_unit(&random);
        s.metallic = n % 3 ? 0.0f : random_unit(&random);
        s.roughness = 0.3f + 0.7f * random_unit(&random);
        s.sheen_roughness = 0.3f + 0.7f * random_unit(&random);
        Dir o = random_direction(&random), i = random_direction(&random);
        SeenStack stack = made(&s, choices, o);
        Rgb f_cos = seen_eval(&stack, i, 0).f_cos;
        const float found[] = {f_cos.r, f_cos.g, f_cos.b}, base[] = {s.base_color.r, s.base_color.g, s.base_color.b},
                    color[] = {s.sheen_color.r, s.sheen_color.g, s.sheen_color.b};
        for (int c = 0; c < 3; c++) {
            double f = seed_by_hand((double)base[c], (double)color[c], &s, o, i);
            worst = fmax(worst, fabs((double)found[c] / (double)i.z - f) / fmax(f, 1e-3));
        }
    }
    print_message("seed within %.1e of its formula\n", worst);
    assert_true(worst < 1e-5);
}

/* Without a sheen there is nothing to blend with, whatever amount is asked for. */
static void rule_seed_without_a_sheen_changes_nothing(void **state) {
    (void)state;
    Surface surface = plain();
    surface.roughness = 0.3f;
    for (int c = 0; c < COSINES; c++)
        assert_float_equal(furnace(&surface, test_choices(CHOICE_AUTO, LAYER_SEED), cosines[c]),
                           furnace(&surface, test_choices(CHOICE_AUTO, CHOICE_AUTO), cosines[c]), 1e-6);
}

/* Rule side-by-side leaves what wears no sheen as it is, and gains nothing on dielectrics or metals. */
static void rule_side_by_side_gains_no_energy(void **state) {
    (void)state;
    for (int metal = 0; metal < 2; metal++)
        for (int c = 0; c < COSINES; c++) {
            Surface surface = plain();
            surface.roughness = 0.3f;
            surface.metallic = (float)metal;
            Choices any = test_choices(CHOICE_AUTO, CHOICE_AUTO), both = test_choices(CHOICE_AUTO, LAYER_SIDE_BY_SIDE);
            assert_float_equal(furnace(&surface, both, cosines[c]), furnace(&surface, any, cosines[c]), 1e-6);
            surface.sheen_color = (Rgb){1.0f, 1.0f, 1.0f};
            surface.sheen_roughness = 0.8f;
            double all = furnace(&surface, both, cosines[c]);
            if (all > 1.0 + 1e-3) fail_msg("metal %d at cos_o %g: %.4f", metal, cosines[c], all);
        }
}

/* A round D on a brushed base is as wide as the roughness says: sqrt(alpha_x alpha_y) of workflow disney. */
static void round_highlight_on_a_brushed_base_has_the_mean_roughness(void **state) {
    (void)state;
    const int workflows[] = {choice_find(CHOICE_workflow, "metallic"), choice_find(CHOICE_workflow, "disney"), 0},
              profiles[] = {CHOICE_AUTO, CHOICE_AUTO, choice_find(CHOICE_profile, "hdrp-silk")};
    for (int k = 0; k < 3; k++) {
        Surface brushed = plain(), round = brushed;
        brushed.roughness = round.roughness = 0.5f;
        brushed.anisotropy = 0.9f;
        Choices choices = test_choices(CHOICE_AUTO, CHOICE_AUTO);
        choices.workflow = workflows[k];
        choices.profile = profiles[k];
        choices.d = D_GGX;
        Dir o = direction(0.4, 0.2), i = direction(0.7, 2.9);
        SeenStack a = made(&brushed, choices, o), b = made(&round, choices, o);
        assert_float_equal(a.stack.specular.lobe.params[0], 0.25f, 1e-6f);
        assert_float_equal(seen_eval(&a, i, 0).f_cos.g, seen_eval(&b, i, 0).f_cos.g, 0.0f);
        choices.d = D_GGX_ANISO; /* a round V beside it: the mean width */
        choices.v = V_SMITH_GGX;
        SeenStack c = made(&brushed, choices, o);
        const float *p = c.stack.specular.lobe.params;
        Angles angles = angles_between(o, i);
        float alpha = p[0] * sqrt(p[COOK_TORRANCE_STRETCH]), ax = p[0] * p[COOK_TORRANCE_STRETCH];
        float dv = term_d(D_GGX_ANISO, p[0], ax, p[0], angles.h) * term_v(V_SMITH_GGX, alpha, ax, p[0], angles);
        assert_float_equal(lobe_eval(&c.stack.specular.lobe, angles), dv, 1e-6f * dv);
    }
}

/* A sheen is any D with any V and F: as the formula has it, whatever is below. */
static void sheen_of_chosen_terms_has_them(void **state) {
    (void)state;
    Random random = {73};
    for (int n = 0; n < D_COUNT * V_COUNT * F_COUNT; n++) {
        Surface s = plain();
        s.sheen_color = (Rgb){0.3f, 0.6f, 0.9f};
        s.sheen_second = (Rgb){0.8f, 0.2f, 0.4f};
        s.sheen_roughness = 0.3f + 0.7f * random_unit(&random);
        s.base_color = (Rgb){0.0f, 0.0f, 0.0f};
        s.specular = 0.0f;
        Choices c = test_choices(n % 2 ? LOBE_COOK_TORRANCE : CHOICE_AUTO, LAYER_ADDITIVE);
        c.sheen_d = n % D_COUNT, c.sheen_v = n / D_COUNT % V_COUNT, c.sheen_f = n / D_COUNT / V_COUNT;
        Dir o = random_direction(&random), i = random_direction(&random);
        SeenStack stack = made(&s, c, o);
        Angles a = angles_between(o, i);
        float alpha = s.sheen_roughness * s.sheen_roughness, share = term_f(c.sheen_f, compose_ior(&s), 0.0f, a.d);
        float dv = term_d(c.sheen_d, alpha, alpha, alpha, a.h) * term_v(c.sheen_v, alpha, alpha, alpha, a);
        float expected = dv * fresnel_weight_mix(share, 0.6f, term_second(c.sheen_f, 0.6f, 0.2f)) * i.z;
        assert_float_equal(seen_eval(&stack, i, 0).f_cos.g, expected, 2e-5f * expected + 1e-30f);
    }
    /* what is not chosen: of the profile's own terms, or of charlie-neubelt */
    Surface s = plain();
    s.sheen_color = (Rgb){1.0f, 1.0f, 1.0f};
    s.sheen_roughness = 0.5f;
    Choices c = test_choices(LOBE_COOK_TORRANCE, CHOICE_AUTO);
    SeenStack stack = made(&s, c, direction(0.3, 0.0));
    assert_int_equal((int)stack.stack.sheen.lobe.params[COOK_TORRANCE_D], D_CHARLIE);
    assert_int_equal((int)stack.stack.sheen.lobe.params[COOK_TORRANCE_V], V_NEUBELT);
    assert_int_equal((int)stack.stack.sheen.lobe.params[COOK_TORRANCE_F], F_NONE);
    c = test_choices(CHOICE_AUTO, CHOICE_AUTO);
    c.profile = choice_find(CHOICE_profile, "order-1886");
    c.sheen_v = V_IMPLICIT;
    stack = made(&s, c, direction(0.3, 0.0));
    assert_int_equal((int)stack.stack.sheen.lobe.params[COOK_TORRANCE_D], D_ASHIKHMIN);
    assert_int_equal((int)stack.stack.sheen.lobe.params[COOK_TORRANCE_V], V_IMPLICIT);
    assert_int_equal((int)stack.stack.sheen.lobe.params[COOK_TORRANCE_F], F_SCHLICK);
}

/* Beta of an exponential sheen is given, or else made of the roughness; no other sheen takes notice. */
static void beta_of_an_exponential_sheen_is_an_input(void **state) {
    (void)state;
    const int lobes[] = {LOBE_EXPONENTIAL, LOBE_EXPONENTIAL_LIT, LOBE_CHARLIE_NEUBELT};
    Dir o = direction(0.9, 0.0);
    for (int k = 0; k < 3; k++) {
        Surface s = plain();
        s.sheen_color = (Rgb){1.0f, 1.0f, 1.0f};
        s.sheen_roughness = 0.4f;
        Choices c = test_choices(lobes[k], LAYER_ADDITIVE);
        SeenStack rough = made(&s, c, o);
        assert_float_equal(rough.stack.albedo_coord, k == 2 ? 0.16f : mix(0.5f, 20.0f, 0.4f), 1e-5f);
        s.sheen_beta = 3.0f;
        SeenStack given = made(&s, c, o);
        assert_float_equal(given.stack.albedo_coord, k == 2 ? 0.16f : 3.0f, 1e-6f);
        assert_float_equal(given.stack.sheen.lobe.params[0], given.stack.albedo_coord, 0.0f);
        s.sheen_beta = 100.0f;
        assert_float_equal(made(&s, c, o).stack.albedo_coord, k == 2 ? 0.16f : 100.0f, 1e-5f);
    }
}

/* F cook-torrance of a material: of a metal the index is that of its colour, of a dielectric its ior. */
static void cook_torrance_highlight_follows_metals_and_dielectrics(void **state) {
    (void)state;
    Dir o = direction_cos(0.15, 0.0), i = direction_cos(0.15, PI_DOUBLE);
    for (int metal = 0; metal < 2; metal++) {
        Surface s = plain();
        s.metallic = (float)metal;
        s.base_color = metal ? rgb(0.638f, 0.3f, 0.9f) : rgb_grey(0.0f);
        s.ior = 1.8f;
        s.roughness = 0.6f;
        Choices c = test_choices(CHOICE_AUTO, CHOICE_AUTO);
        c.f = F_COOK_TORRANCE;
        c.v = V_IMPLICIT;
        SeenStack stack = made(&s, c, o);
        float d = term_d(D_GGX, 0.36f, 0.36f, 0.36f, dir(0.0f, 0.0f, 1.0f));
        float f = seen_eval(&stack, i, 0).f_cos.r / (0.25f * d * i.z);
        if (metal) assert_float_equal(f, 0.478f, 5e-4f);
        if (!metal) assert_float_equal(f, cook_torrance_f((0.8f / 2.8f) * (0.8f / 2.8f), 0.15f), 1e-4f);
    }
}

/* F that has an index of refraction takes that of the reflectance where none is given. */
static void fresnel_of_a_highlight_follows_its_reflectance(void **state) {
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
static void brushed_metal_keeps_its_anisotropy(void **state) {
    (void)state;
    Dir o = direction(0.0, 0.0), along = direction(0.5, 0.0), across = direction(0.5, 0.5 * PI_DOUBLE);
    for (int silk = 0; silk < 2; silk++) {
        Surface surface = plain();
        surface.metallic = silk ? 0.0f : 1.0f;
        if (silk) surface.base_color = (Rgb){0.0f, 0.0f, 0.0f};
        surface.roughness = 0.3f;
        surface.anisotropy = 0.7f;
        Choices plainly = test_choices(CHOICE_AUTO, CHOICE_AUTO), chosen = plainly;
        if (silk) plainly.profile = chosen.profile = 3; /* hdrp-silk */
        chosen.f = F_SCHLICK;
        SeenStack a = made(&surface, plainly, o), b = made(&surface, chosen, o);
        assert_true(seen_eval(&a, along, 0).f_cos.g > 4.0f * seen_eval(&a, across, 0).f_cos.g);
        for (int k = 0; k < 2; k++) {
            Dir i = k ? across : along;
            float f = seen_eval(&a, i, 0).f_cos.g;
            assert_float_equal(seen_eval(&b, i, 0).f_cos.g, f, 1e-3f * f);
        }
    }
    assert_string_equal(weft_profile_name(3), "hdrp-silk");
}

/* A rule that asks for more than an engine's own E gets the table of the lobe. */
static void rule_reciprocal_uses_the_table_of_the_lobe(void **state) {
    (void)state;
    for (int profile = 1; weft_profile_name(profile); profile++)
        for (int layer = 0; layer < 2; layer++) {
            Surface surface = plain();
            surface.sheen_color = (Rgb){1.0f, 1.0f, 1.0f};
            surface.sheen_roughness = 0.5f;
            Choices choices = test_choices(CHOICE_AUTO, layer ? LAYER_STOCHASTIC : LAYER_RECIPROCAL);
            choices.profile = profile;
            SeenStack stack = made(&surface, choices, direction_cos(0.5, 0.0));
            const Stack *m = &stack.stack;
            if (HAS_SHEEN(m)) assert_true(m->albedo <= ALBEDO_KHRONOS && m->e_avg.e > 0.0f);
        }
}

/* The azimuth of shading text is the C library's. */
static void azimuth_equals_atan2(void **state) {
    (void)state;
    Random random = {17};
    for (int k = 0; k < 20000; k++) {
        double phi = 2.0 * PI_DOUBLE * (double)random_unit(&random), r = k & 1 ? 1.0 : 1e-3;
        if (k < 16) phi = 0.125 * PI_DOUBLE * k;
        Dir w = dir((float)(r * (cos)(phi)), (float)(r * (sin)(phi)), 0.0f);
        double expected = atan2((double)w.y, (double)w.x);
        if (expected < 0.0) expected += 2.0 * PI_DOUBLE;
        float found = azimuth_of(w);
        if (!(fabs((double)found - expected) < 1e-6 && found >= 0.0f && found <= 2.0f * PI))
            fail_msg("%.9g is not %.9g", (double)found, expected);
    }
    assert_true(azimuth_of(dir(0.0f, 0.0f, 1.0f)) <= 0.0f);
}

/* Density and nap go where a lobe has them, clamped; all else is as roughness makes it. */
static void inputs_of_a_material_reach_the_fibre_lobe(void **state) {
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
    SeenStack stack = made(&surface, test_choices(LOBE_FIBRE_WALK, LAYER_ADDITIVE), direction_cos(0.5, 0.0));
    const float *params = stack.stack.sheen.lobe.params;
    assert_float_equal(params[weft_lobe_param_find(LOBE_FIBRE_WALK, "density")], 2.0f, 0.0f);
    assert_float_equal(params[weft_lobe_param_find(LOBE_FIBRE_WALK, "tilt")], 0.6f, 0.0f);
    assert_float_equal(params[weft_lobe_param_find(LOBE_FIBRE_WALK, "azimuth")], 1.5f * PI, 1e-6f);
}

/* A stack holds nothing of the direction that it was last seen from. */
static void one_stack_serves_all_directions(void **state) {
    (void)state;
    Random random = {29};
    for (int n = 0; n < 400; n++) {
        Surface s = random_surface(&random, true);
        if (n % 4 == 0) s = dusted(s, random_unit(&random));
        Choices c = test_choices(CHOICE_AUTO, n % 3 ? CHOICE_AUTO : n / 3 % LAYER_COUNT);
        if (n % 2 && weft_profile_name(n / 2 % 15)) c.profile = n / 2 % 15;
        SeenStack kept = made(&s, c, random_direction(&random));
        for (int k = 0; k < 3; k++) {
            Dir o = random_direction(&random), i = random_direction(&random);
            SeenStack fresh = made(&s, c, o);
            stack_see(&kept.stack, &o, &kept.view);
            StackValue a = seen_eval(&kept, i, 1), b = seen_eval(&fresh, i, 1);
            assert_memory_equal(&a, &b, sizeof a);
            Dir v = seen_sample(&kept, 0.3f, 0.7f), w = seen_sample(&fresh, 0.3f, 0.7f);
            assert_memory_equal(&v, &w, sizeof v);
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_stack_serves_all_directions),
        cmocka_unit_test(rule_seed_is_its_formula),
        cmocka_unit_test(rule_seed_without_a_sheen_changes_nothing),
        cmocka_unit_test(rule_side_by_side_gains_no_energy),
        cmocka_unit_test(round_highlight_on_a_brushed_base_has_the_mean_roughness),
        cmocka_unit_test(sheen_of_chosen_terms_has_them),
        cmocka_unit_test(beta_of_an_exponential_sheen_is_an_input),
        cmocka_unit_test(cook_torrance_highlight_follows_metals_and_dielectrics),
        cmocka_unit_test(fresnel_of_a_highlight_follows_its_reflectance),
        cmocka_unit_test(brushed_metal_keeps_its_anisotropy),
        cmocka_unit_test(rule_reciprocal_uses_the_table_of_the_lobe),
        cmocka_unit_test(azimuth_equals_atan2),
        cmocka_unit_test(inputs_of_a_material_reach_the_fibre_lobe),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
