/* Whole materials in a white furnace
 *
 * Labels: unsanitized */
#include "cases.h"

/* What a stack reflects of a uniform light, per channel. Midpoint sum on the grid of cases.h. */
static Rgb furnace(const SeenStack *stack, Dir o, int cells) {
    Grid grid = grid_about(o);
    double step = 2.0 / cells, r = 0.0, g = 0.0, b = 0.0;
    for (int j = 0; j < cells; j++)
        for (int k = 0; k < cells; k++) {
            double area;
            Dir i = grid_direction(grid, -1.0 + step * (j + 0.5), -1.0 + step * (k + 0.5), &area);
            if (i.z <= 0.0f) continue;
            Rgb f = seen_eval(stack, i, 0).f_cos;
            r += (double)f.r * area * step * step;
            g += (double)f.g * area * step * step;
            b += (double)f.b * area * step * step;
        }
    return (Rgb){(float)r, (float)g, (float)b};
}

/* The same by sampling, and its standard error in *error. */
static double sampled_furnace(const SeenStack *stack, Dir o, int count, double *error) {
    Random random = {23};
    double sum = 0.0, squares = 0.0;
    for (int n = 0; n < count; n++) {
        float u = random_unit(&random), v = random_unit(&random);
        Dir i = seen_sample(stack, u, v);
        if (i.z <= 0.0f) continue;
        StackValue value = seen_eval(stack, i, 0);
        double x = (double)max(value.f_cos.r, max(value.f_cos.g, value.f_cos.b)) / (double)value.pdf;
        sum += x;
        squares += x * x;
    }
    double mean = sum / count;
    *error = (sqrt)(fmax(squares / count - mean * mean, 0.0) / count);
    return mean;
}

static int layer_named(const char *id) {
    int k = 0;
    while (weft_layer_name(k) && strcmp(weft_layer_name(k), id) != 0) k++;
    assert_non_null(weft_layer_name(k));
    return k;
}

/* E that a smooth table does not follow: a maximum of two, or the nodes of a table mixed in straight lines. */
static bool has_creases(int id) {
    return id == LOBE_CHARLIE_NEUBELT_NORMALISED || id == LOBE_LTC_FIBRE || id == LOBE_FIBRE_TABLE ||
           id == LOBE_LTC_FIBRE_PUBLISHED || id == LOBE_SILK; /* where another azimuth is brightest */
}

/* Yarns turn away from light and eye with a crease; E of silk is off its table by 0.006 here, and shading/energy lets it be off
 * by 0.01. */
static double all_error_most(int id) {
    if (id == LOBE_SILK) return 1e-2;
    if (id == LOBE_YARN || id == LOBE_WOVEN) return 2e-3;
    return has_creases(id) ? 5e-3 : 1e-3;
}

static void rule_albedo_view_returns_what_it_receives(void **state) {
    (void)state;
    static AlbedoTable table;
    int view = layer_named("albedo-view"), additive = layer_named("additive"), checked = 0, seen = 0, turn = 0,
        lobes = 0;
    double worst = 0.0;
    for (int id = 0; id < weft_lobe_count(); id++) {
        if (case_walks(id) || !test_turn(&lobes, 1, 7)) continue;
        fill_albedo(&table, id);
        /* from 4 on where a thinner ridge is more than the grid resolves */
        for (int r = weft_lobe_info(id)->traits & TRAIT_ANISOTROPIC ? 4 : 2; r <= 10; r++)
            for (int c = 1; c <= 10; c++) {
                if (!test_turn(&turn, 3, 37)) continue;
                Surface cloth = white_cloth((float)r / 10.0f);
                seen++;
                Lobe sheen = sheen_lobe(id, cloth.sheen_roughness);
                Dir o = albedo_brightest(&sheen, (float)(c / 10.0 - 0.05)); /* the azimuth of the table */
                SeenStack stack = test_stack(&cloth, view, &table, o), base = test_stack(&cloth, additive, &table, o);
                float e = stack.view.e_o.e;
                double all = (double)furnace(&stack, o, 150).g;
                if (e <= 1.0f) {
                    checked++;
                    worst = fmax(worst, has_creases(id) ? 0.0 : fabs(all - 1.0));
                    if (fabs(all - 1.0) > all_error_most(id))
                        fail_msg("%s at %g cos_o %g: %.5f", weft_lobe_info(id)->id, (double)stack.stack.albedo_coord,
                                 (double)o.z, all);
                }
                float step = has_creases(id) ? 5e-3f : 2e-3f;
                assert_float_equal(furnace(&base, o, 150).r, (1.0f + e), (step + step * e));
            }
    }
    print_message("all without creases within %.1e\n", worst);
    assert_true(checked > seen / 2);
}

/* Surfaces whose lobes and layer all conserve: what they reflect is bounded. */
static void surface_in_the_furnace_reflects_no_more_than_it_receives(void **state) {
    (void)state;
    static AlbedoTable table;
    fill_albedo(&table, LOBE_LAMBERT); /* as a sheen: conserves exactly */
    Random random = {17};
    double highest = 0.0;
    int surfaces = test_long() ? 2000 : test_short() ? 20 : 300, samples = test_long() ? 100000 : 4000;
    for (int k = 0; k < surfaces; k++) {
        Surface surface = random_surface(&random, k % 2);
        if (k % 4 < 2) surface.base_color = surface.specular_color = (Rgb){1.0f, 1.0f, 1.0f};
        if (k % 5 == 0) surface = dusted(surface, random_unit(&random));
        for (int c = 0; c < 4; c++) {
            double error, cos_o = 0.02 + 0.98 * (double)random_unit(&random);
            Dir o = direction_cos(cos_o, 0.5 + k);
            SeenStack stack = test_stack(&surface, LAYER_ALBEDO_VIEW, &table, o);
            double all = sampled_furnace(&stack, o, samples, &error);
            highest = fmax(highest, all - 4.0 * error);
            if (all > 1.0 + 1e-2 + 4.0 * error)
                fail_msg("surface %d at cos_o %.3f reflects %.4f +- %.4f", k, cos_o, all, error);
        }
    }
    print_message("no random surface surely reflects more than %.4f\n", highest);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rule_albedo_view_returns_what_it_receives),
        cmocka_unit_test(surface_in_the_furnace_reflects_no_more_than_it_receives),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
