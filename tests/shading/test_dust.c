/* Dust over surfaces of every workflow and profile: how much lies where, and what it takes and gives */
#include "cases.h"

#include "shading/catalogue/albedo.h"

/* Plausible, with dust over a coat, a sheen, a highlight and a diffuse lobe. */
static Surface dusty(Random *random, float dust) {
    Surface s = random_surface(random, true);
    s.sheen_color = (Rgb){0.3f, 0.4f, 0.5f};
    s.clearcoat = 0.7f;
    return dusted(s, dust);
}

/* Every workflow, then every profile; false behind the last. */
static bool stack_choices(int k, Choices *choices) {
    int workflows = 0;
    while (weft_workflow_name(workflows)) workflows++;
    *choices = choices_unmade();
    if (k < workflows)
        choices->workflow = k;
    else
        choices->profile = k - workflows + 1;
    return k < workflows || weft_profile_name(k - workflows + 1);
}

static const AlbedoTable *table(void) {
    static AlbedoTable made;
    if (!made.maps) fill_albedo(&made, LOBE_CHARLIE_CONTY_KULLA);
    return &made;
}

static SeenStack stack_of(const Surface *surface, const Choices *choices, Dir o) {
    SeenStack stack;
    seen_make(&stack, surface, choices, albedo_table_ref(table()), o);
    return stack;
}

/* The amount, the power of the cosine, the direction; the numbers are worked out by hand. */
static void dust_amount_follows_the_direction_of_the_surface(void **state) {
    (void)state;
    Random random = {1};
    Surface s = dusty(&random, 0.5f);
    Dir p = dir(0.1f, 0.2f, 0.3f);
    static const struct {
        float x, y, z, falloff, tilt, direction, dust;
    } cases[] = {
        {0, 1, 0, 1, 0, 0, 0.5f},        {0, -1, 0, 1, 0, 0, 0.0f},
        {1, 0, 0, 1, 0, 0, 0.0f},        {0.6f, 0.8f, 0, 1, 0, 0, 0.4f},
        {0.6f, 0.8f, 0, 2, 0, 0, 0.32f}, {0, 0.8f, 0.6f, 0.5f, 0, 90, 0.4472136f},
        {1, 0, 0, 1, 90, 0, 0.5f},       {0, 0, 1, 1, 90, 90, 0.5f},
        {0, 0, -1, 1, 90, 90, 0.0f},     {0.6f, 0.8f, 0, 1, 60, 0, 0.4598076f},
        {0, -1, 0, 1, 180, 30, 0.5f},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        s.dust_falloff = cases[k].falloff;
        s.dust_tilt = cases[k].tilt * PI / 180.0f;
        s.dust_direction = direction(0.5 * PI_DOUBLE, (double)cases[k].direction * PI_DOUBLE / 180.0);
        Surface t = dust_accumulate(s, dir(cases[k].x, cases[k].y, cases[k].z), p);
        if (!(fabsf(t.dust - cases[k].dust) < 1e-6f)) fail_msg("case %zu: %.7f", k, (double)t.dust);
    }
}

/* The hash against whole numbers. */
static void hash_of_dust_is_exact(void **state) {
    (void)state;
    bool seen[289] = {false};
    for (int x = 0; x < 289; x++) {
        int expected = (34 * x * x + 10 * x) % 289;
        assert_int_equal((int)dust_hash((float)x), expected);
        assert_true(dust_hash((float)x) >= 0.0f && dust_hash((float)x) < 289.0f);
        assert_false(seen[expected]);
        seen[expected] = true;
    }
    for (int x = -(1 << 22); x <= 1 << 22; x += 1 + (x & 7))
        assert_int_equal((int)dust_mod((float)x), (x % 289 + 289) % 289);
    for (int a = 0; a < 289; a++)
        for (int b = 0; b < 289; b++) assert_int_equal((int)dust_sum((float)a, (float)b), (a + b) % 289);
}

/* Between 0 and 1 and using it; in every place finite; smooth; of the size that is asked for. */
static void dust_noise_is_smooth(void **state) {
    (void)state;
    enum { COUNT = 20000 };
    Random random = {2};
    double sum = 0.0, squares = 0.0, steepest = 0.0;
    for (int k = 0; k < COUNT; k++) {
        Dir p = dir(4.0f * random_unit(&random) - 2.0f, 4.0f * random_unit(&random) - 2.0f, random_unit(&random));
        Dir q = dir(p.x + 1e-4f, p.y, p.z);
        double n = (double)dust_noise(p, 0.05f);
        assert_true(n >= 0.0 && n <= 1.0);
        steepest = fmax(steepest, fabs((double)dust_noise(q, 0.05f) - n) / 1e-4);
        sum += n;
        squares += n * n;
    }
    double mean = sum / COUNT, deviation = (sqrt)(squares / COUNT - mean * mean);
    assert_float_equal(mean, 0.5, 0.03);
    assert_true(deviation > 0.15 && deviation < 0.35);
    assert_true(steepest > 10.0 && steepest < 5.2 / 0.05); /* 2 / 7 (4 + 4 + 4) 3 / 2, a patch */
    assert_float_equal(dust_noise(dir(0.3f, 0.1f, 0.2f), 0.1f), dust_noise(dir(3.0f, 1.0f, 2.0f), 1.0f), 1e-5);
    static const float far[] = {0.0f, -0.0f, 1e-30f, 1e4f, -1e9f, 1e15f, -3e37f};
    for (size_t k = 0; k < 7 * 7 * 7; k++) {
        float n = dust_noise(dir(far[k % 7], far[k / 7 % 7], far[k / 49]), 1e-4f);
        assert_true(n >= 0.0f && n <= 1.0f);
    }
    float none = dust_noise(dir(0.3f, 0.1f, 0.2f), 0.0f);
    assert_true(none >= 0.0f && none <= 1.0f);
}

/* Without strength no patches; with all of it down to nothing; in between a mix. */
static void dust_noise_only_reduces_the_amount(void **state) {
    (void)state;
    Random random = {3};
    Surface s = dusty(&random, 0.8f);
    float least = 1.0f;
    for (int k = 0; k < 2000; k++) {
        Dir p = dir(random_unit(&random), random_unit(&random), random_unit(&random)), up = dir(0.0f, 1.0f, 0.0f);
        float amount[3];
        for (int n = 0; n < 3; n++) {
            s.dust_noise = 0.5f * (float)n;
            amount[n] = dust_accumulate(s, up, p).dust;
        }
        assert_float_equal(amount[0], 0.8f, 1e-6f);
        assert_float_equal(amount[1], 0.5f * (amount[0] + amount[2]), 1e-6f);
        assert_float_equal(amount[2], 0.8f * dust_noise(p, 0.05f), 1e-6f);
        least = min(least, amount[2]);
    }
    assert_true(least < 0.01f);
}

/* No dust: the same bits, whatever the other inputs of dust say. */
static void dust_of_amount_zero_changes_nothing(void **state) {
    (void)state;
    Random random = {4};
    Choices choices;
    for (int k = 0; stack_choices(k, &choices); k++)
        for (int n = 0; n < 20; n++) {
            Dir o = random_direction(&random), i = random_direction(&random);
            Surface bare = random_surface(&random, true), clean = bare;
            clean.dust_color = (Rgb){0.3f, 0.2f, 0.1f};
            clean.dust_roughness = random_unit(&random);
            clean.dust_falloff = 3.0f;
            clean.dust_noise = 1.0f;
            clean.dust_scale = 0.01f;
            clean = dust_accumulate(clean, dir(0.0f, 1.0f, 0.0f), dir(1.0f, 2.0f, 3.0f));
            SeenStack a = stack_of(&bare, &choices, o), b = stack_of(&clean, &choices, o);
            StackValue f = seen_eval(&a, i, 1), g = seen_eval(&b, i, 1);
            assert_memory_equal(&f, &g, sizeof f);
            assert_true(b.view.select_p.dust <= 0.0f);
            Dir s = seen_sample(&a, 0.3f, 0.6f), t = seen_sample(&b, 0.3f, 0.6f);
            assert_memory_equal(&s, &t, sizeof s);
        }
}

static double eddington(double t, double mu) {
    double down = (2.0 / 3.0 + mu + (2.0 / 3.0 - mu) * (exp)(-t / mu)) / (4.0 / 3.0 + t);
    return 1.0 - down;
}

/* All of f of what lies below is dimmed by what the dust sends back, and the rest is the dust's own lobe. */
static void dust_dims_every_slot_below(void **state) {
    (void)state;
    Random random = {5};
    Choices choices;
    for (int k = 0; stack_choices(k, &choices); k++)
        for (int n = 0; n < 20; n++) {
            Dir o = random_direction(&random), i = random_direction(&random);
            Surface s = dusty(&random, random_unit(&random)), bare = s;
            s.dust_roughness = 0.4f + 0.6f * random_unit(&random);
            s.dust_color = (Rgb){0.9f, 0.5f, 0.0f};
            bare.dust = 0.0f;
            SeenStack dusted = stack_of(&s, &choices, o), base = stack_of(&bare, &choices, o);
            Lobe lobe = lobe_rough(LOBE_LTC_FIBRE, s.dust_roughness);
            double one = (double)albedo_quadrature(&lobe, o, 1e-5).f0,
                   all = one * eddington(8.0 * (double)s.dust, (double)o.z) / eddington(1.0, (double)o.z),
                   f = (double)lobe_eval(&lobe, angles_between(o, i)) * (double)i.z * all / one;
            Rgb with = seen_eval(&dusted, i, 0).f_cos, without = seen_eval(&base, i, 0).f_cos;
            const float found[] = {with.r, with.g, with.b}, below[] = {without.r, without.g, without.b},
                        color[] = {0.9f, 0.5f, 0.0f};
            for (int c = 0; c < 3; c++) {
                double expected = (1.0 - all) * (double)below[c] + f * (double)color[c];
                if (!(fabs((double)found[c] - expected) < 2e-3 * expected + 1e-5))
                    fail_msg("stack %d: %g is not %g", k, (double)found[c], expected);
            }
        }
}

/* Sum of f cos over the hemisphere, the midpoint rule on the grid of cases.h. */
static Rgb furnace(const SeenStack *stack, Dir o, int cells) {
    Grid grid = grid_about(o);
    double step = 2.0 / cells, sum[3] = {0.0};
    for (int j = 0; j < cells; j++)
        for (int k = 0; k < cells; k++) {
            double area;
            Dir i = grid_direction(grid, -1.0 + step * (j + 0.5), -1.0 + step * (k + 0.5), &area);
            if (i.z <= 0.0f) continue;
            Rgb f = seen_eval(stack, i, 0).f_cos;
            sum[0] += (double)f.r * area * step * step;
            sum[1] += (double)f.g * area * step * step;
            sum[2] += (double)f.b * area * step * step;
        }
    return (Rgb){(float)sum[0], (float)sum[1], (float)sum[2]};
}

/* A white base without an interface returns all it receives below white dust, of any amount; less below
 * coloured dust, and dark dust darkens it. */
static void white_dust_over_a_white_base_conserves_energy(void **state) {
    (void)state;
    static const float amounts[] = {0.01f, 0.1f, 0.4f, 1.0f}, roughnesses[] = {0.5f, 0.8f, 1.0f};
    static const double cosines[] = {1.0, 0.5, 0.1};
    double worst = 0.0;
    for (int a = 0; a < 4; a++)
        for (int r = 0; r < 3; r++)
            for (int c = 0; c < 3; c++) {
                Surface s = white_cloth(0.5f);
                Choices choices = choices_unmade();
                s.sheen_color = (Rgb){0.0f, 0.0f, 0.0f};
                s.dust = amounts[a];
                s.dust_roughness = roughnesses[r];
                s.dust_color = (Rgb){1.0f, 0.5f, 0.0f};
                Dir o = direction_cos(cosines[c], 0.4);
                SeenStack stack = stack_of(&s, &choices, o);
                Rgb all = furnace(&stack, o, 120);
                worst = fmax(worst, fabs((double)all.r - 1.0));
                assert_true(all.b < all.g && all.g < all.r);
                assert_float_equal(all.g, 0.5f * (all.r + all.b), 1e-4f);
            }
    print_message("white dust over white: within %.1e of 1\n", worst);
    assert_true(worst < 2e-3);
}

/* Amounts as slabs of fibres of other densities have them, solved without the law of dust_lobe.h. */
static void amount_of_dust_is_a_slab_of_another_density(void **state) {
    (void)state;
    int density = weft_lobe_param_find(LOBE_FIBRE, "density");
    double worst = 0.0;
    for (int n = 0; n < 5; n++)
        for (int c = 0; c < 6; c++) {
            Dir o = direction_cos(0.02 + 0.196 * c, 0.0);
            Lobe slabs = lobe_rough(LOBE_FIBRE, 1.0f), one = lobe_rough(LOBE_LTC_FIBRE, 1.0f);
            lobe_set(&slabs, density, 0.25f * (float)(1 << n));
            float e_1 = dust_albedo(&one, o.z), e = e_1 * dust_weight(slabs.params[density] / DUST_SLABS, e_1, o.z);
            worst = fmax(worst, fabs((double)e - (double)albedo_quadrature(&slabs, o, 1e-4).f0));
        }
    print_message("E within %.3f of that of fibres, density 1/4 to 4\n", worst);
    assert_true(worst < 0.045);
}

/* The picks are probabilities, and a sample's slot is drawn as often as its pick says. */
static void selection_probabilities_sum_to_one(void **state) {
    (void)state;
    enum { COUNT = 4096 };
    Random random = {6};
    Choices choices;
    for (int k = 0; stack_choices(k, &choices); k++)
        for (int n = 0; n < 4; n++) {
            Surface s = dusty(&random, random_unit(&random));
            SeenStack m = stack_of(&s, &choices, random_direction(&random));
            const Scales *pick = &m.view.select_p;
            const float picks[] = {pick->diffuse, pick->specular, pick->sheen, pick->coat, pick->dust};
            int drawn[5] = {0};
            float sum = 0.0f;
            for (int slot = 0; slot < 5; slot++) sum += picks[slot];
            assert_float_equal(sum, 1.0f, 1e-6f);
            assert_true(pick->dust > 0.01f);
            for (int j = 0; j < COUNT; j++) {
                float u = ((float)j + 0.5f) / COUNT;
                drawn[stack_select_slot(&m.view, &u)]++;
            }
            for (int slot = 0; slot < 5; slot++)
                assert_float_equal((float)drawn[slot] / COUNT, picks[slot], 2.0f / COUNT);
        }
}

/* The walk between sheen and base gets its light through the dust once each way, as all below does by view.
 */
static void dust_dims_stochastic_layers_alike(void **state) {
    (void)state;
    Surface s = white_cloth(0.6f), bare;
    s.dust_color = (Rgb){0.0f, 0.0f, 0.0f};
    s.dust_roughness = 1.0f;
    bare = s;
    s.dust = 0.2f;
    Choices choices = test_choices(LOBE_CHARLIE_CONTY_KULLA, LAYER_STOCHASTIC);
    Random random = {7};
    for (int k = 0; k < 50; k++) {
        Dir o = random_direction(&random), i = random_direction(&random);
        SeenStack a = stack_of(&s, &choices, o), b = stack_of(&bare, &choices, o);
        float with = seen_eval(&a, i, 9).f_cos.g, without = seen_eval(&b, i, 9).f_cos.g;
        assert_float_equal(with, without * a.view.dust_transmittance, 1e-3f * without + 1e-6f);
        assert_true(a.view.dust_transmittance < 0.7f);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(dust_amount_follows_the_direction_of_the_surface),
        cmocka_unit_test(hash_of_dust_is_exact),
        cmocka_unit_test(dust_noise_is_smooth),
        cmocka_unit_test(dust_noise_only_reduces_the_amount),
        cmocka_unit_test(dust_of_amount_zero_changes_nothing),
        cmocka_unit_test(dust_dims_every_slot_below),
        cmocka_unit_test(white_dust_over_a_white_base_conserves_energy),
        cmocka_unit_test(amount_of_dust_is_a_slab_of_another_density),
        cmocka_unit_test(selection_probabilities_sum_to_one),
        cmocka_unit_test(dust_dims_stochastic_layers_alike),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
