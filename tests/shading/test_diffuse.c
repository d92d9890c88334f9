/* The diffuse lobes against their papers in double precision; their energy, closed forms, and the figures
 * their headers state */
#include "cases.h"
#include "shading/catalogue/albedo.h"

static const double unit_pi = PI_DOUBLE;

/* A pair of directions as a paper sees it. */
typedef struct Pair {
    double theta_o, theta_i, phi, d; /* phi between both azimuths, d the cosine between wi and the half vector */
} Pair;

static Pair pair_of(Dir o, Dir i) {
    double ox = (double)o.x, oy = (double)o.y, oz = (double)o.z;
    double ix = (double)i.x, iy = (double)i.y, iz = (double)i.z;
    Pair p;
    p.theta_o = atan2(hypot(ox, oy), oz);
    p.theta_i = atan2(hypot(ix, iy), iz);
    p.phi = atan2(oy, ox) - atan2(iy, ix);
    p.d = (sqrt)(fmax(0.5 * (1.0 + ox * ix + oy * iy + oz * iz), 0.0));
    return p;
}

/* Burley 2012: retro-reflection by mixing towards fd90 with Schlick's weights. */
static double schlick_mix(double f90, double theta) { return 1.0 + (f90 - 1.0) * (pow)(1.0 - (cos)(theta), 5.0); }

static double paper_burley(Pair p, double roughness) {
    double fd90 = 0.5 + 2.0 * p.d * p.d * roughness;
    return schlick_mix(fd90, p.theta_i) * schlick_mix(fd90, p.theta_o) / unit_pi;
}

static double paper_burley_subsurface(Pair p, double roughness) {
    double fss90 = p.d * p.d * roughness, fss = schlick_mix(fss90, p.theta_i) * schlick_mix(fss90, p.theta_o);
    return 1.25 / unit_pi * (fss * (1.0 / ((cos)(p.theta_i) + (cos)(p.theta_o)) - 0.5) + 0.5);
}

/* Oren and Nayar 1994, Equation 30, with its angles. */
static double paper_oren_nayar(Pair p, double sigma) {
    double s2 = sigma * sigma, a = 1.0 - 0.5 * s2 / (s2 + 0.33), b = 0.45 * s2 / (s2 + 0.09);
    double alpha = fmax(p.theta_i, p.theta_o), beta = fmin(p.theta_i, p.theta_o);
    return (a + b * fmax(0.0, (cos)(p.phi)) * (sin)(alpha)*tan(beta)) / unit_pi;
}

static double paper_fabric_lambert(Pair p, double roughness) { return (1.0 - 0.5 * roughness) / unit_pi; }

static double paper_wrap(Pair p, double w) {
    double c = fmax((cos)(p.theta_i), 1e-6); /* the lobe's floor */
    return (c + w) / ((1.0 + w) * (1.0 + w)) / unit_pi / c;
}

/* Portsmouth, Kutz, Hill 2025: the albedo of the first bounce, the average, and the whole for a colour rho.
 */
static double eon_c1(void) { return 0.5 - 2.0 / (3.0 * unit_pi); }

static double eon_albedo(double theta, double r) {
    double s = (sin)(theta), g = s * (theta - s * (cos)(theta));
    g += 2.0 / 3.0 * (tan(theta) * (1.0 - s * s * s) - s);
    return (1.0 + r / unit_pi * g) / (1.0 + eon_c1() * r);
}

static double eon_average(double r) { return (1.0 + (2.0 / 3.0 - 28.0 / (15.0 * unit_pi)) * r) / (1.0 + eon_c1() * r); }

static double eon_color(double rho, double r) {
    double average = eon_average(r);
    return rho * rho * average / (1.0 - rho * (1.0 - average));
}

static double paper_eon(Pair p, double r, double rho) {
    double s = (sin)(p.theta_o) * (sin)(p.theta_i) * (cos)(p.phi);
    double t = s > 0.0 ? fmax((cos)(p.theta_o), (cos)(p.theta_i)) : 1.0;
    double first = rho / unit_pi * (1.0 + r * s / t) / (1.0 + eon_c1() * r);
    double lost = (1.0 - eon_albedo(p.theta_o, r)) * (1.0 - eon_albedo(p.theta_i, r));
    return first + (r > 0.0 ? eon_color(rho, r) / unit_pi * lost / (1.0 - eon_average(r)) : 0.0);
}

static const char *const names[] = {"burley", "burley-subsurface", "oren-nayar", "fabric-lambert", "wrap"};
static double (*const papers[])(Pair, double) = {paper_burley, paper_burley_subsurface, paper_oren_nayar,
                                                 paper_fabric_lambert, paper_wrap};
enum { NAMES = sizeof names / sizeof names[0], PAIRS = 200000 };

static Lobe lobe_with(const char *id, float value) {
    int k = weft_lobe_find(id);
    assert_true(k >= 0);
    Lobe lobe = lobe_default(k);
    lobe_set(&lobe, 0, value);
    return lobe;
}

/* Body of its own header, where limb and lift are as free as the peak. */
static double paper_body(Pair p, const float *n) {
    double k = (double)n[0], x = k * (3.0 + k) / ((1.0 + k) * (2.0 + k)), d = acos(fmin(p.d, 1.0));
    double lifted = k > 0.0 ? (pow)(x, k) / (2.0 + 2.0 * k) : 0.5;
    double norm =
        2.0 / (2.0 + k) * (1.0 + (double)n[1] * (0.34585 + 0.0733 * k - 0.0113 * k * k) + (double)n[2] * lifted);
    double body = 1.0 + (double)n[1] * (exp)(-tan(d) / 0.35) + (double)n[2] * (pow)((sin)(d), 2.0);
    return (pow)((cos)(p.theta_o) * (cos)(p.theta_i), k) * body / (unit_pi * norm);
}

static void body_follows_the_formula_of_its_header(void **state) {
    (void)state;
    Random random = {44};
    double worst = 0.0;
    for (int n = 0; n < PAIRS; n++) {
        Lobe lobe = lobe_with("body", random_unit(&random));
        lobe_set(&lobe, 1, 6.0f * random_unit(&random));
        lobe_set(&lobe, 2, 8.0f * random_unit(&random));
        Dir o = random_direction(&random), i = random_direction(&random);
        double exact = paper_body(pair_of(o, i), lobe.params);
        double d = fabs((double)lobe_eval(&lobe, angles_between(o, i)) - exact) / fmax(exact, 0.1);
        if (d > worst) worst = d;
        if (d > 1e-4) fail_msg("%s is %.3g off its header", case_name(&lobe, o).text, d);
    }
    print_message("%-18s within %.1e of its header\n", "body", worst);
}

static void diffuse_lobes_follow_the_formulas_of_their_papers(void **state) {
    (void)state;
    Random random = {41};
    for (int k = 0; k < NAMES; k++) {
        double worst = 0.0;
        for (int n = 0; n < PAIRS; n++) {
            float value = n % 8 ? random_unit(&random) : (float)(n / 8 % 2);
            Lobe lobe = lobe_with(names[k], value);
            Dir o = random_direction(&random), i = random_direction(&random);
            double exact = papers[k](pair_of(o, i), (double)value);
            double d = fabs((double)lobe_eval(&lobe, angles_between(o, i)) - exact) / fmax(exact, 0.1);
            if (d > worst) worst = d;
            if (d > 1e-4) fail_msg("%s is %.3g off its paper", case_name(&lobe, o).text, d);
        }
        print_message("%-18s within %.1e of its paper\n", names[k], worst);
    }
}

/* EON per colour: what a caller makes of eval, share and second colour. */
static void eon_follows_the_formula_of_its_paper(void **state) {
    (void)state;
    Random random = {42};
    double worst = 0.0;
    for (int n = 0; n < PAIRS; n++) {
        float value = n % 8 ? random_unit(&random) : (float)(n / 8 % 2), rho = random_unit(&random);
        Lobe lobe = lobe_with("eon", value);
        Dir o = random_direction(&random), i = random_direction(&random);
        WeftLobe open = {.lobe = (int)lobe.id, .params = {value}, .f0 = {rho, 1.0f, 0.0f}, .f90 = {0.3f, 0.0f, 9.0f}};
        float wo[3] = {o.x, o.y, o.z}, wi[3] = {i.x, i.y, i.z}, f[3];
        weft_lobe_eval(&open, wo, wi, f);
        double exact[3] = {paper_eon(pair_of(o, i), (double)value, (double)rho),
                           paper_eon(pair_of(o, i), (double)value, 1.0), 0.0};
        for (int c = 0; c < 3; c++) {
            double d = fabs((double)f[c] - exact[c]) / fmax(exact[c], 0.1);
            if (d > worst) worst = d;
            if (d > 1e-4) fail_msg("%s is %.3g off its paper", case_name(&lobe, o).text, d);
        }
    }
    print_message("%-18s within %.1e of its paper\n", "eon", worst);
}

/* E by a rule of this file: Simpson over theta_i and phi, split where the formulas have kinks (theta_i =
 * theta_o, phi = pi / 2), of every channel of weft_lobe_eval that f0 names. */
static double simpson_weight(int k, int n) { return (k == 0 || k == n ? 1.0 : k % 2 ? 4.0 : 2.0) / (3.0 * n); }

static double simpson_albedo(const WeftLobe *lobe, double theta_o, int n) {
    float wo[3] = {(float)(sin)(theta_o), 0.0f, (float)(cos)(theta_o)};
    double sum = 0.0;
    for (int piece = 0; piece < 4; piece++) {
        double from = piece / 2 ? theta_o : 0.0, to = piece / 2 ? unit_pi / 2.0 : theta_o;
        for (int j = 0; j <= n; j++) {
            /* squared towards the horizon, where E bends most */
            double x = (double)j / n,
                   theta = piece / 2 ? to - (to - from) * (1.0 - x) * (1.0 - x) : from + (to - from) * x;
            double slope = (to - from) * (piece / 2 ? 2.0 * (1.0 - x) : 1.0);
            for (int k = 0; k <= n; k++) {
                double phi = unit_pi / 2.0 * (piece % 2 + (double)k / n);
                float wi[3] = {(float)((sin)(theta) * (cos)(phi)), (float)((sin)(theta) * (sin)(phi)),
                               (float)fmax((cos)(theta), 1e-7)};
                float f[3];
                weft_lobe_eval(lobe, wo, wi, f);
                sum += simpson_weight(j, n) * simpson_weight(k, n) * slope * unit_pi * (double)f[0] *
                       (sin)(theta)*fmax((cos)(theta), 0.0);
            }
        }
    }
    return sum;
}

static void white_eon_returns_what_it_receives(void **state) {
    (void)state;
    double worst = 0.0, worst_color = 0.0;
    int steps = test_long() ? 400 : test_short() ? 40 : 64;
    for (int r = 0; r <= 10; r++)
        for (int c = 1; c <= 8; c++)
            for (int rho = 4; rho > 0; rho -= 2) {
                double theta = unit_pi / 2.0 * (c - 0.5) / 8.0, color = rho / 4.0,
                       roughness = (double)((float)r / 10.0f);
                WeftLobe eon = {.lobe = weft_lobe_find("eon"), .params = {(float)r / 10.0f}, .f0 = {(float)color}};
                double first = eon_albedo(theta, roughness);
                double exact = color * first + eon_color(color, roughness) * (1.0 - first);
                double d = fabs(simpson_albedo(&eon, theta, steps) - exact);
                if (rho == 4) {
                    assert_true(fabs(exact - 1.0) < 1e-12);
                    worst = fmax(worst, d);
                } else
                    worst_color = fmax(worst_color, d);
            }
    print_message("eon: 1 - E at most %.1e in white, %.1e off the closed form in grey\n", worst, worst_color);
    assert_true(worst < 2e-5 && worst_color < 2e-5);
}

/* The average that the second colour is made of is the average of the albedo. */
static void eon_average_albedo_is_the_integral(void **state) {
    (void)state;
    for (int r = 0; r <= 10; r++) {
        double sum = 0.0;
        for (int k = 0; k <= 1000; k++) {
            double theta = unit_pi / 2.0 * k / 1000.0;
            sum += simpson_weight(k, 1000) * unit_pi / 2.0 * (sin)(2.0 * theta) *
                   (k < 1000 ? eon_albedo(theta, r / 10.0) : 0.0);
        }
        assert_true(fabs(sum - eon_average(r / 10.0)) < 1e-9);
    }
    /* beyond 1 a colour has no series to sum: the second one stays finite and keeps growing */
    Lobe eon = lobe_with("eon", 1.0f);
    WeftLobe open = {.lobe = (int)eon.id, .params = {1.0f}, .f0 = {1.0f, 2.0f, 1000.0f}};
    float wo[3] = {0.0f, 0.0f, 1.0f}, f[3];
    weft_lobe_eval(&open, wo, wo, f);
    assert_true(f[0] < f[1] && f[1] < f[2] && f[2] < 1e7f);
}

/* E of Oren and Nayar's model: both integrals over theta_i in closed form. */
static void albedo_of_diffuse_lobes_equals_its_closed_form(void **state) {
    (void)state;
    for (int v = 0; v <= 10; v++)
        for (int c = 1; c <= 20; c++) {
            float value = (float)v / 10.0f, cos_o = (float)c / 20.5f, e[3];
            double w = (double)value, theta = acos((double)cos_o), s = (sin)(theta), s2 = w * w;
            double g = s * (theta - s * (cos)(theta)) + 2.0 / 3.0 * tan(theta) * (1.0 - s * s * s);
            double exact[3] = {1.0 - 0.5 * s2 / (s2 + 0.33) + 0.45 * s2 / (s2 + 0.09) * g / unit_pi, 1.0 - 0.5 * w,
                               (1.0 + 2.0 * w) / ((1.0 + w) * (1.0 + w))};
            WeftLobe lobe = {.lobe = weft_lobe_find("oren-nayar"), .params = {value}, .f0 = {1.0f}};
            assert_true(fabs(simpson_albedo(&lobe, theta, 40) - exact[0]) < 1e-4);
            for (int k = 1; k < 3; k++) {
                lobe.lobe = weft_lobe_find(k == 1 ? "fabric-lambert" : "wrap");
                weft_lobe_albedo(&lobe, cos_o, e);
                assert_true(fabs((double)e[0] - exact[k]) < 1e-5);
            }
        }
}

static double albedo(const char *id, float value, double cos_o) {
    Lobe lobe = lobe_with(id, value);
    Albedo e = albedo_quadrature(&lobe, direction_cos(cos_o, 0.3), 1e-6);
    return (double)(e.f0 + e.f90);
}

static double highest_albedo(const char *id, float value) {
    double highest = 0.0;
    for (int k = 0; k <= 60; k++) highest = fmax(highest, albedo(id, value, (pow)(10.0, -5.0 + k / 12.0)));
    return highest;
}

/* What the headers say. */
static void albedo_is_as_the_headers_state(void **state) {
    (void)state;
    assert_true(fabs(albedo("burley", 0.0f, 0.02) - 0.535) < 6e-4);
    assert_true(fabs(albedo("burley", 0.5f, 0.02) - 1.011) < 6e-4);
    assert_true(fabs(albedo("burley", 1.0f, 0.02) - 1.519) < 6e-4);
    assert_true(highest_albedo("burley", 0.40f) < 1.0 && highest_albedo("burley", 0.41f) > 1.0);
    assert_true(fabs(highest_albedo("burley-subsurface", 0.0f) - 1.211) < 6e-4);
    assert_true(fabs(albedo("burley-subsurface", 0.0f, 1.0) - 0.749) < 6e-4);
    assert_true(fabs(albedo("burley-subsurface", 0.0f, 0.02) - 0.758) < 6e-4);
    assert_true(fabs(albedo("burley-subsurface", 1.0f, 0.02) - 1.504) < 6e-4);
    assert_true(fabs(highest_albedo("oren-nayar", 0.2f) - 1.015) < 6e-4);
    assert_true(highest_albedo("oren-nayar", 0.01f) > 1.0);
    assert_true(highest_albedo("oren-nayar", 0.32f) > 1.0 && highest_albedo("oren-nayar", 0.33f) < 1.0);
    assert_true(fabs(1.0 - albedo("oren-nayar", 0.5f, 1.0) - 0.22) < 6e-3);
    assert_true(fabs(albedo("wrap", 1.0f, 0.4) - 0.75) < 1e-5);
}

/* f cos / pdf of samples, and of the pairs that are hardest: straight back and straight on. */
static void sample_weights_of_diffuse_lobes_are_bounded(void **state) {
    (void)state;
    static const struct {
        const char *id;
        float bound;
    } rows[] = {{"burley", 6.2501f},     {"burley-subsurface", 5.0001f},
                {"oren-nayar", 2.2502f}, {"fabric-lambert", 1.0001f},
                {"wrap", 1.0001f},       {"eon", 3.2f}};
    Random random = {43};
    for (int k = 0; k < 6; k++) {
        float highest = 0.0f;
        for (int n = 0; n < PAIRS; n++) {
            Lobe lobe = lobe_with(rows[k].id, n % 4 ? random_unit(&random) * 1.58f : (float)(n / 4 % 3));
            Dir o =
                n % 2 ? direction_cos((pow)(10.0, -6.0 * (double)random_unit(&random)), n) : random_direction(&random);
            Dir i = lobe_sample(&lobe, o, random_unit(&random), random_unit(&random));
            if (n % 3 == 0) i = n % 2 ? o : dir(-o.x, -o.y, o.z);
            if (i.z <= 0.0f) continue;
            LobeValue value = lobe_value(&lobe, angles_between(o, i));
            highest = max(highest, value.f * i.z / value.pdf);
        }
        print_message("%-18s weight at most %.4f\n", rows[k].id, (double)highest);
        assert_true(highest < rows[k].bound && highest > 0.9f * rows[k].bound);
    }
}

/* The one that claims no reciprocity has none; each other is the same both ways. */
static void diffuse_lobes_are_reciprocal_as_claimed(void **state) {
    (void)state;
    Random random = {44};
    for (int k = 0; k <= NAMES; k++) {
        const char *id = k < NAMES ? names[k] : "eon";
        float worst = 0.0f;
        for (int n = 0; n < 20000; n++) {
            Lobe lobe = lobe_with(id, random_unit(&random));
            Dir o = random_direction(&random), i = random_direction(&random);
            float f = lobe_eval(&lobe, angles_between(o, i)), g = lobe_eval(&lobe, angles_between(i, o));
            worst = max(worst, fabsf(f - g) / max(f, g));
        }
        bool claimed = weft_lobe_info(weft_lobe_find(id))->traits & TRAIT_RECIPROCAL;
        assert_true(claimed == (strcmp(id, "wrap") != 0));
        assert_true(claimed ? worst < 1e-5f : worst > 0.5f);
    }
}

/* At the smooth end all but the two of Burley's are Lambert. */
static void smooth_diffuse_lobes_are_lambert(void **state) {
    (void)state;
    static const char *const ids[] = {"oren-nayar", "fabric-lambert", "wrap", "eon"};
    Random random = {45};
    for (int n = 0; n < 20000; n++) {
        Lobe lobe = lobe_with(ids[n % 4], 0.0f);
        Dir o = random_direction(&random), i = random_direction(&random);
        assert_float_equal(lobe_eval(&lobe, angles_between(o, i)), (float)(1.0 / PI_DOUBLE), 1e-6f);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(diffuse_lobes_follow_the_formulas_of_their_papers),
        cmocka_unit_test(body_follows_the_formula_of_its_header),
        cmocka_unit_test(eon_follows_the_formula_of_its_paper),
        cmocka_unit_test(white_eon_returns_what_it_receives),
        cmocka_unit_test(eon_average_albedo_is_the_integral),
        cmocka_unit_test(albedo_of_diffuse_lobes_equals_its_closed_form),
        cmocka_unit_test(albedo_is_as_the_headers_state),
        cmocka_unit_test(sample_weights_of_diffuse_lobes_are_bounded),
        cmocka_unit_test(diffuse_lobes_are_reciprocal_as_claimed),
        cmocka_unit_test(smooth_diffuse_lobes_are_lambert),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
