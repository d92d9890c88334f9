/* The layer rules as formulas: what each leaves of the base, between themselves and against conservation */
#include "cases.h"
#include "shading/layers/additive.h"
#include "shading/layers/albedo_half.h"
#include "shading/layers/albedo_max.h"
#include "shading/layers/albedo_min.h"
#include "shading/layers/albedo_view.h"
#include "shading/layers/multiplicative.h"
#include "shading/layers/reciprocal.h"
#include "shading/layers/seed.h"
#include "shading/layers/side_by_side.h"
#include "shading/layers/stochastic.h"

enum { ADDITIVE, MULTIPLICATIVE, SEED, SIDE, VIEW, MAX, MIN, RECIPROCAL, STOCHASTIC, HALF, RULES };

static float rule_base(int rule, float c, float e_o, float e_i, float e_avg) {
    switch (rule) {
    case ADDITIVE: return additive_base(c, e_o, e_i, e_avg);
    case MULTIPLICATIVE: return multiplicative_base(c, e_o, e_i, e_avg);
    case SEED: return seed_base(c, e_o, e_i, e_avg);
    case SIDE: return side_by_side_base(c, e_o, e_i, e_avg);
    case VIEW: return albedo_view_base(c, e_o, e_i, e_avg);
    case MAX: return albedo_max_base(c, e_o, e_i, e_avg);
    case MIN: return albedo_min_base(c, e_o, e_i, e_avg);
    case RECIPROCAL: return reciprocal_base(c, e_o, e_i, e_avg);
    case HALF: return albedo_half_base(c, e_o, e_i, e_avg); /* e_i: that towards h */
    default: return stochastic_base(c, e_o, e_i, e_avg);
    }
}

static const char *const rule_names[RULES] = {"additive",    "multiplicative", "seed",       "side-by-side",
                                              "albedo-view", "albedo-max",     "albedo-min", "reciprocal",
                                              "stochastic",  "albedo-half"};

/* A sheen's E(mu) to calculate with: dark in front, bright at the rim. */
static double sheen_e(double mu) { return 0.04 + 0.86 * (1.0 - mu) * (1.0 - mu) * (1.0 - mu); }
static const double sheen_average = 0.04 + 0.86 * 2.0 / 20.0; /* 2 B(2, 4) = 1/10 */

/* Weights of Simpson's rule on [0, 1]. */
enum { STEPS = 400 };
static double simpson(int k) { return (k == 0 || k == STEPS ? 1.0 : k % 2 ? 4.0 : 2.0) / (3.0 * STEPS); }

/* What a base of constant 1 / pi, times the rule, reflects towards mu_o. */
static double base_albedo(int rule, double c, double mu_o) {
    double sum = 0.0;
    for (int k = 0; k <= STEPS; k++) {
        /* two pieces, split at mu_o: max and min have a kink there */
        double x = (double)k / STEPS, low = mu_o * x, high = mu_o + (1.0 - mu_o) * x;
        double f_low =
            (double)rule_base(rule, (float)c, (float)sheen_e(mu_o), (float)sheen_e(low), (float)sheen_average);
        double f_high =
            (double)rule_base(rule, (float)c, (float)sheen_e(mu_o), (float)sheen_e(high), (float)sheen_average);
        sum += simpson(k) * 2.0 * (f_low * low * mu_o + f_high * high * (1.0 - mu_o));
    }
    return sum;
}

static void energy_of_layer_rules_is_as_stated(void **state) {
    (void)state;
    double average = 0.0, most[RULES] = {0}, least[RULES] = {9, 9, 9, 9, 9, 9, 9, 9, 9, 9};
    for (int k = 0; k <= STEPS; k++) average += simpson(k) * 2.0 * sheen_e((double)k / STEPS) * k / STEPS;
    assert_true(fabs(average - sheen_average) < 1e-9);
    for (int n = 0; n < 100; n++) {
        double mu = (n % 10 + 0.5) / 10.0, c = (n / 10 + 1) / 10.0, e = sheen_e(mu);
        for (int rule = 0; rule < RULES; rule++) {
            double sheen = rule == MULTIPLICATIVE ? 0.0 : rule == SEED || rule == SIDE ? c : c * e;
            double all = sheen + base_albedo(rule, c, mu);
            most[rule] = fmax(most[rule], all);
            least[rule] = fmin(least[rule], all);
        }
        assert_true(fabs(base_albedo(ADDITIVE, c, mu) - 1.0) < 1e-6);
        assert_true(fabs(base_albedo(MULTIPLICATIVE, c, mu) - 1.0 - c * e) < 1e-6);
        /* beside a sheen whose E is 1 */
        assert_true(fabs(base_albedo(SEED, c, mu) - 1.0 + c) < 1e-6);
        assert_true(fabs(base_albedo(SIDE, c, mu) - 1.0 + c) < 1e-6);
        assert_true(fabs(base_albedo(VIEW, c, mu) - 1.0 + c * e) < 1e-6);
        assert_true(fabs(base_albedo(RECIPROCAL, c, mu) - 1.0 + c * e) < 1e-6);
        /* one pass, and all bounces between the sheen's underside and a Lambert base of colour rho */
        double rho = 0.3 + 0.07 * (n % 10), once = rho * base_albedo(STOCHASTIC, c, mu), all = 0.0, more = once;
        for (int bounce = 0; bounce < 200; bounce++, more *= rho * c * sheen_average) all += more;
        assert_true(fabs(all - rho * (1.0 - c * e) * (1.0 - c * sheen_average) / (1.0 - rho * c * sheen_average)) <
                    1e-6);
        assert_true(all < 1.0 - c * e + 1e-6);
    }
    for (int rule = 0; rule < RULES; rule++)
        print_message("%-15s over a white base: E from %.4f to %.4f\n", rule_names[rule], least[rule], most[rule]);
    assert_true(most[MAX] < 1.0 + 1e-6 && least[MAX] < 0.99);
    assert_true(least[MIN] > 1.0 - 1e-6 && most[MIN] > 1.1);
    assert_true(most[STOCHASTIC] < 1.0);
}

static void layer_rules_agree_for_equal_albedos(void **state) {
    (void)state;
    Random random = {51};
    for (int n = 0; n < 100000; n++) {
        float c = random_unit(&random), e = random_unit(&random), avg = random_unit(&random);
        float view = albedo_view_base(c, e, e, avg);
        assert_float_equal(albedo_max_base(c, e, e, avg), view, 0.0f);
        assert_float_equal(albedo_min_base(c, e, e, avg), view, 0.0f);
        assert_float_equal(stochastic_base(c, e, e, avg), (view * view), 1e-6f);
        /* a sheen that is the same everywhere is its own average */
        if (c * e < 0.99f) assert_float_equal(reciprocal_base(c, e, e, e), view, 1e-5f);
        /* a black sheen leaves all, whatever its albedo */
        for (int rule = 0; rule < RULES; rule++) assert_float_equal(rule_base(rule, 0.0f, e, avg, e), 1.0f, 0.0f);
    }
}

static void layer_rules_are_reciprocal_as_claimed(void **state) {
    (void)state;
    Random random = {52};
    float worst[RULES] = {0};
    for (int n = 0; n < 100000; n++) {
        float c = random_unit(&random), a = random_unit(&random), b = random_unit(&random), avg = random_unit(&random);
        for (int rule = 0; rule < RULES; rule++)
            worst[rule] = max(worst[rule],
                              fabsf(rule_base(rule, c, a, b, avg) - rule_base(rule, c, b, rule == HALF ? b : a, avg)));
    }
    for (int rule = 0; rule < RULES; rule++)
        if (rule == VIEW || rule == MULTIPLICATIVE)
            assert_true(worst[rule] > 0.9f);
        else
            assert_float_equal(worst[rule], 0.0f, 0.0f);
}

/* Also for colours and albedos beyond 1, which Charlie and a user can ask for. */
static void layer_rules_are_neither_negative_nor_unbounded(void **state) {
    (void)state;
    static const float wild[] = {0.0f, 1e-30f, 0.5f, 0.99f, 1.0f, 1.0000001f, 2.0f, 6.0f, 1000.0f};
    enum { WILD = sizeof wild / sizeof wild[0] };
    for (int n = 0; n < WILD * WILD * WILD * WILD; n++) {
        float c = wild[n % WILD], e_o = wild[n / WILD % WILD], e_i = wild[n / WILD / WILD % WILD];
        float avg = wild[n / WILD / WILD / WILD];
        for (int rule = 0; rule < RULES; rule++) {
            float base = rule_base(rule, c, e_o, e_i, avg);
            float bound = rule == MULTIPLICATIVE ? 1.0f + c * e_o : rule == RECIPROCAL ? 100.0f : 1.0f;
            if (!(base >= 0.0f && base <= bound * 1.000001f))
                fail_msg("%s: c %g e_o %g e_i %g e_avg %g leave %g", rule_names[rule], (double)c, (double)e_o,
                         (double)e_i, (double)avg, (double)base);
        }
        float low = albedo_max_base(c, e_o, e_i, avg), high = albedo_min_base(c, e_o, e_i, avg);
        float view = albedo_view_base(c, e_o, e_i, avg), pass = stochastic_base(c, e_o, e_i, avg);
        assert_true(low <= view && view <= high && pass <= low);
    }
    /* two factors below zero do not make one above */
    assert_float_equal(reciprocal_base(1.0f, 2.0f, 3.0f, 0.2f), 0.0f, 0.0f);
    assert_float_equal(stochastic_base(1.0f, 2.0f, 3.0f, 0.2f), 0.0f, 0.0f);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(energy_of_layer_rules_is_as_stated),
        cmocka_unit_test(layer_rules_agree_for_equal_albedos),
        cmocka_unit_test(layer_rules_are_reciprocal_as_claimed),
        cmocka_unit_test(layer_rules_are_neither_negative_nor_unbounded),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
