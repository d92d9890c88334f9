/* Colour that is no factor: its law, f and E of tinted lobes in colours, and what layer rules make of it
 *
 * Labels: unsanitized */
#include "cases.h"
#include "weft/arrays.h"

static bool is_tinted(int id) { return (weft_lobe_info(id)->traits & TRAIT_TINTED) != 0; }

/* The law of tint.h, in double. */
static double law(Tint t, double w) {
    double r_o = (1.0 - (double)t.q_o) / (1.0 - w * (double)t.q_o),
           r_i = (1.0 - (double)t.q_i) / (1.0 - w * (double)t.q_i), s = (double)t.s;
    return (1.0 - s) * w + s * w * w * fmin(r_o * r_i * (exp)((1.0 - w) * (double)t.e), 1.0);
}

static Tint any_tint(Random *random) {
    return (Tint){.s = random_unit(random),
                  .q_o = 0.998f * random_unit(random),
                  .q_i = 0.998f * random_unit(random),
                  .e = 2.0f * random_unit(random) - 1.0f};
}

static void tint_equals_its_law(void **state) {
    (void)state;
    Random random = {31};
    for (int n = 0; n < 100000; n++) {
        Tint t = any_tint(&random);
        float w = random_unit(&random), c = tint_color(t, w);
        assert_true(fabs((double)c - law(t, (double)w)) < 2e-6);
        t.q_o = n % 3 ? t.q_o : 1.0f; /* as rounding may make it */
        assert_float_equal(tint_color(t, 1.0f), 1.0f, 0.0f);
        assert_float_equal(tint_color(t, 7.0f), 1.0f, 0.0f);
        assert_float_equal(tint_color(t, 0.0f), 0.0f, 0.0f);
        assert_float_equal(tint_color(t, -1.0f), 0.0f, 0.0f);
        assert_float_equal(tint_color(tint_none(), w), w, 0.0f);
    }
}

/* Colours come out of each call as the lobe's own Tint says; whoever keeps less of the light sends on less.
 */
static void colour_of_f_follows_the_tint(void **state) {
    (void)state;
    Random random = {32};
    for (int id = 0; id < weft_lobe_count(); id++)
        for (int n = 0; is_tinted(id) && n < 20000; n++) {
            Lobe lobe = case_lobe(id, n % case_count(id));
            Dir o = random_direction(&random), i = random_direction(&random);
            LobeValue v = lobe_value(&lobe, angles_between(o, i));
            WeftLobe given = {.lobe = id, .f0 = {1.0f, random_unit(&random), 0.0f}, .f90 = {5.0f, 0.0f, 9.0f}};
            memcpy(given.params, lobe.params, sizeof given.params);
            float f[3], wo[3] = {o.x, o.y, o.z}, wi[3] = {i.x, i.y, i.z};
            weft_lobe_eval(&given, wo, wi, f);
            double w = (double)given.f0[1], expected = (double)v.f * law(v.tint, w);
            bool inside = v.tint.s >= 0.0f && v.tint.s <= 1.0f && v.tint.q_o >= 0.0f && v.tint.q_o < 1.0f &&
                          v.tint.q_i >= 0.0f && v.tint.q_i < 1.0f;
            if (!inside || fabs((double)(f[0] - v.f)) > 0.0 ||
                fabs((double)f[1] - expected) > 1e-5 * expected + 1e-12 || f[2] > 0.0f || f[1] > f[0])
                fail_msg("%s: %g %g %g, expected %g %g 0", case_name(&lobe, o).text, (double)f[0], (double)f[1],
                         (double)f[2], (double)v.f, expected);
        }
}

/* E of a colour is the sum of f of that colour: by midpoints, from the calls for arrays. */
static void albedo_of_a_coloured_sheen_is_its_integral(void **state) {
    (void)state;
    enum { CELLS = 150 };
    static const double cosines[] = {0.05, 0.3, 0.8};
    static float x[CELLS * CELLS], y[CELLS * CELLS], z[CELLS * CELLS], ox[CELLS * CELLS], oy[CELLS * CELLS],
        oz[CELLS * CELLS], f[3][CELLS * CELLS];
    for (int id = 0; id < weft_lobe_count(); id++) {
        if (!is_tinted(id)) continue;
        WeftLobe lobe;
        assert_int_equal(weft_lobe_init(weft_lobe_info(id)->id, &lobe, NULL), WEFT_OK);
        lobe.f0[1] = 0.6f, lobe.f0[2] = 0.2f;
        for (int c = 0; c < 3; c++) {
            Dir o = direction_cos(cosines[c], 0.0);
            Grid grid = grid_about(o);
            double step = 2.0 / CELLS, area, sum[3] = {0.0, 0.0, 0.0};
            for (int k = 0; k < CELLS * CELLS; k++) {
                Dir i = grid_direction(grid, -1.0 + step * (k / CELLS + 0.5), -1.0 + step * (k % CELLS + 0.5), &area);
                x[k] = i.x, y[k] = i.y, z[k] = i.z, ox[k] = o.x, oy[k] = o.y, oz[k] = o.z;
            }
            assert_int_equal(weft_eval_n(&lobe, CELLS * CELLS, (WeftDirections){ox, oy, oz}, (WeftDirections){x, y, z},
                                         (WeftColors){f[0], f[1], f[2]}, NULL),
                             WEFT_OK);
            for (int k = 0; k < CELLS * CELLS; k++) {
                grid_direction(grid, -1.0 + step * (k / CELLS + 0.5), -1.0 + step * (k % CELLS + 0.5), &area);
                for (int p = 0; p < 3; p++) sum[p] += (double)f[p][k] * (double)z[k] * area * step * step;
            }
            float e[3], z_o = o.z;
            weft_lobe_albedo(&lobe, z_o, e);
            for (int p = 0; p < 3; p++)
                if (fabs((double)e[p] - sum[p]) > 1e-3)
                    fail_msg("%s cos_o %g: E %.5f, midpoints %.5f", weft_lobe_info(id)->id, (double)o.z, (double)e[p],
                             sum[p]);
            assert_true(e[1] < 0.59f * e[0] && e[2] < 0.19f * e[0]); /* darker than a factor would make it */
        }
    }
}

/* The maps of the table stand for all colours. */
static void table_of_albedo_holds_for_every_colour(void **state) {
    (void)state;
    static AlbedoTable table;
    for (int id = 0; id < weft_lobe_count(); id++) {
        if (!is_tinted(id)) continue;
        fill_albedo(&table, id);
        TableRef ref = albedo_table_ref(&table);
        Random random = {33};
        double much = 0.0, little = 0.0, loose = 0.0, average = 0.0;
        for (int n = 0; n < (test_short() ? 20 : 200); n++) {
            float roughness = 0.3f + 0.7f * random_unit(&random), mu = random_unit(&random),
                  w[3] = {random_unit(&random), random_unit(&random), random_unit(&random)}, e[3];
            Lobe lobe = lobe_rough(id, roughness);
            albedo_in_color(&lobe, direction_cos((double)(mu * mu), 0.0), w, 1e-5, e);
            SheenE seen = table_sheen(ref, mu * mu, lobe.params[0]);
            for (int c = 0; c < 3; c++) {
                double off = (double)(w[c] * sheen_e_in(seen, w[c]) - e[c]);
                much = fmax(much, off), little = fmax(little, -off);
                loose = fmax(loose, (double)(w[c] * seen.e - e[c]));
            }
        }
        /* on cosine average, of one row */
        Lobe lobe = lobe_rough(id, 0.7f);
        const float w[3] = {0.8f, 0.5f, 0.2f};
        double sum[3] = {0.0, 0.0, 0.0};
        enum { STEPS = 64 };
        for (int k = 0; k < STEPS; k++) {
            double mu = (k + 0.5) / STEPS;
            float e[3];
            albedo_in_color(&lobe, direction_cos(mu, 0.0), w, 1e-4, e);
            for (int c = 0; c < 3; c++) sum[c] += 2.0 * mu * (double)e[c] / STEPS;
        }
        SheenE mean = table_sheen_average(ref, table_rows(ref, lobe.params[0]));
        for (int c = 0; c < 3; c++) average = fmax(average, fabs((double)(w[c] * sheen_e_in(mean, w[c])) - sum[c]));
        print_message("%s: E of colours up to %.4f too much, %.4f too little, on average within %.4f;\n"
                      "    colour times E would be up to %.2f too much\n",
                      weft_lobe_info(id)->id, much, little, average, loose);
        assert_true(much < 0.004 && little < 0.004 && average < 0.001 && loose > 0.05);
    }
}

/* A coloured sheen on a white base: the base gives up what the sheen sends on in each colour, so that under
 * the rule that is exact for white nothing is gained or lost. */
static void coloured_sheen_on_a_white_base_conserves_each_colour(void **state) {
    (void)state;
    static AlbedoTable table;
    for (int id = 0; id < weft_lobe_count(); id++) {
        if (!is_tinted(id)) continue;
        fill_albedo(&table, id);
        double most = 0.0, least = 2.0;
        for (int n = 0; n < (test_short() ? 3 : 12); n++) {
            Surface cloth = {.base_color = {1.0f, 1.0f, 1.0f},
                             .sheen_color = {0.9f, 0.5f, 0.1f},
                             .sheen_second = {1.0f, 1.0f, 1.0f},
                             .sheen = 1.0f,
                             .sheen_density = 1.0f,
                             .sheen_tail = 0.6f,
                             .sheen_rise = 3.0f,
                             .diffuse_retro = 0.3f,
                             .diffuse_lift = 0.3f,
                             .ior = 1.0f,
                             .sheen_roughness = 0.4f + 0.2f * (float)(n % 4),
                             .normal = {0.0f, 0.0f, 1.0f}};
            Choices choices = test_choices(id, LAYER_ALBEDO_VIEW);
            choices.layer_by = LAYER_BY_CHANNEL;
            Dir o = direction_cos(0.08 + 0.4 * (n / 4), 0.0);
            Grid grid = grid_about(o);
            SeenStack stack;
            seen_make(&stack, &cloth, &choices, albedo_table_ref(&table), o);
            enum { CELLS = 120 };
            double step = 2.0 / CELLS, area, sum[3] = {0.0, 0.0, 0.0};
            for (int k = 0; k < CELLS * CELLS; k++) {
                Dir i = grid_direction(grid, -1.0 + step * (k / CELLS + 0.5), -1.0 + step * (k % CELLS + 0.5), &area);
                Rgb f = seen_eval(&stack, i, 0).f_cos;
                sum[0] += (double)f.r * area * step * step, sum[1] += (double)f.g * area * step * step;
                sum[2] += (double)f.b * area * step * step;
            }
            for (int c = 0; c < 3; c++) most = fmax(most, sum[c]), least = fmin(least, sum[c]);
        }
        print_message("%s: a white base returns %.4f to %.4f under it\n", weft_lobe_info(id)->id, least, most);
        assert_true(least > 0.999 && most < 1.001);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tint_equals_its_law),
        cmocka_unit_test(colour_of_f_follows_the_tint),
        cmocka_unit_test(albedo_of_a_coloured_sheen_is_its_integral),
        cmocka_unit_test(table_of_albedo_holds_for_every_colour),
        cmocka_unit_test(coloured_sheen_on_a_white_base_conserves_each_colour),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
