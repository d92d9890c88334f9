/* Fibres that lean: what layer rules take from the base, by the azimuth of the viewer about the nap
 *
 * Labels: unsanitized */
#include "base/pi.h"
#include "cases.h"

#define DEGREES (PI_FLOAT / 180.0f)

static const float headings[] = {0.0f, 42.0f, 76.0f, 90.0f, 155.0f, 180.0f, 285.0f};
static const float cosines[] = {0.05f, 0.2f, 0.5f};
enum { HEADINGS = sizeof headings / sizeof headings[0], COSINES = sizeof cosines / sizeof cosines[0] };

/* A white base under white fibres that lean. */
static Surface brushed(float roughness, float tilt, float azimuth) {
    Surface cloth = white_cloth(roughness);
    cloth.nap = tilt;
    cloth.nap_direction = dir(3.0f * cos(azimuth), 3.0f * sin(azimuth), 0.0f);
    return cloth;
}

/* Of its sheen; the azimuth is to say nothing. */
static void fill(AlbedoTable *table, float roughness, float tilt, bool scaled) {
    Lobe lobe = lobe_fibres(lobe_rough(LOBE_FIBRE, roughness), 1.0f, tilt, 4.0f);
    float alpha = lobe.params[0];
    (scaled ? albedo_table_fill_tilts : albedo_table_fill)(table, &lobe, alpha, alpha, 0);
}

static double furnace(const SeenStack *stack, Dir o) {
    enum { CELLS = 44 };
    Grid grid = grid_about(o);
    double step = 2.0 / CELLS, sum = 0.0;
    for (int j = 0; j < CELLS; j++)
        for (int k = 0; k < CELLS; k++) {
            double area;
            Dir i = grid_direction(grid, -1.0 + step * (j + 0.5), -1.0 + step * (k + 0.5), &area);
            if (i.z > 0.0f) sum += (double)seen_eval(stack, i, 0).f_cos.g * area * step * step;
        }
    return sum;
}

/* How far from 1 the furnace of rule albedo-view is at the worst, and would be with E across the nap. */
typedef struct Worst {
    double off, across;
} Worst;

static void measure(Worst *worst, const AlbedoTable *table, float roughness, float tilt) {
    const float azimuth = 2.2f;
    Surface cloth = brushed(roughness, tilt, azimuth);
    TableRef ref = albedo_table_ref(table);
    for (int c = 0; c < COSINES; c++)
        for (int k = 0; k < HEADINGS; k++) {
            Dir o = direction_cos((double)cosines[c], (double)(azimuth + headings[k] * DEGREES));
            SeenStack stack = test_stack(&cloth, LAYER_ALBEDO_VIEW, table, o);
            double all = furnace(&stack, o),
                   across = all + (double)(stack.view.e_o.e - table_sheen(ref, o.z, stack.stack.albedo_coord).e);
            worst->off = fmax(worst->off, fabs(all - 1.0));
            worst->across = fmax(worst->across, fabs(across - 1.0));
        }
}

static void check(const Worst *worst, double tolerance, const char *what, float roughness, float tilt) {
    print_message("%s, roughness %.2f, tilt %2.0f: a white base within %.3f of 1, by E across %.3f\n", what,
                  (double)roughness, (double)(tilt / DEGREES), worst->off, worst->across);
    if (worst->off > tolerance) fail_msg("%s: %.3f", what, worst->off);
    if (!(worst->across > 3.0 * worst->off)) fail_msg("%s: headings make no difference", what);
}

static void white_base_under_leaning_fibres_stays_white(void **state) {
    (void)state;
    static AlbedoTable table;
    static const float cases[][3] = {{0.4f, 12.0f, 0.05f},  {0.4f, 45.0f, 0.05f},  {0.71f, 12.0f, 0.02f},
                                     {0.71f, 30.0f, 0.03f}, {0.71f, 45.0f, 0.03f}, {0.8f, 45.0f, 0.02f}};
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        Worst worst = {0};
        float tilt = cases[k][1] * DEGREES;
        fill(&table, cases[k][0], tilt, false);
        assert_int_equal(table.tilts, 1);
        measure(&worst, &table, cases[k][0], tilt);
        check(&worst, (double)cases[k][2], "one tilt", cases[k][0], tilt);
    }
}

/* The table is that of 45 degrees, of which a texture takes a part. */
static void table_holds_for_textured_tilts_below_its_own(void **state) {
    (void)state;
    static AlbedoTable table;
    static const float parts[] = {1.5f, 6.0f, 15.0f, 34.0f};
    static const float cases[][2] = {{0.3f, 0.08f}, {0.64f, 0.05f}, {0.8f, 0.02f}};
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        Worst worst = {0};
        fill(&table, cases[k][0], 45.0f * DEGREES, true);
        assert_int_equal(table.tilts, TABLE_TILTS);
        for (size_t n = 0; n < sizeof parts / sizeof parts[0]; n++) {
            Worst one = {0};
            measure(&one, &table, cases[k][0], parts[n] * DEGREES);
            if (test_long()) print_message("  %g: %.3f\n", (double)parts[n], one.off);
            worst = (Worst){fmax(worst.off, one.off), fmax(worst.across, one.across)};
        }
        check(&worst, (double)cases[k][1], "any tilt", cases[k][0], 45.0f * DEGREES);
    }
}

/* By 24 azimuths and a Gauss rule of three points in each of 8 parts of mu^2. */
static void average_albedo_of_leaning_fibres_covers_azimuths(void **state) {
    (void)state;
    static AlbedoTable table;
    static const double x[3] = {-0.774596669241483, 0.0, 0.774596669241483}, w[3] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
    for (int scaled = 0; scaled < 2; scaled++) {
        Lobe lobe = lobe_fibres(lobe_rough(LOBE_FIBRE, 0.7f), 1.0f, 40.0f * DEGREES, 0.0f);
        double sum = 0.0;
        for (int p = 0; p < 24; p++)
            for (int k = 0; k < 24; k++) {
                double mu = (sqrt)((k / 3 + 0.5 + 0.5 * x[k % 3]) / 8.0);
                sum += w[k % 3] / 8.0 / 24.0 *
                       (double)albedo_quadrature(&lobe, direction_cos(mu, p * 0.2617993878), 1e-3).f0;
            }
        fill(&table, 0.7f, (scaled ? 45.0f : 40.0f) * DEGREES, scaled);
        TableRef ref = albedo_table_ref(&table);
        float average = table_sheen_nap_average(ref, nap_of(40.0f * DEGREES, dir(0.0f, 1.0f, 0.0f)),
                                                table_rows(ref, lobe.params[0]))
                            .e;
        print_message("E on average %.4f, by quadrature %.4f\n", (double)average, sum);
        assert_float_equal(average, sum, 4e-3);
    }
}

/* Rule reciprocal asks for E of both directions, each by its own azimuth. */
static void rule_reciprocal_is_reciprocal_over_leaning_fibres(void **state) {
    (void)state;
    static AlbedoTable table;
    Random random = {5};
    Surface cloth = brushed(0.7f, 0.6f, 1.0f);
    fill(&table, 0.7f, 0.6f, false);
    for (int n = 0; n < 2000; n++) {
        Dir o = random_direction(&random), i = random_direction(&random);
        SeenStack there = test_stack(&cloth, LAYER_RECIPROCAL, &table, o),
                  back = test_stack(&cloth, LAYER_RECIPROCAL, &table, i);
        float a = seen_eval(&there, i, 0).f_cos.g / i.z, b = seen_eval(&back, o, 0).f_cos.g / o.z;
        if (!(fabsf(a - b) <= 1e-3f * (a + b))) fail_msg("%g there, %g back", (double)a, (double)b);
    }
}

/* Next to the normal all azimuths agree, and any nap is told from any direction without a NaN. */
static void albedo_near_the_normal_does_not_depend_on_azimuth(void **state) {
    (void)state;
    static AlbedoTable table;
    fill(&table, 0.7f, 0.6f, true);
    TableRef ref = albedo_table_ref(&table);
    Taps rows = table_rows(ref, ref.low);
    float e = table_sheen_nap(ref, dir(0.0f, 0.0f, 1.0f), nap_of(0.6f, dir(1.0f, 0.0f, 0.0f)), rows).e;
    for (int k = 0; k < 8; k++)
        for (float s = 1e-3f; s > 0.0f; s *= 1e-3f) {
            float x = s * cosf((float)k), y = s * sinf((float)k);
            Nap nap = nap_of(0.6f, dir(y, x, 0.0f));
            float near = table_sheen_nap(ref, dir(x, y, sqrt(1.0f - s * s)), nap, rows).e;
            assert_float_equal(near, e, 2e-3f);
        }
}

/* Where nothing leans, the table is what it was, and a nap changes nothing. */
static void upright_fibres_do_not_depend_on_azimuth(void **state) {
    (void)state;
    static AlbedoTable table;
    fill(&table, 0.7f, 0.0f, true);
    TableRef ref = albedo_table_ref(&table);
    assert_int_equal(table.tilts, 0);
    assert_int_equal(table.maps, ALBEDO_MAPS);
    Nap nap = nap_of(0.7f, dir(1.0f, 0.0f, 0.0f));
    Taps rows = table_rows(ref, 0.5f);
    for (int k = 1; k <= 20; k++) {
        Dir o = direction_cos(k / 20.0, k);
        assert_true(!(fabsf(table_sheen_nap(ref, o, nap, rows).e - table_sheen(ref, o.z, 0.5f).e) > 0.0f));
    }
    assert_true(!(fabsf(table_sheen_nap_average(ref, nap, rows).e - table_sheen_average(ref, rows).e) > 0.0f));
}

/* One table serves all azimuths, and not another tilt. */
static void table_of_a_tilt_has_the_albedo_at_that_tilt(void **state) {
    (void)state;
    static AlbedoTable table;
    fill(&table, 0.5f, 0.6f, false);
    Lobe lobe = lobe_fibres(lobe_rough(LOBE_FIBRE, 0.5f), 1.0f, 0.6f, 1.0f);
    float alpha = lobe.params[0];
    assert_true(albedo_table_serves(&table, &lobe, alpha, alpha, false));
    assert_false(albedo_table_serves(&table, &lobe, alpha, alpha, true));
    lobe = lobe_fibres(lobe, 1.0f, 0.5f, 1.0f);
    assert_false(albedo_table_serves(&table, &lobe, alpha, alpha, false));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(white_base_under_leaning_fibres_stays_white),
        cmocka_unit_test(table_holds_for_textured_tilts_below_its_own),
        cmocka_unit_test(average_albedo_of_leaning_fibres_covers_azimuths),
        cmocka_unit_test(rule_reciprocal_is_reciprocal_over_leaning_fibres),
        cmocka_unit_test(albedo_near_the_normal_does_not_depend_on_azimuth),
        cmocka_unit_test(upright_fibres_do_not_depend_on_azimuth),
        cmocka_unit_test(table_of_a_tilt_has_the_albedo_at_that_tilt),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
