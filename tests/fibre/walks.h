/* walks.h - what the tests of walks share: descriptions of slabs, and judging an estimate by its error
 *
 * Include it after <math.h> and cmocka. */
#ifndef WEFT_TEST_FIBRE_WALKS_H
#define WEFT_TEST_FIBRE_WALKS_H

#include <stdio.h>
#include <stdlib.h>

#include "base/pi.h"
#include "fibre/walk.h"

/* WEFT_TEST_SHORT=1 (sanitizers) asks for a tenth of the walks, WEFT_TEST_LONG=1 for ten times as many. */
static inline long long test_walks(double walks) {
    const char *few = getenv("WEFT_TEST_SHORT"), *many = getenv("WEFT_TEST_LONG");
    if (few && few[0] == '1') walks /= 10.0;
    if (many && many[0] == '1') walks *= 10.0;
    return (long long)walks;
}

/* Estimates of runs with one seed err together; each run here takes another. */
static inline uint64_t next_seed(void) {
    static uint64_t seed;
    return ++seed;
}

/* A direction by its cosine and azimuth in radians. */
static inline void set_direction(double w[3], double mu, double phi) {
    double r = (sqrt)(1.0 - mu * mu);
    w[0] = r * (cos)(phi), w[1] = r * (sin)(phi), w[2] = mu;
}

static inline WalkDesc slab(double alpha, double thickness, double albedo, double tilt) {
    return (WalkDesc){.alpha = alpha, .thickness = thickness, .albedo = albedo, .tilt = tilt, .seed = next_seed()};
}

static inline WalkCount run(WalkDesc desc, double mu, double phi, double walks, WalkEstimate *f) {
    WalkCount count;
    set_direction(desc.wo, mu, phi);
    desc.walks = test_walks(walks);
    assert_true(walk_run(&desc, &count, f));
    return count;
}

/* Two-sided tests of 1 % together, Sidak-corrected over the JUDGEMENTS that a program may make: the quantile
 * of the normal distribution for 1 - 0.99^(1 / JUDGEMENTS), by bisection. */
enum { JUDGEMENTS = 200 };
typedef struct Judge {
    int made;
    double limit, worst, squares;
} Judge;

static inline double judge_limit(void) {
    double p = 1.0 - (pow)(0.99, 1.0 / JUDGEMENTS), low = 0.0, high = 10.0;
    while (high - low > 1e-6) {
        double middle = 0.5 * (low + high);
        if (erfc(middle / (sqrt)(2.0)) > p)
            low = middle;
        else
            high = middle;
    }
    return high;
}

/* Whether two numbers are `error` standard deviations apart that chance explains. */
static inline void judge(Judge *judge, const char *what, double found, double reference, double error) {
    double z = (found - reference) / error;
    if (judge->limit <= 0.0) judge->limit = judge_limit();
    judge->squares += z * z;
    if (fabs(z) > judge->worst) judge->worst = fabs(z);
    if (++judge->made > JUDGEMENTS) fail_msg("raise JUDGEMENTS");
    if (!(fabs(z) < judge->limit))
        fail_msg("%s: %.6f, not %.6f: %.2f standard errors, the limit is %.2f", what, found, reference, z,
                 judge->limit);
}

static inline void judge_print(const Judge *judge) {
    print_message("%d judgements: |z| at most %.2f, rms %.2f\n", judge->made, judge->worst,
                  (sqrt)(judge->squares / judge->made));
}

#endif
