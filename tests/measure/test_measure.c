/* The measurements find what is wrong, and nothing where nothing is */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "base/pi.h"
#include "fakes.h"

#include "measure/bsdf/exceeds.h"
#include "measure/bsdf/grid.h"
#include "measure/check/chi_square.h"
#include "measure/check/furnace.h"
#include "measure/check/sweep.h"
#include "measure/check/weight.h"

static void assert_near(double got, double expected, double tolerance) {
    if (!(fabs(got - expected) <= tolerance)) fail_msg("%.9g, not %.9g +- %g", got, expected, tolerance);
}

static void lambert_passes_every_measurement(void **state) {
    (void)state;
    Bsdf bsdf = fake_lambert();
    WeftPassport p = fake_passport(&bsdf);
    for (int c = 0; c < WEFT_PASSPORT_COSINES; c++) assert_near((double)p.albedo[0][c], 1.0, 1e-3);
    assert_int_equal(p.albedo_above, 0);
    assert_near((double)p.reciprocity, 0.0, 0.0);
    assert_near((double)p.pdf_most, 1.0, 1e-3);
    assert_true(weft_passport_significance(p.p, p.tests) > 1e-3);
    assert_int_equal(p.stray, 0);
    assert_near((double)p.missed, 0.0, 0.0);
    assert_int_equal(p.sweep_infinite + p.sweep_negative + p.sweep_below, 0);
    assert_near((double)p.variance_ratio, 1.0, 1e-3);
    for (int v = 0; v < WEFT_PASSPORT_VIEWS; v++) assert_near((double)p.variance[0][v], 0.0, 1e-6);
}

/* f = cos_o / pi: half the light or less comes back, and viewer and light cannot change places. */
static void one_sided_f(const BsdfView *view, Dirs i, float *f) {
    for (size_t k = 0; k < i.n; k++) f[k] = i.z[k] > 0.0f ? view->o.z / PI : 0.0f;
}

static void model_that_is_not_reciprocal_is_found(void **state) {
    (void)state;
    Bsdf bsdf = fake_lambert();
    bsdf.f = one_sided_f;
    WeftPassport p = fake_passport(&bsdf);
    assert_true(p.reciprocity > 0.99f);
    float z_o = p.reciprocity_place.cos_o, z_i = p.reciprocity_place.cos_i; /* there it is so */
    assert_near((double)(fabsf(z_o - z_i) / max(max(z_o, z_i), PI * 1e-3f)), (double)p.reciprocity, 1e-3);
    for (int c = 0; c < WEFT_PASSPORT_COSINES; c++) assert_near((double)p.albedo[0][c], (double)p.cosines[c], 1e-3);
}

static void gaining_f(const BsdfView *view, Dirs i, float *f) {
    fake_f(view, i, f);
    for (size_t k = 0; k < i.n; k++) f[k] *= view->o.z < 0.03f ? 1.1f : 0.9f;
}

static void albedo_above_one_is_found_where_it_is(void **state) {
    (void)state;
    Bsdf bsdf = fake_lambert();
    bsdf.f = gaining_f;
    WeftPassport p = fake_passport(&bsdf);
    int expected = 0;
    for (int c = 0; c < WEFT_PASSPORT_COSINES; c++) expected += p.cosines[c] < 0.03f;
    assert_true(expected > 0);
    assert_int_equal(p.albedo_above, expected);
    assert_near((double)p.albedo_most, 1.1, 1e-3);
    assert_true(p.albedo_place.cos_o < 0.03f);
}

/* Samples that are uniform under the pdf of the cosine. */
static Dir uniform_sample(const BsdfView *view, float u, float v) { return warp_uniform(u, v); }

static void wrong_samples_are_found(void **state) {
    (void)state;
    Bsdf bsdf = fake_lambert();
    bsdf.sample = uniform_sample;
    WeftPassport p = fake_passport(&bsdf);
    assert_true(weft_passport_significance(p.p, p.tests) < 1e-9);
}

static void large_pdf(const BsdfView *view, Dirs i, float *pdf) {
    fake_pdf(view, i, pdf);
    for (size_t k = 0; k < i.n; k++) pdf[k] *= 1.02f;
}

static void pdf_that_integrates_to_more_than_one_is_found(void **state) {
    (void)state;
    Bsdf bsdf = fake_lambert();
    bsdf.pdf = large_pdf;
    WeftPassport p = fake_passport(&bsdf);
    assert_near((double)p.pdf_most, 1.02, 1e-3);
}

static void holed_pdf(const BsdfView *view, Dirs i, float *pdf) {
    fake_pdf(view, i, pdf);
    for (size_t k = 0; k < i.n; k++)
        if (i.x[k] > 0.9f) pdf[k] = 0.0f;
}

static void impossible_samples_are_found(void **state) {
    (void)state;
    Bsdf bsdf = fake_lambert();
    bsdf.pdf = holed_pdf;
    WeftPassport p = fake_passport(&bsdf);
    assert_true(p.stray > 0);
    assert_true(weft_passport_significance(p.p, p.tests) < 1e-9);
}

/* The cosine's samples, those of x < 0 thrown to the other side: none is impossible and the pdf integrates to
 * 1, but half of E is never found. */
static void halved_pdf(const BsdfView *view, Dirs i, float *pdf) {
    fake_pdf(view, i, pdf);
    for (size_t k = 0; k < i.n; k++) pdf[k] *= i.x[k] < 0.0f ? 0.0f : 2.0f;
}
static Dir halved_sample(const BsdfView *view, float u, float v) {
    Dir i = warp_cosine(u, v);
    return dir(fabsf(i.x), i.y, i.z);
}

static void directions_that_samples_miss_are_found(void **state) {
    (void)state;
    Bsdf bsdf = fake_lambert();
    bsdf.pdf = halved_pdf;
    bsdf.sample = halved_sample;
    WeftPassport p = fake_passport(&bsdf);
    assert_int_equal(p.stray, 0);
    assert_near((double)p.pdf_most, 1.0, 0.01);
    assert_near((double)p.missed, 0.5, 0.01);
}

/* NaN towards one side, for grazing wo alone: larger than whatever comes before or after it. */
static void broken_f(const BsdfView *view, Dirs i, float *f) {
    fake_f(view, i, f);
    for (size_t k = 0; k < i.n; k++)
        if (i.x[k] > 0.5f && view->o.z < 0.06f && view->o.z > 0.04f) f[k] = NAN;
}
static void broken_pdf(const BsdfView *view, Dirs i, float *pdf) {
    fake_pdf(view, i, pdf);
    for (size_t k = 0; k < i.n; k++)
        if (i.x[k] > 0.5f && view->o.z < 0.5f && view->o.z > 0.3f) pdf[k] = NAN;
}

static void nan_of_a_model_is_reported(void **state) {
    (void)state;
    Bsdf bsdf = fake_lambert();
    bsdf.f = broken_f;
    bsdf.pdf = broken_pdf;
    WeftPassport p = fake_passport(&bsdf);
    assert_true(isnan(p.albedo_most) && p.albedo_place.cos_o == 0.05f && p.albedo_above == 1);
    assert_true(isnan(p.reciprocity));
    assert_true(isnan(p.pdf_most) && p.pdf_place.cos_o == 0.4f);
    assert_true(isnan(p.variance_worst));
    const double lost = (double)NAN;
    assert_true(exceeds_or_nan(lost, 1.0) && !exceeds_or_nan(1.0, lost) && !exceeds_or_nan(lost, lost) &&
                exceeds_or_nan(2.0, 1.0));
}

/* f with a zero under it, one below 0, and one that forgets the horizon. */
static void wild_f(const BsdfView *view, Dirs i, float *f) {
    for (size_t k = 0; k < i.n; k++)
        f[k] = i.z[k] > 0.99f ? HUGE_VALF : i.z[k] < -0.99f ? 1.0f : i.z[k] > 0.9f ? -1.0f : 0.0f;
}

static void sweep_counts_infinite_and_negative_values(void **state) {
    (void)state;
    Bsdf bsdf = fake_lambert();
    bsdf.f = wild_f;
    Sweep sweep = sweep_setting(&bsdf, 0);
    assert_true(sweep.infinite >= SWEEP_DIRS && sweep.negative >= SWEEP_DIRS && sweep.below >= SWEEP_DIRS);
    assert_true(sweep.infinite + sweep.negative + sweep.below < sweep.count);
}

static void sweep_has_grazing_and_normal_directions(void **state) {
    (void)state;
    bool grazes = false, normal = false, axis = false;
    for (int k = 0; k < SWEEP_DIRS; k++) {
        Dir w = sweep_dir(k);
        assert_near((double)dir_dot(w, w), 1.0, 1e-6);
        assert_true(w.z > 0.0f);
        grazes |= w.z < 1e-20f;
        normal |= w.x == 0.0f && w.y == 0.0f;
        axis |= w.x == -1.0f && w.y == 0.0f;
    }
    assert_true(grazes && normal && axis);
}

/* f = 3 cos_i / (2 pi) under the cosine's sampling: the weight is 3 cos_i / 2, of mean 1 and variance 9/8
 * - 1.
 */
static void rising_f(const BsdfView *view, Dirs i, float *f) {
    for (size_t k = 0; k < i.n; k++) f[k] = i.z[k] > 0.0f ? 1.5f * i.z[k] / PI : 0.0f;
}
static void mixed_pdf(const BsdfView *view, Dirs i, float *pdf) {
    for (size_t k = 0; k < i.n; k++) pdf[k] = i.z[k] > 0.0f ? (1.0f + i.z[k]) / (3.0f * PI) : 0.0f;
}

static void variances_are_those_of_closed_forms(void **state) {
    (void)state;
    Bsdf bsdf = fake_lambert();
    BsdfView view;
    bsdf.f = rising_f;
    bsdf.prepare(&bsdf, 0, grid_direction(0.3, 1.0), &view);
    Weight weight = weight_measure(&view, 200);
    assert_near(weight.albedo, 1.0, 1e-4);
    assert_near(weight.own, 1.0 / 8.0, 1e-4);
    assert_near(weight.by_cosine, 1.0 / 8.0, 1e-4);
    bsdf.pdf = mixed_pdf;
    weight = weight_measure(&view, 200);
    /* integral of (3 z^2 / 2 pi)^2 / pdf = 27/2 integral over [0, 1] of z^4 / (1 + z) = 27/2 (ln 2 - 7/12) */
    assert_near(weight.own, 13.5 * ((log)(2.0) - 7.0 / 12.0) - 1.0, 1e-4);
}

static void grid_covers_the_hemisphere_once(void **state) {
    (void)state;
    static Grid grid;
    static Ring ring;
    static const double cosines[] = {1.0, 0.6, 0.01};
    for (int c = 0; c < 3; c++) {
        Dir o = grid_direction(cosines[c], 2.0);
        double area = 0.0, projected = 0.0, elsewhere = 0.0;
        grid_make(&grid, o, 200);
        for (int row = 0; row < 200; row++) {
            Dirs dirs = grid_ring(&grid, row, &ring);
            for (size_t k = 0; k < dirs.n; k++) {
                area += ring.area[k];
                projected += ring.area[k] * (double)dirs.z[k];
                int bin = grid_bin(&grid, dir(dirs.x[k], dirs.y[k], dirs.z[k]), 20);
                if (bin != row / 10 * 20 + (int)k / 10) elsewhere += ring.area[k];
            }
        }
        assert_near(area, 2.0 * PI_DOUBLE, 1e-4);
        assert_near(projected, PI_DOUBLE, 1e-4);
        assert_near(elsewhere, 0.0, 1e-6); /* rounding, next to the mirror direction */
    }
}

/* Quantiles from tables of the distribution; Wilson and Hilferty's cube root is good to a few per cent of the
 * tail. */
static void chi_square_tails_are_those_of_the_distribution(void **state) {
    (void)state;
    assert_near(chi_square_tail(18.307, 10), 0.05, 0.001);
    assert_near(chi_square_tail(29.588, 10), 0.001, 0.0001);
    assert_near(chi_square_tail(124.342, 100), 0.05, 0.0005);
    assert_near(chi_square_tail(99.334, 100), 0.5, 0.001);
    assert_near(weft_passport_significance(0.01, 1), 0.01, 1e-12);
    assert_near(weft_passport_significance(0.01, 10), 1.0 - (pow)(0.99, 10.0), 1e-6);
}

/* A sheen that reflects nothing leaves the white base as it is, whatever the rule; one of E = 1 over it gives
 * 2 where nothing is taken away. */
static void furnace_of_a_black_sheen_is_one(void **state) {
    (void)state;
    static AlbedoTable table;
    Lobe sheen = lobe_default(weft_lobe_find("charlie-neubelt"));
    sheen.params[0] = 0.01f;
    albedo_table_fill(&table, &sheen, 0.01f, 0.01f, 1);
    Dir o = dir(0.0f, 0.0f, 1.0f); /* where the thin rim is nothing */
    for (int layer = 0; weft_layer_name(layer); layer++)
        if (!strstr("seed side-by-side albedo-max", weft_layer_name(layer)))
            assert_near(furnace_measure(&sheen, 0.1f, layer, &table, o, 100, 10000).e, 1.0, 0.02);
    Lobe lambert = lobe_default(weft_lobe_find("lambert"));
    albedo_table_fill(&table, &lambert, 0.0f, 0.0f, 1);
    assert_near(furnace_measure(&lambert, 0.5f, LAYER_ADDITIVE, &table, o, 100, 10000).e, 2.0, 1e-3);
}

/* Over white Lambert all bounces sum up to what the rule reciprocal has: the noise that is told is the
 * distance. */
static void noise_of_random_walks_is_estimated(void **state) {
    (void)state;
    static AlbedoTable table;
    Lobe sheen = lobe_rough(weft_lobe_find("ashikhmin-neubelt"), 0.5f);
    albedo_table_fill(&table, &sheen, sheen.params[0], sheen.params[0], 1);
    for (int k = 1; k < 5; k++) {
        Dir o = grid_direction(0.2 * k, 0.0);
        Furnace exact = furnace_measure(&sheen, 0.5f, LAYER_RECIPROCAL, &table, o, 100, 10000);
        Furnace few = furnace_measure(&sheen, 0.5f, LAYER_STOCHASTIC, &table, o, 100, 10000);
        Furnace many = furnace_measure(&sheen, 0.5f, LAYER_STOCHASTIC, &table, o, 100, 1000000);
        assert_near(exact.noise, 0.0, 0.0);
        assert_near(few.e, exact.e, 4.0 * few.noise + 1e-4);
        assert_near(many.e, exact.e, 4.0 * many.noise + 1e-4);
        assert_true(few.noise < 1e-2 && many.noise > 0.0 && many.noise <= 5e-4 && many.noise <= few.noise);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lambert_passes_every_measurement),
        cmocka_unit_test(model_that_is_not_reciprocal_is_found),
        cmocka_unit_test(albedo_above_one_is_found_where_it_is),
        cmocka_unit_test(wrong_samples_are_found),
        cmocka_unit_test(pdf_that_integrates_to_more_than_one_is_found),
        cmocka_unit_test(impossible_samples_are_found),
        cmocka_unit_test(directions_that_samples_miss_are_found),
        cmocka_unit_test(nan_of_a_model_is_reported),
        cmocka_unit_test(sweep_counts_infinite_and_negative_values),
        cmocka_unit_test(sweep_has_grazing_and_normal_directions),
        cmocka_unit_test(variances_are_those_of_closed_forms),
        cmocka_unit_test(grid_covers_the_hemisphere_once),
        cmocka_unit_test(chi_square_tails_are_those_of_the_distribution),
        cmocka_unit_test(furnace_of_a_black_sheen_is_one),
        cmocka_unit_test(noise_of_random_walks_is_estimated),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
