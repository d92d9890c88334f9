/* The dialect's own functions against double precision, and the warps against their densities */
#include "cases.h"
#include "shading/dialect/warp.h"
#include "shading/terms/d_charlie.h"
#include "shading/terms/d_ggx.h"

static void log2_has_the_stated_error(void **state) {
    (void)state;
    double absolute = 0.0, relative = 0.0;
    for (int n = 0; n < 2000000; n++) {
        /* all normal exponents, and densely about 1, where the result vanishes */
        double x = n % 2 ? (pow)(2.0, -125.9 + 253.0 * n / 2e6) : (pow)(2.0, -1.0 + 2.0 * n / 2e6);
        float f = (float)x;
        double exact = (log2)((double)f), d = fabs((double)weft_log2(f) - exact);
        absolute = fmax(absolute, d / fmax(fabs(exact), 1.0));
        if (exact < 0.0 || exact > 0.0) relative = fmax(relative, d / fabs(exact));
    }
    print_message("log2: error %.2e of max(1, |log2 x|), relative %.2e\n", absolute, relative);
    assert_true(absolute < 1.6e-7 && relative < 3.1e-7);
    assert_true(!(weft_log2(1.0f) != 0.0f));
}

static void exp2_has_the_stated_relative_error(void **state) {
    (void)state;
    double relative = 0.0;
    for (int n = 0; n < 2000000; n++) {
        float x = (float)(-126.0 + 253.0 * n / 2e6);
        double exact = (exp2)((double)x);
        relative = fmax(relative, fabs((double)weft_exp2(x) - exact) / exact);
    }
    print_message("exp2: relative error %.2e\n", relative);
    assert_true(relative < 1e-7);
    assert_true(!(weft_exp2(0.0f) != 1.0f) && !(weft_exp2(1.0f) != 2.0f));
    /* clamped to the normal floats, never 0, infinity or NaN */
    assert_true(!(weft_exp2(-1e30f) != 0x1p-126f) && !(weft_exp2(1e30f) != 0x1p127f));
}

/* Relative error of x^y grows with y, as the comment in lang.h says, and not with log2 x. */
static void pow_has_the_stated_relative_error(void **state) {
    (void)state;
    Random random = {31};
    double worst = 0.0;
    for (int n = 0; n < 1000000; n++) {
        float x = (float)(pow)(10.0, -7.0 * (double)random_unit(&random));
        float y = (float)(pow)(10.0, -1.0 + 3.0 * (double)random_unit(&random));
        double l = (double)y * (log2)((double)x);
        if (l < -125.0) continue;
        double exact = (pow)((double)x, (double)y), d = fabs((double)pow(x, y) - exact) / exact;
        worst = fmax(worst, d / (1.0 + (double)y));
    }
    print_message("pow: relative error %.2e (1 + y)\n", worst);
    assert_true(worst < 1.3e-7);
}

/* Whole turns are taken off in three parts, of which the first two are exact up to 2^12. */
static void sin_and_cos_are_right_to_the_last_digits(void **state) {
    (void)state;
    double worst = 0.0, far = 0.0;
    for (int n = -2000000; n <= 2000000; n++) {
        float x = (float)(8.0 * n / 2e6), y = (float)(4096.0 * n / 2e6);
        worst = fmax(worst, fabs((double)sin(x) - (sin)((double)x)));
        worst = fmax(worst, fabs((double)cos(x) - (cos)((double)x)));
        far = fmax(far, fabs((double)sin(y) - (sin)((double)y)));
        far = fmax(far, fabs((double)cos(y) - (cos)((double)y)));
    }
    print_message("sin, cos: error %.2e to 8, %.2e to 4096\n", worst, far);
    assert_true(worst < 1e-7 && far < 1e-7);
    assert_true(!(sin(0.0f) != 0.0f) && !(cos(0.0f) != 1.0f));
}

/* ---- whole lobes over arrays, against the formulae of their papers --------------------------------- */

static double lerp(double a, double b, double t) { return a + (b - a) * t; }

/* Conty Estevez and Kulla 2017, Table 1 and Equation 3 */
static double conty_kulla_l_double(double alpha, double x) {
    double t = (1.0 - alpha) * (1.0 - alpha), power = (pow)(x, lerp(0.19823, 0.16801, t));
    return lerp(21.5473, 25.3245, t) / (1.0 + lerp(3.82987, 3.32435, t) * power) + lerp(-1.97760, -1.27393, t) * x +
           lerp(-4.32054, -4.85967, t);
}

static double conty_kulla_lambda_double(double alpha, double x) {
    if (x < 0.5) return (exp)(conty_kulla_l_double(alpha, x));
    return (exp)(2.0 * conty_kulla_l_double(alpha, 0.5) - conty_kulla_l_double(alpha, 1.0 - x));
}

/* Equation 2 there, over either denominator; o and i as rounded to float. */
static double charlie_double(int id, double alpha, Dir o, Dir i) {
    double oz = (double)o.z, iz = (double)i.z;
    double x = (double)o.x + (double)i.x, y = (double)o.y + (double)i.y, z = oz + iz;
    double d = (2.0 + 1.0 / alpha) * (pow)((x * x + y * y) / (x * x + y * y + z * z), 0.5 / alpha) / (2.0 * PI_DOUBLE);
    if (id == LOBE_CHARLIE_NEUBELT) return d / (4.0 * (oz + iz - oz * iz));
    double lambda = conty_kulla_lambda_double(alpha, oz) + conty_kulla_lambda_double(alpha, iz);
    return d / ((1.0 + lambda) * 4.0 * fmax(oz * iz, 1e-7));
}

static void arrays_of_charlie_are_near_double_precision(void **state) {
    (void)state;
    enum { BLOCK = 4096 };
    static float ox[BLOCK], oy[BLOCK], oz[BLOCK], ix[BLOCK], iy[BLOCK], iz[BLOCK], f[BLOCK];
    static const int ids[] = {LOBE_CHARLIE_NEUBELT, LOBE_CHARLIE_CONTY_KULLA};
    Random random = {41};
    /* of conty-kulla an exponential enlarges every rounding, and more of them without a fused multiply-add */
    bool fused = true;
#if defined(__x86_64__) && !defined(__FMA__)
    fused = __builtin_cpu_supports("fma") && !test_short();
#endif
    for (int l = 0; l < 2; l++) {
        double worst = 0.0, worst_alpha = 0.0;
        for (int n = 0; n < (test_short() ? 20 : 200); n++) {
            Lobe lobe = lobe_default(ids[l]);
            lobe.params[0] = n == 0 ? 0.15f : 0.15f + 0.85f * random_unit(&random);
            for (int k = 0; k < BLOCK; k++) {
                Dir o = random_direction(&random), i = random_direction(&random);
                ox[k] = o.x, oy[k] = o.y, oz[k] = o.z, ix[k] = i.x, iy[k] = i.y, iz[k] = i.z;
            }
            lobe_eval_n(&lobe, BLOCK, ox, oy, oz, ix, iy, iz, f, NULL);
            for (int k = 0; k < BLOCK; k++) {
                double exact =
                    charlie_double(ids[l], (double)lobe.params[0], dir(ox[k], oy[k], oz[k]), dir(ix[k], iy[k], iz[k]));
                double d = fabs((double)f[k] / exact - 1.0);
                if (d > worst) worst = d, worst_alpha = (double)lobe.params[0];
            }
        }
        print_message("%s: relative error %.2e, at alpha %.3f\n", weft_lobe_info(ids[l])->id, worst, worst_alpha);
        assert_true(worst < (ids[l] == LOBE_CHARLIE_NEUBELT ? 2e-6 : fused ? 2.5e-6 : 3.5e-6));
    }
}

static void mix_and_clamp_are_those_of_glsl(void **state) {
    (void)state;
    assert_float_equal(mix(2.0f, 4.0f, 0.25f), 2.5f, 1e-7f);
    assert_true(!(mix(2.0f, 4.0f, 0.0f) != 2.0f));
    assert_float_equal(clamp(3.0f, 0.0f, 1.0f), 1.0f, 0.0f);
    assert_float_equal(clamp(-3.0f, 0.0f, 1.0f), 0.0f, 0.0f);
    assert_float_equal(exp(1.0f), 2.71828183f, 1e-6f);
}

/* A warp and its density: as many points fall under each ring as the density says. */
static void check_warp(Dir (*warp)(float, float), float (*density)(Dir)) {
    enum { RINGS = 32, SIDE = 512 };
    double counts[RINGS] = {0};
    for (int j = 0; j < SIDE; j++)
        for (int k = 0; k < SIDE; k++) {
            Dir w = warp(((float)j + 0.5f) / SIDE, ((float)k + 0.5f) / SIDE);
            assert_float_equal(w.x * w.x + w.y * w.y + w.z * w.z, 1.0f, 1e-6f);
            assert_true(w.z > 0.0f);
            int ring = (int)((double)w.z * RINGS);
            counts[ring < RINGS ? ring : RINGS - 1] += 1.0 / ((double)SIDE * SIDE);
        }
    for (int ring = 0; ring < RINGS; ring++) {
        double z = (ring + 0.5) / RINGS;
        double share = (double)density(direction_cos(z, 1.0)) * 2.0 * PI_DOUBLE / RINGS;
        assert_true(fabs(counts[ring] - share) < 4e-3);
    }
}

static Dir cosine(float u, float v) { return warp_cosine(u, v); }
static float cosine_pdf(Dir w) { return warp_cosine_pdf(w); }
static Dir uniform(float u, float v) { return warp_uniform(u, v); }
static float uniform_pdf(Dir w) { return warp_uniform_pdf(w); }

static void warped_samples_follow_their_densities(void **state) {
    (void)state;
    check_warp(cosine, cosine_pdf);
    check_warp(uniform, uniform_pdf);
    Dir below = dir(0.6f, 0.0f, -0.8f);
    assert_true(!(warp_cosine_pdf(below) != 0.0f) && !(warp_uniform_pdf(below) != 0.0f));
}

static void half_vector_is_unit_and_between_its_directions(void **state) {
    (void)state;
    Random random = {13};
    for (int n = 0; n < 200000; n++) {
        Dir o = random_direction(&random), i = random_direction(&random);
        Angles a = angles_between(o, i);
        assert_float_equal(dir_dot(a.h, a.h), 1.0f, 1e-6f);
        assert_float_equal(a.d, dir_dot(o, a.h), 2e-6f);
        assert_true(a.h.z > 0.0f);
        Dir m = dir_mirror(o, a.h);
        assert_float_equal(m.x, i.x, 3e-6f);
        assert_float_equal(m.z, i.z, 3e-6f);
    }
    Angles opposite = angles_between(dir(1.0f, 0.0f, 0.0f), dir(-1.0f, 0.0f, 0.0f));
    assert_float_equal(dir_dot(opposite.h, opposite.h), 1.0f, 1e-6f);
    assert_true(opposite.d > 0.0f);
}

/* Microfacet normals are upper, unit, and seen from wo, so that wi is wo mirrored and never behind a facet.
 */
static void sampled_facet_normals_are_visible(void **state) {
    (void)state;
    Random random = {14};
    for (int n = 0; n < 300000; n++) {
        float alpha = (float)(pow)(10.0, -3.0 + 3.5 * (double)random_unit(&random));
        float ax = n % 2 ? alpha : (float)(pow)(10.0, -3.0 + 3.0 * (double)random_unit(&random));
        Dir o = n % 3 ? random_direction(&random) : direction_cos((pow)(10.0, -7.0 * (double)random_unit(&random)), n);
        float u = random_unit(&random), v = random_unit(&random);
        Dir h = ggx_sample_h(ax, alpha, o, u, v);
        assert_true(h.z >= 0.0f);
        assert_float_equal(dir_dot(h, h), 1.0f, 1e-5f);
        assert_true(dir_dot(o, h) > -1e-5f);
        h = charlie_sample_h(charlie_of(max(alpha, 0.005f)), charlie_side(o), u, v);
        assert_true(h.z >= 0.0f);
        assert_float_equal(dir_dot(h, h), 1.0f, 1e-5f);
        assert_true(dir_dot(o, h) > -1e-6f);
    }
}

/* Both distributions: the integral of D cos_h is 1. */
static void d_of_the_dialect_is_normalised(void **state) {
    (void)state;
    static const float alphas[] = {0.01f, 0.05f, 0.25f, 0.6f, 1.0f};
    for (int k = 0; k < 5; k++) {
        double ggx = 0.0, charlie = 0.0;
        enum { STEPS = 20000 };
        for (int n = 0; n < STEPS; n++) {
            double t = stretch((n + 0.5) / STEPS), theta = t * PI_DOUBLE / 2.0;
            double w = stretch_slope((n + 0.5) / STEPS) / STEPS * PI_DOUBLE * PI_DOUBLE * (sin)(theta) * (cos)(theta);
            Dir h = direction(theta, 0.7);
            ggx += w * (double)ggx_d(alphas[k], alphas[k], h);
            charlie += w * (double)charlie_d(alphas[k], h);
        }
        assert_true(fabs(ggx - 1.0) < 2e-5);
        assert_true(fabs(charlie - 1.0) < 2e-5);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(log2_has_the_stated_error),
        cmocka_unit_test(exp2_has_the_stated_relative_error),
        cmocka_unit_test(pow_has_the_stated_relative_error),
        cmocka_unit_test(sin_and_cos_are_right_to_the_last_digits),
        cmocka_unit_test(arrays_of_charlie_are_near_double_precision),
        cmocka_unit_test(mix_and_clamp_are_those_of_glsl),
        cmocka_unit_test(warped_samples_follow_their_densities),
        cmocka_unit_test(half_vector_is_unit_and_between_its_directions),
        cmocka_unit_test(sampled_facet_normals_are_visible),
        cmocka_unit_test(d_of_the_dialect_is_normalised),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
