/* E by quadrature, by other means, by closed forms and by table; and what the lobes claim about it
 *
 * Labels: slow unsanitized */
#include "cases.h"
#include "shading/dialect/warp.h"

static const double cosines[] = {1.0, 0.9, 0.6, 0.3, 0.1, 0.02};
enum { COSINES = sizeof cosines / sizeof cosines[0] };

/* Midpoint sum over the stretched grid of cases.h: nothing in common with the rule of albedo.c. */
static Albedo midpoint_albedo(const Lobe *lobe, Dir o, int cells) {
    Grid grid = grid_about(o);
    double step = 2.0 / cells, f0 = 0.0, f90 = 0.0;
    for (int j = 0; j < cells; j++)
        for (int k = 0; k < cells; k++) {
            double area;
            Dir i = grid_direction(grid, -1.0 + step * (j + 0.5), -1.0 + step * (k + 0.5), &area);
            if (i.z <= 0.0f) continue;
            Angles a = angles_between(o, i);
            LobeValue value = lobe_value(lobe, a);
            double e = (double)value.f * (double)i.z * area * step * step,
                   s = (double)fresnel_weight_uncolored(value.s);
            f0 += e * (1.0 - s);
            f90 += e * s;
        }
    return (Albedo){(float)f0, (float)f90};
}

/* Mean and its standard error of f cos / pdf. */
typedef struct Estimate {
    double mean, error;
} Estimate;

static Estimate sampled_albedo(const Lobe *lobe, Dir o, bool by_cosine, int count) {
    Random random = {11};
    double sum = 0.0, squares = 0.0;
    for (int n = 0; n < count; n++) {
        float u = random_unit(&random), v = random_unit(&random);
        Dir i = by_cosine ? warp_cosine(u, v) : lobe_sample(lobe, o, u, v);
        if (i.z <= 0.0f) continue;
        Angles a = angles_between(o, i);
        double pdf = (double)(by_cosine ? warp_cosine_pdf(i) : lobe_pdf(lobe, a));
        double x = (double)lobe_eval(lobe, a) * (double)i.z / pdf;
        sum += x;
        squares += x * x;
    }
    double mean = sum / count;
    return (Estimate){mean, (sqrt)(fmax(squares / count - mean * mean, 0.0) / count)};
}

/* A ridge much thinner than it is long is what no product grid resolves: sampling alone checks it. */
static bool is_ridge(const Lobe *lobe) {
    int k = weft_lobe_param_find(lobe->id, "anisotropy");
    float a = k >= 0 ? fabsf(lobe->params[k]) : 0.0f;
    return a > 0.0f && (lobe->params[0] < 0.05f || (lobe->id == LOBE_SILK && a > 0.75f));
}

static void albedo_by_quadrature_agrees_with_other_estimators(void **state) {
    (void)state;
    int cells = test_long() ? 800 : 200, samples = test_long() ? 400000 : test_short() ? 10000 : 40000;
    double worst = 0.0;
    int turn = 0;
    for (int id = 0; id < weft_lobe_count(); id++)
        for (int k = 0; k < case_count(id); k++)
            for (int c = 0; c < COSINES; c++) {
                if (case_walks(id) || !test_turn(&turn, 7, 41)) continue;
                Lobe lobe = case_lobe(id, k);
                Dir o = direction_cos(cosines[c], 0.3);
                const char *name = case_name(&lobe, o).text;
                Albedo e = albedo_quadrature(&lobe, o, 1e-5);
                double all = (double)(e.f0 + e.f90);
                if (!is_ridge(&lobe)) {
                    Albedo m = midpoint_albedo(&lobe, o, cells);
                    double d = fmax(fabs((double)(m.f0 - e.f0)), fabs((double)(m.f90 - e.f90)));
                    if (d > worst) worst = d;
                    if (d > 1e-3)
                        fail_msg("%s: E %.5f + %.5f, midpoint rule %.5f + %.5f", name, (double)e.f0, (double)e.f90,
                                 (double)m.f0, (double)m.f90);
                }
                Estimate s = sampled_albedo(&lobe, o, false, samples);
                if (fabs(s.mean - all) > 5.0 * s.error + 1e-3)
                    fail_msg("%s: E %.5f, sampling %.5f +- %.5f", name, all, s.mean, s.error);
                if (weft_lobe_info(id)->param_count && lobe.params[0] < 0.1f) continue; /* rare hits */
                s = sampled_albedo(&lobe, o, true, samples);
                if (fabs(s.mean - all) > 5.0 * s.error + 1e-3)
                    fail_msg("%s: E %.5f, cosine sampling %.5f +- %.5f", name, all, s.mean, s.error);
            }
    print_message("largest difference between quadrature and midpoint rule: %.1e\n", worst);
}

static void traits_about_energy_are_true(void **state) {
    (void)state;
    static const float grazing[] = {1e-4f, 1e-3f, 0.005f, 0.02f, 0.05f, 0.1f, 0.2f, 0.35f, 0.5f, 0.7f, 0.85f, 1.0f};
    int turn = 0;
    for (int id = 0; id < weft_lobe_count(); id++) {
        unsigned traits = weft_lobe_info(id)->traits;
        if (case_walks(id)) continue;
        double highest = 0.0, lowest = 1e9;
        for (int k = 0; k < case_count(id); k++)
            for (size_t c = 0; c < sizeof grazing / sizeof grazing[0]; c++) {
                if (!test_turn(&turn, 1, 17)) continue;
                Lobe lobe = case_lobe(id, k);
                Dir o = direction_cos((double)grazing[c], 0.3);
                if (is_ridge(&lobe)) continue;
                Albedo e = albedo_quadrature(&lobe, o, test_long() ? 1e-5 : 3e-5);
                double all = (double)(e.f0 + e.f90);
                highest = fmax(highest, all);
                lowest = fmin(lowest, all);
                if (traits & TRAIT_CONSERVES && all > 1.0 + 1e-3)
                    fail_msg("%s reflects %.5f", case_name(&lobe, o).text, all);
                if (traits & TRAIT_LOSSLESS && fabs(all - 1.0) > 1e-4)
                    fail_msg("%s reflects %.6f", case_name(&lobe, o).text, all);
            }
        print_message("%-20s E from %.4f to %.4f\n", weft_lobe_info(id)->id, lowest, highest);
        if (test_short()) continue; /* too few to tell: a lobe that conserves says so */
        if (highest <= 1.0 + 1e-4) assert_true(traits & TRAIT_CONSERVES);
        if (highest <= 1.0 + 1e-4 && lowest > 1.0 - 1e-4) assert_true(traits & TRAIT_LOSSLESS);
    }
}

static double albedo(const char *id, const char *alpha, float cos_o) {
    WeftLobe lobe;
    float e[3];
    assert_int_equal(weft_lobe_init(id, &lobe, NULL), WEFT_OK);
    assert_int_equal(weft_lobe_set(&lobe, "alpha", alpha, NULL, NULL), WEFT_OK);
    weft_lobe_albedo(&lobe, cos_o, e);
    return (double)e[0];
}

static double highest_albedo(const char *id, const char *alpha) {
    double highest = 0.0;
    for (int k = 0; k <= 100; k++) highest = fmax(highest, albedo(id, alpha, (float)(pow)(10.0, -4.0 + 0.04 * k)));
    return highest;
}

static double lowest_albedo(const char *id, const char *alpha) {
    double lowest = 1e9;
    for (int k = 1; k <= 50; k++) lowest = fmin(lowest, albedo(id, alpha, (float)k / 50.0f));
    return lowest;
}

static void albedo_has_the_values_of_the_headers(void **state) {
    (void)state;
    /* Charlie passes 1: what the lobe headers say */
    assert_true(fabs(albedo("charlie-neubelt", "0.01", 0.02f) - 2.69) < 0.005);
    assert_true(fabs(albedo("charlie-neubelt", "0.0625", 0.02f) - 1.38) < 0.005);
    assert_true(fabs(albedo("charlie-conty-kulla", "0.01", 0.02f) - 1.63) < 0.005);
    /* the least alpha that conserves; and the horizon, where conty-kulla never does */
    assert_true(highest_albedo("charlie-neubelt", "0.20") > 1.0 && highest_albedo("charlie-neubelt", "0.215") < 1.0);
    assert_true(highest_albedo("charlie-conty-kulla", "0.06") > 1.0);
    assert_true(highest_albedo("charlie-conty-kulla", "0.07") < 1.0);
    assert_true(albedo("charlie-conty-kulla", "0.99", 1e-6f) > 1.0);
    /* what GGX loses between its facets */
    assert_true(fabs(1.0 - lowest_albedo("ggx", "0.25") - 0.16) < 0.005);
    assert_true(fabs(1.0 - lowest_albedo("ggx", "0.5") - 0.32) < 0.005);
    assert_true(fabs(1.0 - lowest_albedo("ggx", "1") - 0.693) < 0.005);
    /* GGX of alpha 1 at normal incidence: the integral of c / (1 + c) is 1 - ln 2 */
    WeftLobe ggx;
    float e[3], black[3] = {0}, white[3] = {1.0f, 1.0f, 1.0f};
    weft_lobe_init("ggx", &ggx, NULL);
    weft_lobe_set(&ggx, "alpha", "1", NULL, NULL);
    weft_lobe_albedo(&ggx, 1.0f, e);
    assert_float_equal(e[0], (1.0f - 0.693147181f), 1e-4f);
    /* its colour counts, f0 and f90 apart */
    memcpy(ggx.f0, black, sizeof black);
    memcpy(ggx.f90, white, sizeof white);
    weft_lobe_albedo(&ggx, 1.0f, e);
    assert_true(e[1] > 0.0f && e[1] < 1e-3f);
}

/* E of a lobe that mixes a table by cos_i, against sums of many rings: creases cost no digits. The rings are
 * uniform in the cube root of cos_i. */
static double rings_albedo(const Lobe *lobe, Dir o) {
    enum { RINGS = 2000, TURNS = 300 };
    static float ox[TURNS], oy[TURNS], oz[TURNS], ix[TURNS], iy[TURNS], iz[TURNS], f[TURNS], share[TURNS];
    double sum = 0.0;
    for (int j = 0; j < RINGS; j++) {
        double x = (j + 0.5) / RINGS, mu = x * x * x, r = (sqrt)(1.0 - mu * mu), ring = 0.0;
        for (int k = 0; k < TURNS; k++) {
            double phi = 2.0 * PI_DOUBLE * (k + 0.5) / TURNS;
            ox[k] = o.x, oy[k] = o.y, oz[k] = o.z;
            ix[k] = (float)(r * (cos)(phi)), iy[k] = (float)(r * (sin)(phi)), iz[k] = (float)mu;
        }
        lobe_eval_n(lobe, TURNS, ox, oy, oz, ix, iy, iz, f, share);
        for (int k = 0; k < TURNS; k++) ring += (double)f[k];
        sum += ring * mu * 3.0 * x * x / RINGS * 2.0 * PI_DOUBLE / TURNS;
    }
    return sum;
}

static void albedo_of_a_creased_table_is_integrated(void **state) {
    (void)state;
    static const double grazing[] = {0.001, 0.003, 0.012, 0.03, 0.08, 0.17};
    double worst = 0.0;
    for (int k = 0; k < 12; k++) {
        Lobe lobe = lobe_default(LOBE_FIBRE_TABLE);
        lobe_set(&lobe, 0, k % 2 ? 0.19f : 0.25f);
        Dir o = direction_cos(grazing[k / 2], 0.0);
        worst = fmax(worst, fabs((double)albedo_quadrature(&lobe, o, 2e-5).f0 - rings_albedo(&lobe, o)));
    }
    print_message("fibre-table: E within %.1e of sums over rings\n", worst);
    assert_true(worst < 1e-5);
}

/* A clamp is a crease in E, as are the nodes of a table and where another azimuth is brightest, and a maximum of two tables
 * a sharper one; those of ltc-fibre-published, which ltc-fibre-half has too, are uniform in cos_o, so few where E is
 * steep. */
static double table_error_most(int id, double alpha) {
    switch (id) {
    case LOBE_CHARLIE_KHRONOS: return 4e-3;
    case LOBE_LTC_FIBRE_HALF:
    case LOBE_LTC_FIBRE_PUBLISHED: return 2e-2;
    case LOBE_LTC_FIBRE:
    case LOBE_FIBRE_TABLE: return 6e-3;
    case LOBE_SILK: return alpha < 0.015 ? 3e-2 : 1e-2;
    case LOBE_WOVEN: return alpha < 0.1 ? 1e-2 : 4e-3;
    case LOBE_YARN:
    case LOBE_THREADS: return 4e-3;
    case LOBE_FIBRE: return alpha < 0.1 ? 3e-3 : 2e-3;
    case LOBE_CHARLIE_NEUBELT_NORMALISED: return alpha < 0.01 ? 4e-2 : 3e-2;
    default: return 2e-3;
    }
}

static void albedo_table_between_nodes_is_close(void **state) {
    (void)state;
    static AlbedoTable table;
    Random random = {5};
    int turn = 0;
    for (int id = 0; id < weft_lobe_count(); id++) {
        if (case_walks(id) || !test_turn(&turn, 1, 7)) continue;
        fill_albedo(&table, id);
        const WeftLobeInfo *info = weft_lobe_info(id);
        double worst = 0.0, worst_cos = 0.0, worst_alpha = 0.0;
        for (int n = 0; n < (test_long() ? 20000 : test_short() ? 30 : 150); n++) {
            double x = (double)random_unit(&random), y = (double)random_unit(&random);
            double low = info->param_count ? fmax((double)table.low, 0.005) : 0.0, high = (double)table.high;
            double alpha = n % 2 && low > 0.0 ? low * (pow)(high / low, y) : low + (high - low) * y * y;
            Dir o = direction_cos(fmax(n % 4 < 2 ? x * x * x * x : x, 1e-3), 0.0);
            Lobe lobe = table.lobe;
            if (info->param_count) lobe_set(&lobe, 0, (float)alpha);
            Albedo e = albedo_quadrature(&lobe, albedo_brightest(&lobe, o.z), 1e-5);
            double d = fabs((double)(e.f0 + e.f90 - table_albedo(albedo_table_ref(&table), o.z, (float)alpha)));
            if (d > worst) worst = d, worst_cos = (double)o.z, worst_alpha = alpha;
            if (d > table_error_most(id, alpha))
                fail_msg("%s: the table errs by %.5f at alpha %.4g, cos_o %.4g", info->id, d, alpha, (double)o.z);
        }
        print_message("%-20s table within %.1e (at alpha %.4g, cos_o %.4g)\n", info->id, worst, worst_alpha, worst_cos);
    }
}

/* The most by which a table is below E of a lobe, over azimuths and cosines. */
static float most_below(const AlbedoTable *table, const Lobe *lobe) {
    float below = 0.0f;
    for (int n = 0; n < 5 * 9; n++) {
        Dir o = direction_cos(0.05 + 0.2 * (n % 5), 0.35 * (n / 5));
        Albedo e = albedo_quadrature(lobe, o, 1e-4);
        below = max(below, e.f0 + e.f90 - table_albedo(albedo_table_ref(table), o.z, lobe->params[0]));
    }
    return below;
}

/* A brushed lobe's table is not below E of any azimuth by more than a hair, else layer rules would give light away:
 * for yarns that run along x, as those of a sheen do, it would be by .08. Nor is one for a range of widths. */
static void albedo_table_of_a_brushed_lobe_is_a_bound(void **state) {
    (void)state;
    static AlbedoTable table;
    int brushed = 0;
    for (int k = 0; k < 2 * weft_lobe_count(); k++) {
        const int id = k / 2;
        Lobe lobe = lobe_fibres(lobe_default(id), 1.0f, 0.0f, k % 2 ? 0.39f : 0.0f); /* azimuth */
        if (case_walks(id) || !lobe_depends_on_azimuth(&lobe)) continue;
        albedo_table_fill(&table, &lobe, lobe.params[0], lobe.params[0], 0);
        float below = most_below(&table, &lobe);
        lobe = sheen_lobe(id, 0.5f);
        if (k % 2 == 0 && lobe_depends_on_azimuth(&lobe)) {
            fill_albedo(&table, id);
            for (int n = 0; n < (test_short() ? 1 : 3); n++) {
                lobe = table.lobe;
                lobe_set(&lobe, 0, mix(table.low, table.high, (float)n / 3.0f));
                below = max(below, most_below(&table, &lobe));
            }
        }
        print_message("%s: at most %.4f below E\n", weft_lobe_info(id)->id, (double)below);
        assert_true(below < 0.01f);
        brushed++;
    }
    assert_true(brushed >= 6);
}

/* One parameter value, and values beyond the range that was asked for. */
static void albedo_table_outside_its_range_uses_its_end(void **state) {
    (void)state;
    static AlbedoTable table;
    Lobe lobe = lobe_default(LOBE_CHARLIE_NEUBELT);
    albedo_table_fill(&table, &lobe, 0.25f, 0.25f, 1);
    assert_int_equal(table.rows, 1);
    Dir o = direction_cos(0.3, 0.0);
    assert_float_equal(table_albedo(albedo_table_ref(&table), 0.3f, 0.7f), albedo_quadrature(&lobe, o, 1e-5).f0, 1e-3f);
    albedo_table_fill(&table, &lobe, 0.0f, 0.5f, 2); /* 0 is below the hard range: the rows begin at its end */
    assert_float_equal(table_albedo(albedo_table_ref(&table), 0.3f, 0.0f),
                       table_albedo(albedo_table_ref(&table), 0.3f, 0.005f), 1e-6f);
    assert_float_equal(table_albedo(albedo_table_ref(&table), 0.3f, 9.0f),
                       table_albedo(albedo_table_ref(&table), 0.3f, 0.5f), 1e-6f);
    assert_float_equal(table_albedo(albedo_table_ref(&table), 2.0f, 0.5f),
                       table_albedo(albedo_table_ref(&table), 1.0f, 0.5f), 1e-6f);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(albedo_by_quadrature_agrees_with_other_estimators),
        cmocka_unit_test(traits_about_energy_are_true),
        cmocka_unit_test(albedo_has_the_values_of_the_headers),
        cmocka_unit_test(albedo_of_a_creased_table_is_integrated),
        cmocka_unit_test(albedo_table_between_nodes_is_close),
        cmocka_unit_test(albedo_table_of_a_brushed_lobe_is_a_bound),
        cmocka_unit_test(albedo_table_outside_its_range_uses_its_end),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
