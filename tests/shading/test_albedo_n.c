/* E by weft_albedo_n against an adaptive quadrature that shares nothing with albedo.c: where the answers of a
 * fine and a coarse rule differ, a rectangle of (theta_i, phi) is cut
 *
 * Labels: unsanitized */
#include "cases.h"
#include "weft/arrays.h"

/* Nodes and weights of Gauss and Legendre on [-1, 1], by Newton's iteration. */
enum { COARSE = 5, FINE = 9, POINTS = COARSE * COARSE + FINE * FINE };
typedef struct Gauss {
    double x[FINE], w[FINE];
} Gauss;

static Gauss gauss_make(int n) {
    Gauss g;
    for (int k = 0; k < n; k++) {
        double x = (cos)(PI_DOUBLE * (k + 0.75) / (n + 0.5)), slope = 1.0;
        for (int step = 0; step < 50; step++) {
            double p = x, before = 1.0;
            for (int d = 2; d <= n; d++) {
                double next = ((2 * d - 1) * x * p - (d - 1) * before) / d;
                before = p;
                p = next;
            }
            slope = n * (x * p - before) / (x * x - 1.0);
            x -= p / slope;
        }
        g.x[k] = x;
        g.w[k] = 2.0 / ((1.0 - x * x) * slope * slope);
    }
    return g;
}

static Gauss coarse, fine;

/* The integrand f cos_i sin_i: the lobe's own f, or a formula in double precision where there is one. */
typedef struct Integrand {
    const WeftLobe *lobe; /* NULL: charlie-neubelt written out */
    double alpha, cos_o, sin_o;
} Integrand;

typedef struct Rectangle {
    double theta[2], phi[2], value, error;
} Rectangle;

/* Conty Estevez and Kulla 2017, equation 2, over the denominator of Neubelt and Pettineo 2013. */
static double charlie_neubelt_double(const Integrand *f, double theta, double phi) {
    double cos_i = (cos)(theta), x = f->sin_o + (sin)(theta) * (cos)(phi), y = (sin)(theta) * (sin)(phi);
    double z = f->cos_o + cos_i, sin2 = (x * x + y * y) / (x * x + y * y + z * z);
    double d = (2.0 + 1.0 / f->alpha) * (pow)(sin2, 0.5 / f->alpha) / (2.0 * PI_DOUBLE);
    return d / (4.0 * (f->cos_o + cos_i - f->cos_o * cos_i));
}

static void integrate(const Integrand *f, Rectangle *r) {
    float ox[POINTS], oy[POINTS], oz[POINTS], ix[POINTS], iy[POINTS], iz[POINTS], value[POINTS];
    double weight[POINTS], theta[POINTS], phi[POINTS], sum[2] = {0.0, 0.0};
    int n = 0;
    double ct = 0.5 * (r->theta[0] + r->theta[1]), ht = 0.5 * (r->theta[1] - r->theta[0]);
    double cp = 0.5 * (r->phi[0] + r->phi[1]), hp = 0.5 * (r->phi[1] - r->phi[0]);
    for (int rule = 0; rule < 2; rule++) {
        const Gauss *g = rule ? &fine : &coarse;
        int count = rule ? FINE : COARSE;
        for (int j = 0; j < count; j++)
            for (int k = 0; k < count; k++, n++) {
                theta[n] = ct + ht * g->x[j];
                phi[n] = cp + hp * g->x[k];
                double s = (sin)(theta[n]), c = (sin)(0.5 * PI_DOUBLE - theta[n]);
                weight[n] = g->w[j] * g->w[k] * ht * hp * s * c;
                ox[n] = (float)f->sin_o, oy[n] = 0.0f, oz[n] = (float)f->cos_o;
                ix[n] = (float)(s * (cos)(phi[n])), iy[n] = (float)(s * (sin)(phi[n])), iz[n] = (float)c;
            }
    }
    if (f->lobe) {
        WeftDirections wo = {ox, oy, oz}, wi = {ix, iy, iz};
        weft_eval_n(f->lobe, POINTS, wo, wi, (WeftColors){.r = value}, NULL);
    }
    for (int k = 0; k < POINTS; k++)
        sum[k >= COARSE * COARSE] +=
            weight[k] * (f->lobe ? (double)value[k] : charlie_neubelt_double(f, theta[k], phi[k]));
    r->value = sum[1];
    r->error = fabs(sum[1] - sum[0]);
}

/* Cuts the rectangle that errs most until all of them together err little. The rounding of a narrow peak sets
 * an end to that: what is left is then still the bound. */
static double quadrature(const Integrand *f, double tolerance, double *error) {
    enum { MOST = 3000, HALVINGS = 7 };
    static Rectangle heap[MOST];
    double theta_o = atan2(f->sin_o, f->cos_o);
    double thetas[2 * HALVINGS + 1], phis[HALVINGS + 2], total = 0.0;
    int count = 0;
    /* halved again and again towards the mirror direction, lest a narrow peak is passed over */
    for (int k = 0; k < HALVINGS; k++) {
        double left = ldexp(1.0, -k);
        thetas[k] = theta_o * (1.0 - left);
        thetas[2 * HALVINGS - k] = theta_o + (0.5 * PI_DOUBLE - theta_o) * left;
        phis[1 + k] = PI_DOUBLE * (1.0 - 0.5 * left); /* the first is pi/2: some diffuse lobes have a kink there */
    }
    thetas[HALVINGS] = theta_o;
    phis[0] = 0.0;
    phis[1 + HALVINGS] = PI_DOUBLE;
    *error = 0.0;
    for (int j = 0; j < 2 * HALVINGS; j++)
        for (int k = 0; k <= HALVINGS; k++)
            for (int side = 0; side < 2; side++) {
                if (thetas[j + 1] - thetas[j] < 1e-9) continue;
                Rectangle r = {.theta = {thetas[j], thetas[j + 1]}, .phi = {phis[k], phis[k + 1]}};
                if (side) r.phi[0] = 2.0 * PI_DOUBLE - phis[k + 1], r.phi[1] = 2.0 * PI_DOUBLE - phis[k];
                integrate(f, &r);
                heap[count++] = r;
                total += r.value;
                *error += r.error;
            }
    while (*error > tolerance && count + 3 < MOST) {
        int worst = 0;
        for (int k = 1; k < count; k++)
            if (heap[k].error > heap[worst].error) worst = k;
        Rectangle whole = heap[worst];
        total -= whole.value;
        *error -= whole.error;
        double theta = 0.5 * (whole.theta[0] + whole.theta[1]), phi = 0.5 * (whole.phi[0] + whole.phi[1]);
        for (int q = 0; q < 4; q++) {
            Rectangle r = whole;
            r.theta[!(q & 1)] = theta;
            r.phi[!(q & 2)] = phi;
            integrate(f, &r);
            heap[q == 0 ? worst : count++] = r;
            total += r.value;
            *error += r.error;
        }
    }
    return total;
}

static const double cosines[] = {1.0, 0.8, 0.5, 0.2, 0.05, 0.02, 0.004};
static const float spread[] = {0.01f, 0.02f, 0.0625f, 0.15f, 0.25f, 0.5f, 1.0f};
enum { COSINES = sizeof cosines / sizeof cosines[0], SPREAD = sizeof spread / sizeof spread[0] };

/* Returns how far E may be from the quadrature here. Highlights of silk and woven at a small alpha are one ridge, or up to
 * 17, so narrow that its rectangles miss some of them; E itself is right, as the next test shows. */
static double error_most(const WeftLobe *lobe) {
    const int alpha = weft_lobe_param_find(lobe->lobe, "alpha");
    if (alpha < 0 || lobe->params[alpha] >= 0.1f) return 1e-4;
    return lobe->lobe == LOBE_SILK ? 4e-3 : lobe->lobe == LOBE_WOVEN ? 1e-3 : 1e-4;
}

static void albedo_of_every_lobe_is_its_integral(void **state) {
    (void)state;
    const double tolerance = test_long() ? 2e-6 : 5e-6;
    double worst = 0.0, highest = 0.0, worst_own = 0.0;
    for (int id = 0; id < weft_lobe_count(); id++) {
        const WeftLobeInfo *info = weft_lobe_info(id);
        if (case_walks(id)) continue;
        double lobe_worst = 0.0;
        for (int s = 0; s < SPREAD; s++) {
            WeftLobe lobe;
            assert_int_equal(weft_lobe_init(info->id, &lobe, NULL), WEFT_OK);
            int shape = weft_lobe_param_find(id, "alpha");
            if (shape < 0) shape = 0;
            if ((info->param_count == 0 || info->params[shape].choices) && s > 0) continue;
            if (info->param_count > 0 && !info->params[shape].choices) {
                float low = info->params[shape].low;
                if (spread[s] < low && s + 1 < SPREAD && spread[s + 1] <= low) continue;
                lobe.params[shape] = max(spread[s], low);
            }
            float cos_o[COSINES], e[COSINES];
            for (int c = 0; c < COSINES; c++) cos_o[c] = (float)cosines[c];
            assert_int_equal(weft_albedo_n(&lobe, COSINES, cos_o, (WeftColors){.r = e}, NULL), WEFT_OK);
            for (int c = 0; c < COSINES; c++) {
                double error, z = (double)cos_o[c];
                Integrand f = {&lobe, (double)lobe.params[shape], z, (sqrt)(1.0 - z * z)};
                double own = quadrature(&f, tolerance, &error), d = fabs((double)e[c] - own);
                if (error > 5e-4 || d > error_most(&lobe))
                    fail_msg("%s %g at cos_o %g: E %.5f, quadrature %.5f +- %.5f", info->id, (double)lobe.params[shape],
                             z, (double)e[c], own, error);
                lobe_worst = fmax(lobe_worst, d);
                highest = fmax(highest, own);
                if (id != LOBE_CHARLIE_NEUBELT) continue;
                f.lobe = NULL;
                d = fabs((double)e[c] - quadrature(&f, tolerance, &error));
                worst_own = fmax(worst_own, d);
                assert_true(d < 1e-3 && error <= 1e-4);
            }
        }
        print_message("%-28s E within %.1e\n", info->id, lobe_worst);
        worst = fmax(worst, lobe_worst);
    }
    print_message("all lobes: E within %.1e of a quadrature, up to E %.3f; charlie-neubelt within %.1e of "
                  "its formula\n",
                  worst, highest, worst_own);
    assert_true(highest > 2.5); /* charlie-neubelt at alpha 0.01 and grazing */
}

/* E by points that gather at the horizon and about the plane of the mirror direction, as narrow ridges do. */
static double gathered(const WeftLobe *lobe, double cos_o) {
    enum { LEVELS = 3000, ACROSS = 1500 };
    static float o[3][ACROSS], i[3][ACROSS], f[ACROSS];
    double sin_o = (sqrt)(1.0 - cos_o * cos_o), sum = 0.0;
    for (int k = 0; k < ACROSS; k++) o[0][k] = (float)sin_o, o[1][k] = 0.0f, o[2][k] = (float)cos_o;
    for (int ring = 0; ring < LEVELS; ring++) {
        double x = (ring + 0.5) / LEVELS, z = x * x * x, across = (sqrt)(1.0 - z * z);
        for (int k = 0; k < ACROSS; k++) {
            double y = (k + 0.5) / ACROSS, phi = PI_DOUBLE * (1.0 + y * y * y);
            i[0][k] = (float)(across * (cos)(phi)), i[1][k] = (float)(across * (sin)(phi)), i[2][k] = (float)z;
        }
        weft_eval_n(lobe, ACROSS, (WeftDirections){o[0], o[1], o[2]}, (WeftDirections){i[0], i[1], i[2]},
                    (WeftColors){f, NULL, NULL}, NULL);
        for (int k = 0; k < ACROSS; k++) {
            double y = (k + 0.5) / ACROSS;
            sum += (double)f[k] * z * 6.0 * PI_DOUBLE * y * y * 3.0 * x * x / LEVELS / ACROSS;
        }
    }
    return sum;
}

static void albedo_of_narrow_ridges_is_their_integral(void **state) {
    (void)state;
    static const struct {
        const char *id;
        float alpha, cos_o;
    } rows[] = {{"silk", 0.01f, 0.004f}, {"silk", 0.02f, 0.05f}, {"woven", 0.02f, 0.05f}, {"woven", 0.05f, 0.3f}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        WeftLobe lobe;
        float e[3];
        assert_int_equal(weft_lobe_init(rows[k].id, &lobe, NULL), WEFT_OK);
        lobe.params[weft_lobe_param_find(lobe.lobe, "alpha")] = rows[k].alpha;
        weft_lobe_albedo(&lobe, rows[k].cos_o, e);
        double own = gathered(&lobe, (double)rows[k].cos_o);
        print_message("%s %g at cos_o %g: E %.6f, gathered %.6f\n", rows[k].id, (double)rows[k].alpha,
                      (double)rows[k].cos_o, (double)e[0], own);
        assert_true(fabs((double)e[0] - own) < 3e-5);
    }
}

/* As the calls for one cosine, and with colours. */
static void albedo_of_many_cosines_equals_single_calls(void **state) {
    (void)state;
    enum { N = 7 };
    const float cos_o[N] = {1.0f, 0.3f, 1e-3f, 0.0f, -1.0f, NAN, 2.0f};
    float r[N], g[N], b[N], one[3];
    WeftLobe lobe;
    weft_lobe_init("ggx", &lobe, NULL);
    lobe.f0[0] = 0.04f, lobe.f0[1] = 0.5f;
    lobe.f90[2] = 0.25f;
    assert_int_equal(weft_albedo_n(&lobe, N, cos_o, (WeftColors){r, g, b}, NULL), WEFT_OK);
    for (int k = 0; k < N; k++) {
        weft_lobe_albedo(&lobe, cos_o[k], one);
        assert_memory_equal(&r[k], &one[0], sizeof(float));
        assert_memory_equal(&g[k], &one[1], sizeof(float));
        assert_memory_equal(&b[k], &one[2], sizeof(float));
        assert_true(r[k] > 0.0f && r[k] < g[k] && g[k] < 1.0f);
    }
    for (int k = 3; k < 6; k++) assert_memory_equal(&r[k], &r[3], sizeof(float)); /* the horizon */
    assert_memory_equal(&r[6], &r[0], sizeof(float));
}

static int make(void **state) {
    (void)state;
    coarse = gauss_make(COARSE);
    fine = gauss_make(FINE);
    return 0;
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(albedo_of_every_lobe_is_its_integral),
        cmocka_unit_test(albedo_of_narrow_ridges_is_their_integral),
        cmocka_unit_test(albedo_of_many_cosines_equals_single_calls),
    };
    return cmocka_run_group_tests(tests, make, NULL);
}
