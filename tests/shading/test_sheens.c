/* The sheen and cloth lobes against their papers' formulas in double precision, written from the papers:
 * other angles, other order, integrals instead of closed forms
 *
 * Labels: unsanitized */
#include "cases.h"
#include "shading/catalogue/albedo.h"

typedef struct Vector {
    double x, y, z;
} Vector;

static Vector vector(Dir w) { return (Vector){(double)w.x, (double)w.y, (double)w.z}; }
static double dot(Vector a, Vector b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static Vector unit(Vector a) {
    double r = 1.0 / (sqrt)(dot(a, a));
    return (Vector){a.x * r, a.y * r, a.z * r};
}
static Vector halfway(Vector o, Vector i) { return unit((Vector){o.x + i.x, o.y + i.y, o.z + i.z}); }
static double polar(Vector w) { return atan2(hypot(w.x, w.y), w.z); }

/* f of a pair of directions, the parameters in the order of the table. */
typedef double Reference(const float *p, Vector o, Vector i);

/* Burley 2012: the half angle between wo and wi by its own arc. */
static double burley(const float *p, Vector o, Vector i) {
    (void)p;
    Vector c = {o.y * i.z - o.z * i.y, o.z * i.x - o.x * i.z, o.x * i.y - o.y * i.x};
    double half_angle = 0.5 * atan2((sqrt)(dot(c, c)), dot(o, i));
    return (pow)(1.0 - (cos)(half_angle), 5.0);
}

static double d_ashikhmin(double alpha, Vector h) {
    double theta = polar(h), cot = 1.0 / tan(theta);
    double rim = 4.0 * (exp)(-cot * cot / (alpha * alpha)) / (pow)((sin)(theta), 4.0);
    return (1.0 + rim) / (PI_DOUBLE * (1.0 + 4.0 * alpha * alpha));
}
static double d_charlie(double alpha, Vector h) {
    return (2.0 + 1.0 / alpha) * (pow)((sin)(polar(h)), 1.0 / alpha) / (2.0 * PI_DOUBLE);
}
static double v_neubelt(Vector o, Vector i) { return 1.0 / (4.0 * (o.z + i.z - o.z * i.z)); }

/* Conty Estevez, Kulla 2017, Equation 3 and Table 1: p = (1 - r)^2 p0 + (1 - (1 - r)^2) p1. */
static double lambda(double r, double x) {
    static const double p0[] = {25.3245, 3.32435, 0.16801, -1.27393, -4.85967};
    static const double p1[] = {21.5473, 3.82987, 0.19823, -1.97760, -4.32054};
    double w = (1.0 - r) * (1.0 - r), p[5], l[2];
    for (int k = 0; k < 5; k++) p[k] = w * p0[k] + (1.0 - w) * p1[k];
    const double at[] = {x < 0.5 ? x : 1.0 - x, 0.5};
    for (int k = 0; k < 2; k++) l[k] = p[0] / (1.0 + p[1] * (pow)(at[k], p[2])) + p[3] * at[k] + p[4];
    return (exp)(x < 0.5 ? l[0] : 2.0 * l[1] - l[0]);
}
static double v_conty_kulla(double alpha, Vector o, Vector i) {
    return 1.0 / ((1.0 + lambda(alpha, o.z) + lambda(alpha, i.z)) * 4.0 * o.z * i.z);
}

static double ashikhmin_neubelt(const float *p, Vector o, Vector i) {
    return d_ashikhmin((double)p[0], halfway(o, i)) * v_neubelt(o, i);
}
static double ashikhmin_conty_kulla(const float *p, Vector o, Vector i) {
    return d_ashikhmin((double)p[0], halfway(o, i)) * v_conty_kulla((double)p[0], o, i);
}
static double charlie_khronos(const float *p, Vector o, Vector i) {
    return d_charlie((double)p[0], halfway(o, i)) * fmin(v_conty_kulla((double)p[0], o, i), 1.0);
}

static double ramp(double beta, double t) { return expm1(-beta * t) / expm1(-beta); }
static double exponential(const float *p, Vector o, Vector i) {
    (void)i;
    return ramp((double)p[0], 2.0 * (pow)((sin)(0.5 * polar(o)), 2.0)) / PI_DOUBLE;
}

/* The mean of x over a uniform light, by Simpson's rule. */
static double mean_ramp(double beta) {
    enum { STEPS = 1000 };
    double sum = 0.0;
    for (int n = 0; n <= STEPS; n++) {
        double c = (double)n / STEPS, w = n == 0 || n == STEPS ? 1.0 : n % 2 ? 4.0 : 2.0;
        sum += w * 2.0 * c * ramp(beta, 1.0 - c) / (3.0 * STEPS);
    }
    return sum;
}
static double exponential_lit(const float *p, Vector o, Vector i) {
    return exponential(p, o, i) * exponential(p, i, o) * PI_DOUBLE / mean_ramp((double)p[0]);
}

/* Heitz et al. 2015: D and the projected area of a flake by its matrix S = diag(1, 1, sigma^2); the layer as
 * the integral of what each depth sends back, by Simpson's rule in the transmittance of the way. */
static double patry(const float *p, Vector o, Vector i) {
    double s = (pow)((double)p[0], 4.0), density = (double)p[1];
    Vector h = halfway(o, i);
    double inverse = h.x * h.x + h.y * h.y + h.z * h.z / s;
    double d = 1.0 / (PI_DOUBLE * (sqrt)(s)*inverse * inverse);
    double area = (sqrt)(o.x * o.x + o.y * o.y + s * o.z * o.z);
    double way = 1.0 / o.z + 1.0 / i.z, layer = -expm1(-density * way) / (way * o.z * i.z);
    return d / (4.0 * area) * layer;
}

/* Heitz 2014: D by its slopes, G2 by Lambda; 1/1024 as Unity's floor. */
static double lambda_ggx(double ax, double ay, Vector w) {
    double phi = atan2(w.y, w.x), a2 = (pow)(ax * (cos)(phi), 2.0) + (pow)(ay * (sin)(phi), 2.0);
    double t = tan(polar(w));
    return 0.5 * ((sqrt)(1.0 + a2 * t * t) - 1.0);
}
static double silk(const float *p, Vector o, Vector i) {
    double ax = fmax((double)p[0] * (1.0 + (double)p[1]), 1.0 / 1024.0);
    double ay = fmax((double)p[0] * (1.0 - (double)p[1]), 1.0 / 1024.0);
    Vector h = halfway(o, i);
    double slopes = 1.0 + (pow)(h.x / h.z / ax, 2.0) + (pow)(h.y / h.z / ay, 2.0);
    double d = 1.0 / (PI_DOUBLE * ax * ay * slopes * slopes * (pow)(h.z, 4.0));
    return d / (1.0 + lambda_ggx(ax, ay, o) + lambda_ggx(ax, ay, i)) / (4.0 * o.z * i.z);
}

/* Of weft's own header: GTR by its powers, the shadowing and the second colour's share with angles. */
static double spread_of_fabric(const float *p, Vector o, Vector i) {
    Vector h = halfway(o, i);
    double a2 = (pow)((double)p[0], 2.0), tail = (double)p[1], theta = polar(h);
    double off = tail > 1.0 ? fmax(tail - 1.0, 1e-4) : fmin(tail - 1.0, -1e-4);
    double t = (pow)((sin)(theta), 2.0) + a2 * (1.5 - 0.5 * dot(i, h)) * (pow)((cos)(theta), 2.0);
    return off * (1.0 - a2) / (PI_DOUBLE * ((pow)(a2, -off) - 1.0)) * (pow)(t, -tail);
}
static double fabric(const float *p, Vector o, Vector i) {
    double alpha = (double)p[0], m = 0.25 + 0.5 * alpha;
    double to = hypot(m * (sin)(polar(o)), o.z), ti = hypot(m * (sin)(polar(i)), i.z);
    double graze = 1.0 - (double)p[1] * (0.85 - 0.5 * alpha - 0.2 * alpha * alpha);
    return spread_of_fabric(p, o, i) / (2.0 * (i.z * to + o.z * ti)) / fmax(1.0, 1.0 + (1.0 / m - 1.0) * graze);
}

/* Sadeghi et al. 2013, in their angles: theta from the plane across the yarn, phi around it from n. */
typedef struct Around {
    double theta, phi;
} Around;
static Around around(Vector w, Vector t, Vector n, Vector b) {
    double y = dot(w, t), x = dot(w, n), z = dot(w, b);
    return (Around){atan2(y, hypot(x, z)), atan2(z, x)};
}
static double sech(double x) { return 1.0 / cosh(x); }

static double yarn(double width, double isotropic, Around o, Around i) {
    double scale = width * (sqrt)(3.0) / PI_DOUBLE, s = (sin)(o.theta) + (sin)(i.theta);
    double g = (pow)(sech(s / (2.0 * scale)), 2.0) / (4.0 * scale);
    double phi_d = o.phi - i.phi, co = (cos)(o.theta), ci = (cos)(i.theta);
    double surface = g * fabs((cos)(0.5 * phi_d)) / (4.0 * fmax(co, ci));
    double volume = 1.0 / (4.0 * PI_DOUBLE * (co + ci));
    double sigma = 20.0 * PI_DOUBLE / 180.0, u = (exp)(((cos)(phi_d)-1.0) / (sigma * sigma));
    double mo = (cos)(o.phi), mi = (cos)(i.phi), mask = (1.0 - u) * mo * mi + u * fmin(mo, mi);
    return ((1.0 - isotropic) * surface + isotropic * volume) * mask / (mo * mi);
}

/* The two families apart, in sum[0] and sum[1]. */
static void threads_apart(const float *p, Vector o, Vector i, double sum[2]) {
    double q_o = 0.0, q_i = 0.0;
    sum[0] = sum[1] = 0.0;
    for (int pass = 0; pass < 2; pass++)
        for (int piece = 0; piece < 4; piece++) {
            int weft = piece / 2;
            double tilt = atan((double)p[3 + weft]) * (piece % 2 ? -1.0 : 1.0);
            double c = (cos)(tilt), s = (sin)(tilt);
            Vector t = weft ? (Vector){0.0, c, s} : (Vector){c, 0.0, s};
            Vector n = weft ? (Vector){0.0, -s, c} : (Vector){-s, 0.0, c};
            Vector b = weft ? (Vector){1.0, 0.0, 0.0} : (Vector){0.0, 1.0, 0.0};
            double area = 0.5 * (weft ? (double)p[2] : 1.0 - (double)p[2]) / c;
            double seen_o = fmax(dot(n, o), 0.0), seen_i = fmax(dot(n, i), 0.0);
            if (pass == 0) {
                q_o += area * seen_o;
                q_i += area * seen_i;
            } else if (seen_o > 0.0 && seen_i > 0.0) {
                double f = yarn((double)p[weft], (double)p[5], around(o, t, n, b), around(i, t, n, b));
                sum[weft] += area * seen_o * seen_i / (q_o * q_i) * f;
            }
        }
}
static double threads(const float *p, Vector o, Vector i) {
    double sum[2];
    threads_apart(p, o, i, sum);
    return sum[0] + sum[1];
}

static const struct Sheen {
    const char *id;
    Reference *reference;
} sheens[] = {
    {"burley-sheen", burley},
    {"ashikhmin-neubelt", ashikhmin_neubelt},
    {"ashikhmin-conty-kulla", ashikhmin_conty_kulla},
    {"charlie-khronos", charlie_khronos},
    {"exponential", exponential},
    {"exponential-lit", exponential_lit},
    {"patry", patry},
    {"silk", silk},
    {"threads", threads},
    {"fabric", fabric},
};
enum { SHEENS = sizeof sheens / sizeof sheens[0] };

/* Any parameters of the plausible range, more of them low. */
static Lobe random_lobe(Random *random, int id) {
    const WeftLobeInfo *info = weft_lobe_info((int)id);
    Lobe lobe = lobe_default(id);
    for (int k = 0; k < info->param_count; k++) {
        const WeftParamInfo *p = &info->params[k];
        double u = (double)random_unit(random), low = (double)p->low, high = (double)p->high;
        lobe_set(&lobe, k, (float)(low > 0.0 ? low * (pow)(high / low, u) : low + (high - low) * u));
    }
    return lobe;
}

static void sheens_follow_the_formulas_of_their_papers(void **state) {
    (void)state;
    for (int s = 0; s < SHEENS; s++) {
        int id = weft_lobe_find(sheens[s].id);
        Random random = {41};
        double worst = 0.0;
        for (int n = 0; n < (test_long() ? 1000000 : id == LOBE_EXPONENTIAL_LIT ? 3000 : 50000); n++) {
            Lobe lobe = random_lobe(&random, id);
            /* half vectors round in proportion to 1 / alpha: a sharp highlight is not told to five digits */
            if (id == LOBE_SILK) lobe_set(&lobe, 0, max(lobe.params[0], 0.2f));
            Dir o = random_direction(&random), i = random_direction(&random);
            /* where ashikhmin-conty-kulla and v_conty_kulla say that they depart */
            if (min(o.z, i.z) < 1e-5f || o.z * i.z < 1e-7f) continue;
            double exact = sheens[s].reference(lobe.params, vector(o), vector(i));
            double f = (double)lobe_eval(&lobe, angles_between(o, i));
            double error = fabs(f - exact) / (exact + 1e-5);
            worst = fmax(worst, error);
            if (error > 2e-5)
                fail_msg("%s wi=(%g %g %g): f %.9g, by the paper %.9g", case_name(&lobe, o).text, (double)i.x,
                         (double)i.y, (double)i.z, f, exact);
        }
        print_message("%-22s within %.1e of its formula\n", sheens[s].id, worst);
    }
}

/* alpha is an artist's roughness squared where the header says so; patry squares its own. */
static void roughness_of_sheens_is_as_the_headers_state(void **state) {
    (void)state;
    static const char *const squared[] = {"ashikhmin-neubelt", "ashikhmin-conty-kulla", "charlie-khronos", "silk"};
    for (int k = 0; k < 4; k++) {
        int id = weft_lobe_find(squared[k]);
        assert_string_equal(weft_lobe_info(id)->params[0].name, "alpha");
        assert_float_equal(lobe_rough(id, 0.5f).params[0], 0.25f, 0.0f);
    }
    assert_float_equal(lobe_rough(LOBE_PATRY, 0.5f).params[0], 0.5f, 0.0f);
    assert_float_equal(lobe_rough(LOBE_EXPONENTIAL, 0.0f).params[0], 0.5f, 0.0f);
    assert_float_equal(lobe_rough(LOBE_EXPONENTIAL, 1.0f).params[0], 20.0f, 0.0f);
    assert_float_equal(lobe_rough(LOBE_THREADS, 0.0f).params[0], 0.1f, 0.0f);
}

/* Both exponentials reflect x exactly, whatever beta, and their limit for small beta is the straight ramp. */
static void exponential_lobes_follow_their_ramp(void **state) {
    (void)state;
    static const float betas[] = {0.01f, 0.1f, 0.25f, 0.5f, 1.0f, 3.0f, 20.0f, 100.0f};
    static const int ids[] = {LOBE_EXPONENTIAL, LOBE_EXPONENTIAL_LIT};
    for (int l = 0; l < 2; l++)
        for (int b = 0; b < 8; b++)
            for (int c = 1; c <= 20; c++) {
                Lobe lobe = lobe_default(ids[l]);
                lobe_set(&lobe, 0, betas[b]);
                double cos_o = c / 20.0, x = ramp((double)betas[b], 1.0 - cos_o);
                assert_float_equal(albedo_quadrature(&lobe, direction_cos(cos_o, 0.0), 1e-6).f0, (float)x, 1e-5f);
                if (b == 0) assert_float_equal((float)x, (float)(1.0 - cos_o), 2e-3f);
            }
    /* the plain product would lose two thirds of it */
    assert_true(fabs(mean_ramp(0.01) - 1.0 / 3.0) < 1e-2);
}

/* Energies and weights that the headers state. */
static double white_albedo(int id, float first, double cos_o) {
    Lobe lobe = lobe_default(id);
    if (weft_lobe_info((int)id)->param_count) lobe_set(&lobe, 0, first);
    Albedo e = albedo_quadrature(&lobe, direction_cos(cos_o, 0.0), 1e-5);
    return (double)(e.f0 + e.f90);
}
static void expect(int id, float first, double cos_o, double stated, double rounding) {
    double e = white_albedo(id, first, cos_o);
    if (fabs(e - stated) > rounding)
        fail_msg("%s %g: E %.5f at cos_o %g, the header says %g", weft_lobe_info((int)id)->id, (double)first, e, cos_o,
                 stated);
}

static void albedo_of_sheens_is_as_the_headers_state(void **state) {
    (void)state;
    expect(LOBE_BURLEY_SHEEN, 0.0f, 0.02, 0.0836, 5e-5);
    expect(LOBE_BURLEY_SHEEN, 0.0f, 0.5, 0.0156, 5e-5);
    expect(LOBE_BURLEY_SHEEN, 0.0f, 1.0, 0.0003, 5e-5);
    expect(LOBE_ASHIKHMIN_NEUBELT, 0.25f, 0.02, 0.73, 5e-3);
    expect(LOBE_ASHIKHMIN_NEUBELT, 1.0f, 0.02, 0.52, 5e-3);
    expect(LOBE_ASHIKHMIN_CONTY_KULLA, 0.25f, 0.02, 0.67, 5e-3);
    expect(LOBE_CHARLIE_KHRONOS, 0.01f, 0.005, 1.41, 5e-3);
    expect(LOBE_PATRY, 0.5f, 0.02, 0.38, 5e-3);
    expect(LOBE_PATRY, 1.0f, 0.02, 0.46, 5e-3);
    expect(LOBE_SILK, 0.25f, 1.0, 0.88, 5e-3);
    expect(LOBE_SILK, 0.25f, 0.5, 0.84, 6e-3);
    expect(LOBE_THREADS, 0.3f, 0.02, 0.25, 5e-3);
    expect(LOBE_THREADS, 0.3f, 0.5, 0.31, 5e-3);
    expect(LOBE_THREADS, 0.3f, 1.0, 0.34, 5e-3);

    double neubelt = 0.0, conty_kulla = 0.0, khronos_above = 0.0, khronos_below = 0.0;
    for (int c = 0; c <= 24; c++) {
        double cos_o = (pow)(10.0, -6.0 + 0.25 * c);
        for (int a = 1; a <= 20; a++) {
            neubelt = fmax(neubelt, white_albedo(LOBE_ASHIKHMIN_NEUBELT, (float)a / 20.0f, cos_o));
            conty_kulla = fmax(conty_kulla, white_albedo(LOBE_ASHIKHMIN_CONTY_KULLA, (float)a / 20.0f, cos_o));
        }
        if (cos_o < 1e-5) continue;
        khronos_above = fmax(khronos_above, white_albedo(LOBE_CHARLIE_KHRONOS, 0.036f, cos_o));
        khronos_below = fmax(khronos_below, white_albedo(LOBE_CHARLIE_KHRONOS, 0.034f, cos_o));
    }
    print_message("E at most: ashikhmin-neubelt %.3f, ashikhmin-conty-kulla %.3f\n", neubelt, conty_kulla);
    assert_true(neubelt < 0.87 && conty_kulla < 0.97);
    assert_true(khronos_above < 1.0 && khronos_below > 1.0);
    assert_true(white_albedo(LOBE_CHARLIE_KHRONOS, 0.05f, 1e-6) > 1.0);
}

/* Whatever textures make of their numbers, body and fabric return no more than they receive. */
static void cloth_conserves_energy_over_its_whole_range(void **state) {
    (void)state;
    static const char *const ids[] = {"body", "fabric"};
    for (int l = 0; l < 2; l++) {
        int id = weft_lobe_find(ids[l]);
        const WeftLobeInfo *info = weft_lobe_info(id);
        Random random = {53};
        double most = 0.0;
        for (int n = 0; n < (test_long() ? 20000 : 600); n++) {
            Lobe lobe = lobe_default(id);
            for (int k = 0; k < info->param_count; k++) {
                float u = n % 3 ? random_unit(&random) : (float)(n / 3 >> k & 1); /* every corner too */
                lobe_set(&lobe, k, mix(info->params[k].hard_low, info->params[k].hard_high, u));
            }
            double u = (double)random_unit(&random), cos_o = n % 2 ? u : (pow)(10.0, -4.0 * u);
            Dir o = direction_cos(fmax(cos_o, 1e-4), n);
            Albedo e = albedo_quadrature(&lobe, o, 1e-4);
            most = fmax(most, (double)(e.f0 + e.f90));
            if (!(e.f0 + e.f90 <= 1.0005f)) fail_msg("%s: E %g", case_name(&lobe, o).text, (double)(e.f0 + e.f90));
        }
        print_message("%-22s E at most %.3f\n", ids[l], most);
        assert_true(most > 0.9);
    }
}

/* Where a norm is a fit, its worst corners: the ground of a high peak and no lift, from above; flat ribbons of any
 * fibres, across them at grazing and from above. */
static void fitted_norms_hold_in_their_worst_corners(void **state) {
    (void)state;
    double body = 0.0, woven = 0.0;
    for (int k = 0; k <= 20; k++) {
        Lobe lobe = lobe_default(LOBE_BODY);
        lobe_set(&lobe, BODY_EDGE, 0.05f * (float)k);
        lobe_set(&lobe, BODY_RETRO, 6.0f);
        lobe_set(&lobe, BODY_LIFT, 0.0f);
        const Albedo e = albedo_quadrature(&lobe, (Dir){0.0f, 0.0f, 1.0f}, 1e-4);
        body = fmax(body, (double)(e.f0 + e.f90));
    }
    static const float sines[] = {0.0f, 0.37f, 0.987f, 0.995f};
    for (int k = 0; k < 4 * 10; k++) {
        Lobe lobe = lobe_default(LOBE_WOVEN);
        lobe_set(&lobe, WOVEN_ALPHA, 0.1f * (float)(k / 4 + 1));
        lobe_set(&lobe, WOVEN_CRIMP, 0.0f);
        lobe_set(&lobe, WOVEN_ROUNDNESS, k % 3 ? 0.0f : 0.2f);
        lobe_set(&lobe, WOVEN_FLOATS, 6.0f);
        const float s = sines[k % 4];
        const Albedo e = albedo_quadrature(&lobe, (Dir){0.0f, s, sqrtf(1.0f - s * s)}, 1e-4);
        woven = fmax(woven, (double)(e.f0 + e.f90));
    }
    print_message("E at most: body %.4f, woven %.4f\n", body, woven);
    assert_true(body <= 1.0002 && body > 0.98 && woven <= 1.0003 && woven > 0.98);
}

/* The weight f cos / pdf never passes the stated bound, nor what yarns send up the stated most. */
static void sample_weights_of_sheens_are_bounded(void **state) {
    (void)state;
    static const struct {
        int id;
        double bound;
    } rows[] = {{LOBE_EXPONENTIAL, 1.0}, {LOBE_EXPONENTIAL_LIT, 1.5}, {LOBE_SILK, 1.0}, {LOBE_THREADS, PI_DOUBLE}};
    for (int r = 0; r < 4; r++) {
        Random random = {43};
        double most = 0.0;
        for (int n = 0; n < 200000; n++) {
            Lobe lobe = random_lobe(&random, rows[r].id);
            Dir o = direction_cos((pow)(10.0, -5.0 * (double)random_unit(&random)), n);
            Dir i = lobe_sample(&lobe, o, random_unit(&random), random_unit(&random));
            if (i.z <= 0.0f) continue;
            Angles a = angles_between(o, i);
            most = fmax(most, (double)lobe_eval(&lobe, a) * (double)i.z / (double)lobe_pdf(&lobe, a));
        }
        print_message("%-22s weight at most %.3f\n", weft_lobe_info((int)rows[r].id)->id, most);
        assert_true(most <= rows[r].bound * (1.0 + 1e-3));
    }
    Random random = {47};
    double most = 0.0;
    for (int n = 0; n < (test_long() ? 5000 : 200); n++) {
        Lobe lobe = random_lobe(&random, LOBE_THREADS);
        lobe_set(&lobe, 5, 0.0f);
        if (n % 2) lobe_set(&lobe, 3, 0.0f), lobe_set(&lobe, 4, 0.0f);
        Albedo e = albedo_quadrature(&lobe, direction_cos((double)random_unit(&random), n), 1e-4);
        most = fmax(most, (double)(e.f0 + e.f90));
    }
    print_message("threads reflect at most %.3f\n", most);
    assert_true(most < 0.475);
}

static double weft_share(const Lobe *lobe, Dir o, Dir i) { return (double)lobe_value(lobe, angles_between(o, i)).s; }

/* The share of the weft's colour: by the formula; and how far it goes when the cloth is turned. */
static void threads_shift_their_color(void **state) {
    (void)state;
    Random random = {53};
    for (int n = 0; n < 20000; n++) {
        Lobe lobe = random_lobe(&random, LOBE_THREADS);
        Dir o = random_direction(&random), i = random_direction(&random);
        double sum[2];
        threads_apart(lobe.params, vector(o), vector(i), sum);
        if (sum[0] + sum[1] > 1e-6) assert_true(fabs(weft_share(&lobe, o, i) - sum[1] / (sum[0] + sum[1])) < 4e-5);
    }

    /* light from the normal, seen at 45 degrees along the warp and along the weft */
    Lobe lobe = lobe_default(LOBE_THREADS);
    Dir up = dir(0.0f, 0.0f, 1.0f);
    double along_warp = weft_share(&lobe, direction(PI_DOUBLE / 4.0, 0.0), up);
    double along_weft = weft_share(&lobe, direction(PI_DOUBLE / 4.0, PI_DOUBLE / 2.0), up);
    double between = weft_share(&lobe, direction(PI_DOUBLE / 4.0, PI_DOUBLE / 4.0), up);
    print_message("share of the weft: %.3f along the warp, %.3f between, %.3f along the weft\n", along_warp, between,
                  along_weft);
    assert_true(fabs(along_warp - 0.285) < 1e-3 && fabs(along_weft - 0.715) < 1e-3);
    assert_true(fabs(between - 0.5) < 1e-5);

    /* in a uniform light the same, near grazing: the slopes that face the viewer hide the other yarn */
    Albedo a = albedo_quadrature(&lobe, direction_cos(0.02, 0.0), 1e-5);
    Albedo b = albedo_quadrature(&lobe, direction_cos(0.02, PI_DOUBLE / 2.0), 1e-5);
    assert_float_equal(a.f90 / (a.f0 + a.f90), 0.135f, 1e-3f);
    assert_float_equal(b.f90 / (b.f0 + b.f90), 0.865f, 1e-3f);

    /* one family alone has one colour */
    lobe_set(&lobe, 2, 0.0f);
    assert_float_equal((float)weft_share(&lobe, direction(0.7, 1.0), up), 0.0f, 0.0f);
    lobe_set(&lobe, 2, 1.0f);
    assert_float_equal((float)weft_share(&lobe, direction(0.7, 1.0), up), 1.0f, 0.0f);
    assert_float_equal(lobe_second(&lobe, 0.2f, 0.7f), 0.7f, 0.0f);
}

/* Flat yarn in a plain weave has no streak of its own to hide: the shares are then those of the surface. */
static void flat_yarn_is_weighted_by_its_area(void **state) {
    (void)state;
    Lobe lobe = lobe_default(LOBE_THREADS);
    lobe_set(&lobe, 2, 0.25f);
    lobe_set(&lobe, 3, 0.0f), lobe_set(&lobe, 4, 0.0f);
    Dir up = dir(0.0f, 0.0f, 1.0f);
    assert_float_equal((float)weft_share(&lobe, up, up), 0.25f, 1e-6f);
    Albedo e = albedo_quadrature(&lobe, up, 1e-5);
    assert_float_equal(e.f90 / (e.f0 + e.f90), 0.25f, 1e-4f);
}

/* silk without anisotropy is ggx; stretched it is the ggx of the two widths. */
static void silk_without_anisotropy_is_ggx(void **state) {
    (void)state;
    Random random = {59};
    for (int n = 0; n < 100000; n++) {
        Lobe silk_lobe = lobe_default(LOBE_SILK), ggx = lobe_default(LOBE_GGX);
        float alpha = 0.001f + 0.999f * random_unit(&random);
        lobe_set(&silk_lobe, 0, alpha), lobe_set(&silk_lobe, 1, 0.0f);
        lobe_set(&ggx, 0, max(alpha, 1.0f / 1024.0f)), lobe_set(&ggx, 1, 0.0f);
        Dir o = random_direction(&random), i = random_direction(&random);
        LobeValue a = lobe_value(&silk_lobe, angles_between(o, i)), b = lobe_value(&ggx, angles_between(o, i));
        assert_true(fabsf(a.f - b.f) <= 1e-6f * b.f && fabsf(a.s - b.s) <= 0.0f);
        assert_true(fabsf(a.pdf - b.pdf) <= 1e-6f * b.pdf);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sheens_follow_the_formulas_of_their_papers),
        cmocka_unit_test(roughness_of_sheens_is_as_the_headers_state),
        cmocka_unit_test(exponential_lobes_follow_their_ramp),
        cmocka_unit_test(albedo_of_sheens_is_as_the_headers_state),
        cmocka_unit_test(fitted_norms_hold_in_their_worst_corners),
        cmocka_unit_test(cloth_conserves_energy_over_its_whole_range),
        cmocka_unit_test(sample_weights_of_sheens_are_bounded),
        cmocka_unit_test(threads_shift_their_color),
        cmocka_unit_test(flat_yarn_is_weighted_by_its_area),
        cmocka_unit_test(silk_without_anisotropy_is_ggx),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
