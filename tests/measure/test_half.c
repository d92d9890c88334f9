/* The half face rounds every value and operation to 16 bits: against lobes worked out here in single
 * precision, rounded by hand after every step, without the compiler's own half floats */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/pi.h"
#include "measure/check/half_floor.h"
#include "measure/check/half_precision.h"
#include "measure/check/sweep.h"
#include "weft/lobe.h"

/* x to the nearest number of 11 significant bits, ties to even; 2^-24 is the least there is. */
static float h(float x) {
    int e;
    frexpf(x, &e);
    float unit = ldexpf(1.0f, (e < -13 ? -13 : e) - 11), r = rintf(x / unit) * unit;
    return fabsf(r) > 65504.0f ? copysignf(HUGE_VALF, x) : r;
}

typedef struct Pair {
    float o[3], i[3];
} Pair;

static Pair pair(double cos_o, double cos_i, double phi) {
    double s_o = (sqrt)(1.0 - cos_o * cos_o), s_i = (sqrt)(1.0 - cos_i * cos_i);
    return (Pair){{(float)s_o, 0.0f, (float)cos_o},
                  {(float)(s_i * (cos)(phi)), (float)(s_i * (sin)(phi)), (float)cos_i}};
}

static float ask(const char *id, const float *params, Pair p) {
    float f;
    half_eval(weft_lobe_find(id), params, 1, &p.o[0], &p.o[1], &p.o[2], &p.i[0], &p.i[1], &p.i[2], &f);
    return f;
}

static Pair rounded(Pair p) {
    for (int k = 0; k < 3; k++) p.o[k] = h(p.o[k]), p.i[k] = h(p.i[k]);
    return p;
}

/* |wo + wi|, and the sum's components in v. */
static float sum_length(Pair p, float v[3]) {
    for (int k = 0; k < 3; k++) v[k] = h(p.o[k] + p.i[k]);
    return h(sqrtf(h(h(h(v[0] * v[0]) + h(v[1] * v[1])) + h(v[2] * v[2]))));
}

static const double angles[][3] = {{1.0, 1.0, 0.0},  {0.9, 0.3, 0.5},   {0.5, 0.5, 3.1}, {0.2, 0.7, 1.7},
                                   {0.05, 0.9, 2.6}, {0.01, 0.02, 3.0}, {0.6, 0.1, 0.0}};
enum { ANGLES = sizeof angles / sizeof angles[0] };

#define SKIP_WITHOUT_HALF()                                                                                            \
    if (!half_here()) {                                                                                                \
        print_message("this compiler has no half floats\n");                                                           \
        skip();                                                                                                        \
    }

static void emulated_rounding_is_that_of_half_floats(void **state) {
    (void)state;
    assert_true(h(1.0f) == 1.0f && h(65504.0f) == 65504.0f);
    assert_true(isinf(h(65520.0f)) && h(65519.0f) == 65504.0f);
    assert_true(h(2049.0f) == 2048.0f && h(2051.0f) == 2052.0f);      /* ties to even */
    assert_true(h(0x1p-24f) == 0x1p-24f && h(0x1p-26f) == 0.0f);      /* the least, and less */
    assert_true(h(0.1f) == 0.0999755859375f && h(-0.1f) == -h(0.1f)); /* 0x2e66 */
}

static void half_precision_lambert_is_one_over_pi(void **state) {
    (void)state;
    SKIP_WITHOUT_HALF()
    float got = ask("lambert", NULL, pair(0.3, 0.4, 1.0));
    assert_true(got == h(1.0f / h(PI_FLOAT)));
    assert_true(got != 1.0f / PI_FLOAT);
}

/* (1 - d)^5, by squares, as terms/f_schlick.h has it; d = |wo + wi| / 2. */
static void burley_sheen_is_rounded_at_each_step(void **state) {
    (void)state;
    SKIP_WITHOUT_HALF()
    for (int k = 0; k < ANGLES; k++) {
        Pair p = pair(angles[k][0], angles[k][1], angles[k][2]);
        float v[3], d = h(0.5f * sum_length(rounded(p), v)), c = h(1.0f - d);
        c = c < 0.0f ? 0.0f : c > 1.0f ? 1.0f : c;
        float c2 = h(c * c), expected = h(h(c2 * c2) * c), got = ask("burley-sheen", NULL, p);
        if (got != expected) fail_msg("case %d: %.9g, not %.9g", k, (double)got, (double)expected);
    }
}

/* D V of charlie-neubelt with a power taken in single precision; alpha rounded first. */
static void charlie_neubelt_is_rounded_at_each_step(void **state) {
    (void)state;
    SKIP_WITHOUT_HALF()
    const float alpha = 0.3f, a = h(alpha), two_pi = h(2.0f * h(PI_FLOAT));
    for (int k = 0; k < ANGLES; k++) {
        Pair p = pair(angles[k][0], angles[k][1], angles[k][2]), q = rounded(p);
        float v[3];
        sum_length(q, v);
        float t2 = h(h(v[0] * v[0]) + h(v[1] * v[1])), s2 = h(t2 + h(v[2] * v[2])), sin2 = h(t2 / s2);
        float power = h(powf(sin2, h(0.5f / a)));
        float d = h(h(h(2.0f + h(1.0f / a)) / two_pi) * power), z = q.o[2], w = q.i[2];
        float expected = h(d * h(0.25f / h(h(z + w) - h(z * w))));
        float got = ask("charlie-neubelt", &alpha, p);
        if (got != expected) fail_msg("case %d: %.9g, not %.9g", k, (double)got, (double)expected);
    }
}

/* Floors such as 1e-30 are 0 there: the reason for the whole measurement. */
static void half_precision_floor_below_the_least_half_vanishes(void **state) {
    (void)state;
    SKIP_WITHOUT_HALF()
    WeftLobe lobe;
    float up[3] = {0.0f, 0.0f, 1.0f}, f[3];
    assert_int_equal(weft_lobe_init("ashikhmin-neubelt", &lobe, NULL), WEFT_OK);
    weft_lobe_eval(&lobe, up, up, f);
    assert_true(sweep_finite(f[0]));
    assert_false(sweep_finite(ask("ashikhmin-neubelt", lobe.params, pair(1.0, 1.0, 0.0))));
}

/* The floor that is found suits every row that it is said to suit; those below, none. */
static void half_precision_floor_is_the_smallest_that_holds(void **state) {
    (void)state;
    SKIP_WITHOUT_HALF()
    Bsdf bsdf;
    WeftPassport p = {0};
    Lobe lobe = lobe_default(weft_lobe_find("ggx"));
    lobe.params[0] = 0.2f;
    bsdf_of_lobe(&bsdf, &lobe, true);
    half_floor_measure(&bsdf, &p, 1);
    assert_true(p.half_measured && p.half_bad > 0 && p.half_bad < p.half_count);
    assert_in_range(p.half_cosine, WEFT_HALF_MOST, WEFT_HALF_FREE);
    assert_true(p.half_parameter > 0.01f && p.half_parameter < 0.3f);
    for (int row = 0; row < p.rows; row++)
        if (p.values[row] >= p.half_parameter)
            assert_true(p.half_floor[row] >= p.half_cosine);
        else
            assert_int_equal(p.half_floor[row], 0);
    assert_true(p.values[0] < p.half_parameter);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(emulated_rounding_is_that_of_half_floats),
        cmocka_unit_test(half_precision_lambert_is_one_over_pi),
        cmocka_unit_test(burley_sheen_is_rounded_at_each_step),
        cmocka_unit_test(charlie_neubelt_is_rounded_at_each_step),
        cmocka_unit_test(half_precision_floor_below_the_least_half_vanishes),
        cmocka_unit_test(half_precision_floor_is_the_smallest_that_holds),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
