/* Lobe fibre-walk, whose f is one random walk in single precision, against the walk in double: means over
 * neighbouring directions, since a value by itself says nothing */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/random.h"
#include "shading/catalogue/albedo.h"
#include "shading/media/fibre_medium.h"
#include "walks.h"

static Judge all;

static const double places[][7] = {
    /* alpha, density, tilt and azimuth of that; and of wo and wi: mu, mu, phi between */
    {0.5, 1.0, 0.0, 0.0, 0.4, 0.7, 2.0},  {0.5, 1.0, 0.0, 0.0, 0.7, 0.4, 2.0},   {0.3, 1.0, 0.0, 0.0, 0.2, 0.2, 1.0},
    {0.8, 4.0, 0.0, 0.0, 0.95, 0.9, 3.0}, {1.0, 0.25, 0.0, 0.0, 0.05, 0.5, 0.0}, {0.1, 1.0, 0.0, 0.0, 0.03, 0.05, 1.5},
    {0.6, 1.0, 0.5, 0.0, 0.5, 0.6, 0.4},  {0.6, 1.0, 0.5, 3.0, 0.5, 0.6, 0.4},   {0.4, 2.0, 0.78, 1.0, 0.3, 0.8, 2.5},
    {0.35, 4.0, 0.2, 5.0, 0.9, 0.2, 3.1},
};
enum { PLACES = sizeof places / sizeof places[0] };

static Lobe lobe_at_place(int k) {
    Lobe lobe = lobe_default(LOBE_FIBRE_WALK);
    for (int p = 0; p < 4; p++) lobe_set(&lobe, p, (float)places[k][p]);
    return lobe;
}

static WalkDesc slab_at_place(int k) {
    WalkDesc desc = slab(places[k][0], places[k][1], 1.0, places[k][2]);
    desc.azimuth = places[k][3];
    return desc;
}

static const char *place_name(int k) {
    static char text[120];
    snprintf(text, sizeof text, "alpha %g density %g tilt %g mu_o %g mu_i %g", places[k][0], places[k][1], places[k][2],
             places[k][4], places[k][5]);
    return text;
}

/* A direction somewhere about (mu, phi): near enough for f to be linear. */
static Dir near(double mu, double phi, uint64_t *stream) {
    double w[3], u = unit_double(stream_next(stream)) - 0.5, v = unit_double(stream_next(stream)) - 0.5;
    set_direction(w, mu * (1.0 + 2e-3 * u), phi + 2e-3 * v);
    return dir((float)w[0], (float)w[1], (float)w[2]);
}

/* Mean and standard error of what is added. B. P. Welford, Technometrics 4, 1962. */
typedef struct Mean {
    long long n;
    double mean, squares;
} Mean;

static void mean_add(Mean *m, double x) {
    double off = x - m->mean;
    m->mean += off / (double)++m->n;
    m->squares += off * (x - m->mean);
}
static double mean_error(const Mean *m) { return (sqrt)(m->squares) / (double)m->n; }

static void mean_of_random_f_is_f_of_walks(void **state) {
    (void)state;
    for (int k = 0; k < PLACES; k++) {
        double wi[3];
        WalkEstimate f;
        Lobe lobe = lobe_at_place(k);
        Mean mean = {0};
        uint64_t stream = stream_start(11, (uint64_t)k);
        while (mean.n < test_walks(1e5)) {
            Dir o = near(places[k][4], 0.0, &stream), i = near(places[k][5], places[k][6], &stream);
            mean_add(&mean, (double)lobe_eval(&lobe, angles_between(o, i)));
        }
        WalkDesc desc = slab_at_place(k);
        set_direction(wi, places[k][5], places[k][6]);
        desc.directions = 1, desc.wi = wi;
        run(desc, places[k][4], 0.0, 1e5, &f);
        print_message("%s: %.5f +- %.5f, %.5f +- %.5f\n", place_name(k), mean.mean, mean_error(&mean), f.mean, f.error);
        judge(&all, place_name(k), mean.mean, f.mean, hypot(mean_error(&mean), f.error));
    }
}

/* What is not random is there in full: f1 is the least that f can be, and often all. */
static void walk_lobe_has_exact_single_scattering(void **state) {
    (void)state;
    for (int k = 0; k < PLACES; k++) {
        Lobe lobe = lobe_at_place(k);
        uint64_t stream = stream_start(12, 0);
        int alone = 0;
        for (int n = 0; n < 1000; n++) {
            Dir o = near(places[k][4], 0.0, &stream), i = near(places[k][5], places[k][6], &stream);
            float f = lobe_eval(&lobe, angles_between(o, i)), g = lobe_eval(&lobe, angles_between(i, o));
            float one = flake_single(lobe.params[0] * lobe.params[0], flake_axis(lobe.params[2], lobe.params[3]),
                                     lobe.params[1], o, i);
            assert_true(f >= one && !(f < g || f > g));
            alone += !(f > one);
        }
        assert_true(alone > 0 && alone < 1000);
    }
}

/* E by walks alone, and by f and the samples of the lobe. */
static void albedo_of_the_walk_lobe_is_that_of_walks(void **state) {
    (void)state;
    for (int k = 0; k < PLACES; k++) {
        const int walks = 40000;
        Lobe lobe = lobe_at_place(k);
        WalkCount count = run(slab_at_place(k), places[k][4], 0.0, 1e5, NULL);
        WalkEstimate r = walk_share(count.reflected, count.walks);
        double w[3];
        set_direction(w, places[k][4], 0.0);
        Dir o = dir((float)w[0], (float)w[1], (float)w[2]);
        double e = (double)albedo_quadrature(&lobe, o, 4.0 / walks).f0;
        WalkEstimate own = walk_share(llround(e * walks), walks);
        judge(&all, place_name(k), e, r.mean, hypot(own.error, r.error));

        Mean mean = {0};
        uint64_t stream = stream_start(13, (uint64_t)k);
        while (mean.n < test_walks(1e5)) {
            float u = unit_float((uint32_t)(stream_next(&stream) >> 32));
            Dir i = lobe_sample(&lobe, o, u, unit_float((uint32_t)(stream_next(&stream) >> 32)));
            LobeValue v = {0};
            if (i.z > 0.0f) v = lobe_value(&lobe, angles_between(o, i));
            mean_add(&mean, i.z > 0.0f ? (double)(v.f * i.z / v.pdf) : 0.0);
        }
        print_message("%s: E %.4f, by samples %.4f +- %.4f, R %.4f +- %.4f\n", place_name(k), e, mean.mean,
                      mean_error(&mean), r.mean, r.error);
        judge(&all, place_name(k), mean.mean, r.mean, hypot(mean_error(&mean), r.error));
    }
}

/* Fibres that lean look different from there, and upright ones do not. */
static void walk_lobe_depends_on_azimuth_only_if_fibres_lean(void **state) {
    (void)state;
    double e[2][2];
    for (int leans = 0; leans < 2; leans++)
        for (int turned = 0; turned < 2; turned++) {
            Lobe lobe = lobe_at_place(0);
            lobe_set(&lobe, 2, leans ? 0.5f : 0.0f);
            lobe_set(&lobe, 3, turned ? 3.0f : 0.0f);
            e[leans][turned] = (double)albedo_quadrature(&lobe, dir(0.8f, 0.0f, 0.6f), 1e-4).f0;
        }
    assert_true(fabs(e[0][0] - e[0][1]) < 0.01 && e[1][1] > 2.0 * e[1][0]);
}

/* The table that layer rules read, off its nodes. */
static void albedo_table_of_the_walk_lobe_errs_by_its_noise(void **state) {
    (void)state;
    static AlbedoTable table;
    Lobe lobe = lobe_at_place(0);
    albedo_table_fill(&table, &lobe, 0.5f, 0.5f, 0);
    for (int k = 0; k < 6; k++) {
        double mu = 0.03 + 0.19 * k;
        WalkCount count = run(slab_at_place(0), mu, 0.0, 1e5, NULL);
        WalkEstimate r = walk_share(count.reflected, count.walks);
        double e = (double)table_albedo(albedo_table_ref(&table), (float)mu, 0.5f);
        judge(&all, "table", e, r.mean, hypot(r.error, 0.0025));
    }
}

static int end(void **state) {
    (void)state;
    judge_print(&all);
    return 0;
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(mean_of_random_f_is_f_of_walks),
        cmocka_unit_test(walk_lobe_has_exact_single_scattering),
        cmocka_unit_test(albedo_of_the_walk_lobe_is_that_of_walks),
        cmocka_unit_test(walk_lobe_depends_on_azimuth_only_if_fibres_lean),
        cmocka_unit_test(albedo_table_of_the_walk_lobe_errs_by_its_noise),
    };
    return cmocka_run_group_tests(tests, NULL, end);
}
