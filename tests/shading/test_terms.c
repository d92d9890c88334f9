/* Every term of terms.h against its paper's formula in double precision, its norm, its sampler, its limits */
#include <complex.h>
#include <ctype.h>
#include <dirent.h>

#include "cases.h"
#include "shading/lobe/terms.h"

static const double alphas[] = {0.05, 0.1, 0.25, 0.5, 0.8, 1.0};
enum { ALPHAS = sizeof alphas / sizeof alphas[0] };

/* The widths of ggx-aniso at anisotropy 0.8: along x, across y. */
static double wide(double alpha) { return alpha + (1.0 - alpha) * 0.64; }

static float spread(int d, double alpha, Dir h) { return term_d(d, (float)alpha, (float)wide(alpha), (float)alpha, h); }
static float shadow(int v, double alpha, Angles a) {
    return term_v(v, (float)alpha, (float)wide(alpha), (float)alpha, a);
}

static double square(double x) { return x * x; }

static double power(double x, double y) { return (pow)(x, y); }
static double e_to(double x) { return (exp)(x); }
static double root(double x) { return (sqrt)(x); }

/* ---- D ---- */

/* The formula as printed, over the angles of h. */
static double paper_d(int d, double alpha, Dir h) {
    double x2 = square((double)h.x), y2 = square((double)h.y), z2 = square((double)h.z), all = x2 + y2 + z2;
    double c2 = z2 / all, s2 = (x2 + y2) / all, a2 = square(alpha);
    double rim = 1.0 / (PI_DOUBLE * (1.0 + 4.0 * a2));
    switch (d) {
    case D_BLINN_PHONG: /* log1p, since c2 has fewer digits than s2 near 1 */
        return e_to((1.0 / a2 - 1.0) * (s2 < 0.5 ? log1p(-s2) : log(c2))) / (PI_DOUBLE * a2);
    case D_BECKMANN: return e_to(-s2 / c2 / a2) / (PI_DOUBLE * a2 * square(c2));
    case D_GGX: return a2 / (PI_DOUBLE * square(c2 * a2 + s2));
    case D_GGX_ANISO: {
        double q = x2 / all / square(wide(alpha)) + y2 / all / a2 + c2;
        return 1.0 / (PI_DOUBLE * wide(alpha) * alpha * square(q));
    }
    case D_GTR1: return alpha < 1.0 ? (a2 - 1.0) / (PI_DOUBLE * log(a2) * (s2 + a2 * c2)) : 1.0 / PI_DOUBLE;
    case D_ASHIKHMIN: return rim * (1.0 + 4.0 * e_to(-c2 / s2 / a2) / square(s2));
    case D_CHARLIE: return (2.0 + 1.0 / alpha) * power(root(s2), 1.0 / alpha) / (2.0 * PI_DOUBLE);
    case D_CHARLIE_FLOORED: { /* the norm from its two parts: the cap where sin^2 < 1/128, and beyond */
        double n = 0.5 / alpha, cap = power(1.0 / 128.0, n + 1.0);
        return power(fmax(s2, 1.0 / 128.0), n) / (PI_DOUBLE * (cap + (1.0 - cap) / (n + 1.0)));
    }
    case D_INVERSE_GGX: return rim * (1.0 + 4.0 * square(a2) / square((c2 - a2 * c2) + a2));
    case D_VELVET: return e_to(-c2 / s2 / a2) / (PI_DOUBLE * a2 * square(s2));
    default: return -1.0;
    }
}

/* A half vector where D has something to say, or anywhere. */
static Dir random_half(Random *random, int d, double alpha, int n) {
    if (n % 2) return random_direction(random);
    float u = random_unit(random), v = random_unit(random);
    return term_facet(d, (float)alpha, (float)wide(alpha), (float)alpha, u, v);
}

/* Relative distance; where the value is next to nothing, of that. */
static double distance(double value, double exact, double nothing) {
    return fabs(value - exact) / fmax(fabs(exact), nothing);
}

static void distributions_follow_the_formulas_of_their_papers(void **state) {
    (void)state;
    for (int d = 0; d < D_COUNT; d++) {
        Random random = {41};
        double worst = 0.0;
        for (int n = 0; n < 30000; n++) {
            double alpha = n < 3000 ? alphas[n % ALPHAS] : 0.05 + 0.95 * (double)random_unit(&random);
            alpha = (double)(float)alpha;
            Dir h = random_half(&random, d, alpha, n);
            double ax = (double)(float)wide(alpha);
            if (fabs(ax / wide(alpha) - 1.0) > 1e-7) fail_msg("alpha_x is not %g", wide(alpha));
            worst = fmax(worst, distance((double)spread(d, alpha, h), paper_d(d, alpha, h), 1e-5));
        }
        print_message("D %-20s within %.1e of the formula\n", weft_term_name(WEFT_TERM_D, d), worst);
        if (!(worst < 2e-5)) fail_msg("D %s is off by %g", weft_term_name(WEFT_TERM_D, d), worst);
    }
    /* and one that is not it would be found */
    Dir h = direction(0.3, 0.4);
    assert_true(distance((double)spread(D_GGX, 0.2501, h), paper_d(D_GGX, 0.25, h), 1e-5) > 2e-5);
}

/* Integral of D cos_h over the hemisphere, of the float text. */
static double norm(int d, double alpha, double tested_alpha) {
    enum { THETAS = 1000, PHIS = 512 };
    int turns = d == D_GGX_ANISO ? PHIS : 1;
    double sum = 0.0;
    for (int j = 0; j < THETAS; j++) {
        double t = (j + 0.5) / THETAS, theta = stretch(t) * PI_DOUBLE / 2.0;
        double w = stretch_slope(t) / THETAS * PI_DOUBLE * PI_DOUBLE * (sin)(theta) * (cos)(theta) / turns;
        for (int k = 0; k < turns; k++) {
            Dir h = direction(theta, 2.0 * PI_DOUBLE * k / turns);
            sum += w * (double)spread(d, alpha, h);
        }
    }
    return sum * square(alpha / tested_alpha);
}

static void distributions_are_normalised(void **state) {
    (void)state;
    double worst = 0.0;
    for (int d = 0; d < D_COUNT; d++)
        for (int k = 0; k < ALPHAS; k++) {
            double off = fabs(norm(d, alphas[k], alphas[k]) - 1.0);
            worst = fmax(worst, off);
            if (!(off < 1e-3))
                fail_msg("D %s alpha %g: the norm is off by %g", weft_term_name(WEFT_TERM_D, d), alphas[k], off);
        }
    print_message("integrals of D cos_h are 1 to %.1e\n", worst);
    assert_true(worst < 5e-5);
    assert_true(fabs(norm(D_GGX, 0.25, 0.2505) - 1.0) > 1e-3); /* a norm with another alpha is found */
}

/* Upper tail of the chi-square distribution (Wilson, Hilferty 1931). */
static double chi_square_p(double statistic, int freedom) {
    double v = 2.0 / (9.0 * freedom), z = (cbrt(statistic / freedom) - (1.0 - v)) / root(v);
    return 0.5 * erfc(z / root(2.0));
}

/* Half vectors counted by tilt and azimuth. */
enum { RINGS = 48, SECTORS = 8 };
typedef struct Cells {
    double share[RINGS][SECTORS];
} Cells;

/* The share of D cos_h in each cell, as the paper has D. */
static Cells cells_expected(int d, double alpha) {
    enum { STEPS = 12 };
    int slices = d == D_GGX_ANISO ? 240 : 1; /* of a sector: a ridge may be thin */
    Cells cells;
    for (int j = 0; j < RINGS; j++)
        for (int k = 0; k < SECTORS; k++) {
            double sum = 0.0;
            for (int c = 0; c < STEPS * slices; c++) {
                double t = (j + (c / slices + 0.5) / STEPS) / RINGS, theta = stretch(t) * PI_DOUBLE / 2.0;
                double phi = 2.0 * PI_DOUBLE * (k + (c % slices + 0.5) / slices) / SECTORS;
                double cosine = (cos)(theta), sine = (sin)(theta);
                sum += paper_d(d, alpha, direction(theta, phi)) * sine * cosine * stretch_slope(t);
            }
            cells.share[j][k] = sum * PI_DOUBLE * PI_DOUBLE / (STEPS * slices * RINGS * SECTORS);
        }
    return cells;
}

/* The cells of count samples; u from a regular grid, or random. */
static Cells cells_seen(int d, double alpha, int count, bool regular) {
    Cells cells = {0};
    Random random = {43 + (uint64_t)(d * 1000.0 + 100.0 * alpha)};
    for (int n = 0; n < count; n++) {
        float v = random_unit(&random), u = regular ? ((float)n + 0.5f) / (float)count : random_unit(&random);
        Dir h = term_facet(d, (float)alpha, (float)wide(alpha), (float)alpha, u, v);
        float length = h.x * h.x + h.y * h.y + h.z * h.z;
        if (!(fabsf(length - 1.0f) < 1e-5f && h.z >= 0.0f))
            fail_msg("D %s alpha %g u %g: a facet (%g %g %g)", weft_term_name(WEFT_TERM_D, d), alpha, (double)u,
                     (double)h.x, (double)h.y, (double)h.z);
        double theta = atan2(hypot((double)h.x, (double)h.y), (double)h.z);
        double turn = atan2((double)h.y, (double)h.x) / (2.0 * PI_DOUBLE);
        int j = (int)(unstretch(theta / (PI_DOUBLE / 2.0)) * RINGS);
        int k = (int)((turn < 0.0 ? turn + 1.0 : turn) * SECTORS);
        cells.share[j < RINGS ? j : RINGS - 1][k < SECTORS ? k : SECTORS - 1] += 1.0 / count;
    }
    return cells;
}

enum { SAMPLES = 30000 };

/* p-value of random samples of one alpha against D of another. */
static double sampler_p(int d, double sampled_alpha, double alpha) {
    Cells expected = cells_expected(d, alpha), seen = cells_seen(d, sampled_alpha, SAMPLES, false);
    double statistic = 0.0, pool_seen = 0.0, pool = 0.0;
    int used = 0;
    for (int k = 0; k < SECTORS; k++)
        for (int j = 0; j < RINGS; j++) {
            pool += SAMPLES * expected.share[j][k];
            pool_seen += SAMPLES * seen.share[j][k];
            if (pool < 8.0) continue;
            statistic += square(pool_seen - pool) / pool;
            used++;
            pool = pool_seen = 0.0;
        }
    return chi_square_p(statistic, used - 1);
}

/* Where u alone decides the tilt, a regular grid of u meets the integral of D cos_h without noise: the
 * largest distance between the two as they grow with the tilt. */
static double tilt_distance(int d, double sampled_alpha, double alpha) {
    Cells expected = cells_expected(d, alpha), seen = cells_seen(d, sampled_alpha, SAMPLES, true);
    double apart = 0.0, sum = 0.0;
    for (int j = 0; j < RINGS; j++) {
        for (int k = 0; k < SECTORS; k++) sum += seen.share[j][k] - expected.share[j][k];
        apart = fmax(apart, fabs(sum));
    }
    return apart;
}

static void samples_of_h_follow_their_distribution(void **state) {
    (void)state;
    const double significance = 1.0 - power(1.0 - 0.01, 1.0 / (D_COUNT * (ALPHAS + 1)));
    for (int d = 0; d < D_COUNT; d++) {
        const char *id = weft_term_name(WEFT_TERM_D, d);
        bool by_u = d != D_GGX_ANISO;
        double least = 1.0, apart = 0.0;
        for (int k = 0; k <= ALPHAS; k++) {
            double alpha = k ? alphas[k - 1] : 0.005;
            double p = sampler_p(d, alpha, alpha);
            if (p < significance) fail_msg("D %s alpha %g: sampler and D disagree, p = %.2g", id, alpha, p);
            least = fmin(least, p);
            if (by_u) apart = fmax(apart, tilt_distance(d, alpha, alpha));
        }
        double wrong_p = sampler_p(d, 0.2, 0.25), wrong = tilt_distance(d, 0.245, 0.25); /* found? */
        print_message("sampler of %-12s least p %.3f, integral met to %.1e; wrong alphas: %.1e, %.1e\n", id, least,
                      apart, wrong_p, wrong);
        assert_true(apart < 4e-4);
        assert_true(wrong_p < significance && (wrong > 4e-4 || !by_u));
    }
}

/* The limits that the files of the terms speak of. */
static void distributions_have_their_limits(void **state) {
    (void)state;
    double beyond = 0.0, gtr1 = 0.0;
    for (int n = 0; n <= 200; n++) {
        float alpha = 0.005f * (float)(pow)(200.0, n / 200.0), z = (float)(pow)(10.0, -5.0 - n / 20.0);
        beyond = fmax(beyond, (double)beckmann_d(alpha, dir(1.0f, 0.0f, z)));
        beyond = fmax(beyond, (double)velvet_d(alpha, dir(z, 0.0f, 1.0f)));
        double d = (double)gtr1_d(1.0f, direction(PI_DOUBLE / 400.0 * n, 0.0));
        gtr1 = fmax(gtr1, fabs(d * PI_DOUBLE - 1.0));
    }
    print_message("beckmann and velvet where they are 0: %.1e; gtr1 of 1 off by %.1e\n", beyond, gtr1);
    assert_true(beyond < 2e-14 && gtr1 < 7e-7);
}

/* ---- V ---- */

static double smith_walter(double alpha, double cos_w) { /* Equation 27 */
    double c = cos_w / (alpha * root(1.0 - square(cos_w)));
    return c < 1.6 ? (3.535 * c + 2.181 * square(c)) / (1.0 + 2.276 * c + 2.577 * square(c)) : 1.0;
}
static double smith_ggx(double alpha, double cos_w) { /* Equation 34 */
    return 2.0 / (1.0 + root(1.0 + square(alpha) * (1.0 / square(cos_w) - 1.0)));
}
/* Heitz 2014, Equations 72 and 86 */
static double lambda_ggx(double ax, double ay, Dir w) {
    double tan2 = (square(ax * (double)w.x) + square(ay * (double)w.y)) / square((double)w.z);
    return 0.5 * (root(1.0 + tan2) - 1.0);
}
/* Conty Estevez, Kulla 2017, Table 1 */
static double conty_l(double alpha, double x) {
    static const double of_0[] = {25.3245, 3.32435, 0.16801, -1.27393, -4.85967};
    static const double of_1[] = {21.5473, 3.82987, 0.19823, -1.97760, -4.32054};
    double p[5], t = square(1.0 - alpha);
    for (int k = 0; k < 5; k++) p[k] = t * of_0[k] + (1.0 - t) * of_1[k];
    return p[0] / (1.0 + p[1] * power(x, p[2])) + p[3] * x + p[4];
}
static double lambda_conty(double alpha, double x) {
    return x < 0.5 ? e_to(conty_l(alpha, x)) : e_to(2.0 * conty_l(alpha, 0.5) - conty_l(alpha, 1.0 - x));
}

/* G as printed. */
static double paper_g(int v, double alpha, Dir wo, Dir wi) {
    double o = (double)wo.z, i = (double)wi.z;
    double x = (double)wo.x + (double)wi.x, y = (double)wo.y + (double)wi.y, z = o + i;
    double s = root(x * x + y * y + z * z), h = z / s, d = s / 2.0, k;
    switch (v) {
    case V_IMPLICIT: return o * i;
    case V_NEUMANN: return o * i / fmax(o, i);
    case V_COOK_TORRANCE: return fmin(1.0, fmin(2.0 * h * o / d, 2.0 * h * i / d));
    case V_KELEMEN: return o * i / square(d);
    case V_SMITH_BECKMANN: return smith_walter(alpha, o) * smith_walter(alpha, i);
    case V_SMITH_GGX: return smith_ggx(alpha, o) * smith_ggx(alpha, i);
    case V_SMITH_GGX_CORRELATED: return 1.0 / (1.0 + lambda_ggx(alpha, alpha, wo) + lambda_ggx(alpha, alpha, wi));
    case V_SMITH_GGX_ANISO:
        return 1.0 / (1.0 + lambda_ggx(wide(alpha), alpha, wo) + lambda_ggx(wide(alpha), alpha, wi));
    case V_SMITH_GGX_ANISO_SEPARATE:
        return 1.0 / (1.0 + lambda_ggx(wide(alpha), alpha, wo)) / (1.0 + lambda_ggx(wide(alpha), alpha, wi));
    case V_URP: { /* its D V with 1.00001 inside, over its D without */
        double q = 1.0 - (1.0 - square(alpha)) * square(h);
        return 4.0 * o * i * square(q / (q + 1e-5)) / (fmax(0.1, square(d)) * (4.0 * alpha + 2.0));
    }
    case V_SMITH_GGX_FAST: return 2.0 * o * i / (o * (i * (1.0 - alpha) + alpha) + i * (o * (1.0 - alpha) + alpha));
    case V_SCHLICK_BECKMANN: k = alpha * root(2.0 / PI_DOUBLE); break;
    case V_SCHLICK_GGX: k = alpha / 2.0; break;
    case V_NEUBELT: return o * i / (o + i - o * i);
    case V_NEUBELT_CLAMPED: return fmin(o * i / (o + i - o * i), 4.0 * o * i);
    case V_CONTY_KULLA: return 1.0 / (1.0 + lambda_conty(alpha, o) + lambda_conty(alpha, i));
    case V_CONTY_KULLA_SOFT: /* section 4: the power on the side of the light */
        return 1.0 / (1.0 + lambda_conty(alpha, o) + power(lambda_conty(alpha, i), 1.0 + 2.0 * power(1.0 - i, 8.0)));
    case V_CONTY_KULLA_CLAMPED: return fmin(paper_g(V_CONTY_KULLA, alpha, wo, wi), 4.0 * o * i);
    default: return -1.0;
    }
    return o / (o * (1.0 - k) + k) * i / (i * (1.0 - k) + k);
}

static void visibility_terms_follow_the_formulas_of_their_papers(void **state) {
    (void)state;
    for (int v = 0; v < V_COUNT; v++) {
        Random random = {47};
        double worst = 0.0, highest = 0.0, other_way = 0.0;
        for (int n = 0; n < 30000; n++) {
            double alpha = (double)(float)(0.05 + 0.95 * (double)random_unit(&random));
            Dir o = random_direction(&random), i = random_direction(&random);
            float value = shadow(v, alpha, angles_between(o, i));
            double g = paper_g(v, alpha, o, i), cosines = 4.0 * (double)o.z * (double)i.z;
            worst = fmax(worst, distance((double)value, g / cosines, 1e-12));
            highest = fmax(highest, (double)value * cosines);
            other_way = fmax(other_way, distance((double)shadow(v, alpha, angles_between(i, o)), (double)value, 1e-12));
        }
        bool reciprocal = !strstr(weft_term_help(WEFT_TERM_V, v), "not reciprocal");
        if (reciprocal != (other_way < 1e-6))
            fail_msg("V %s is %g off the other way round", weft_term_name(WEFT_TERM_V, v), other_way);
        print_message("V %-20s within %.1e of the formula, G at most %.5f\n", weft_term_name(WEFT_TERM_V, v), worst,
                      highest);
        if (!(worst < 2e-5)) fail_msg("V %s is off by %g", weft_term_name(WEFT_TERM_V, v), worst);
        /* none passes more than there is; Walter's fit does, by 6e-5 for each direction; urp has F inside */
        if (v != V_URP) assert_true(highest < (v == V_SMITH_BECKMANN ? 1.0 + 1.3e-4 : 1.0 + 1e-6));
    }
    Dir o = direction(1.2, 0.0), i = direction(1.0, 2.0);
    double cosines = 4.0 * (double)o.z * (double)i.z;
    double other = paper_g(V_SMITH_GGX, 0.2501, o, i) / cosines;
    assert_true(distance((double)shadow(V_SMITH_GGX, 0.25, angles_between(o, i)), other, 1e-12) > 2e-5);
}

/* Finite to cosines of 1e-6 and far below, where the two directions are the same, mirrored, or opposite; and
 * to 1e-6 no floor changes the value by more than 1 %. */
static void visibility_terms_are_finite(void **state) {
    (void)state;
    static const double low[] = {1e-6, 2e-6, 1e-4, 0.1, 1.0}, turns[] = {0.0, 1e-3, 1.0, PI_DOUBLE - 1e-3, PI_DOUBLE};
    for (int v = 0; v < V_COUNT; v++) {
        double highest = 0.0;
        for (int n = 0; n < 5 * 5 * 5 * ALPHAS; n++) {
            double alpha = n < 125 ? 0.005 : alphas[n / 125];
            Dir o = direction_cos(low[n % 5], 0.0), i = direction_cos(low[n / 5 % 5], turns[n / 25 % 5]);
            double value = (double)shadow(v, alpha, angles_between(o, i));
            if (!(value >= 0.0 && value <= 1e12))
                fail_msg("V %s of %g and %g is %g", weft_term_name(WEFT_TERM_V, v), (double)o.z, (double)i.z, value);
            highest = fmax(highest, value);
            o = dir(1.0f, 0.0f, 1e-30f);
            value = (double)shadow(v, alpha, angles_between(o, i.z < 0.5f ? dir(i.x, i.y, 1e-30f) : i));
            assert_true(value >= 0.0 && value <= 1e20);
        }
        print_message("V %-20s at most %.1e\n", weft_term_name(WEFT_TERM_V, v), highest);
    }
}

/* Smith's masking is that by which the facets that wo sees fill what wo sees of the surface:
 * integral of G1(wo) D(h) max(wo . h, 0) = cos_o. With wi = n, G is G1(wo). */
static double seen_share(int d, int v, double alpha, double cos_o) {
    enum { THETAS = 400, PHIS = 400 };
    Dir o = direction_cos(cos_o, 0.7), n = dir(0.0f, 0.0f, 1.0f);
    double sum = 0.0;
    for (int j = 0; j < THETAS; j++) {
        double t = (j + 0.5) / THETAS, theta = stretch(t) * PI_DOUBLE / 2.0;
        for (int k = 0; k < PHIS; k++) {
            Dir h = direction(theta, 2.0 * PI_DOUBLE * (k + 0.5) / PHIS);
            double facing = fmax((double)dir_dot(o, h), 0.0);
            sum += paper_d(d, alpha, h) * facing * (sin)(theta)*stretch_slope(t);
        }
    }
    sum *= PI_DOUBLE / 2.0 * 2.0 * PI_DOUBLE / (THETAS * PHIS);
    return 4.0 * (double)shadow(v, alpha, angles_between(o, n)) * sum; /* 4 V = G1 / cos_o */
}

static void smith_visibility_belongs_to_its_distribution(void **state) {
    (void)state;
    static const int pairs[][2] = {{D_GGX, V_SMITH_GGX},
                                   {D_GGX, V_SMITH_GGX_CORRELATED},
                                   {D_GGX_ANISO, V_SMITH_GGX_ANISO},
                                   {D_BECKMANN, V_SMITH_BECKMANN}};
    static const double cosines[] = {0.8, 0.4, 0.1};
    for (int p = 0; p < 4; p++) {
        double worst = 0.0;
        for (int k = 0; k < 9; k++) {
            double alpha = alphas[1 + 2 * (k % 3)];
            worst = fmax(worst, fabs(seen_share(pairs[p][0], pairs[p][1], alpha, cosines[k / 3]) - 1.0));
        }
        print_message("masking %-20s of D %-10s is exact to %.1e\n", weft_term_name(WEFT_TERM_V, pairs[p][1]),
                      weft_term_name(WEFT_TERM_D, pairs[p][0]), worst);
        assert_true(worst < (p == 3 ? 4e-3 : 1e-3)); /* Walter's is a fit */
    }
    assert_true(fabs(seen_share(D_BLINN_PHONG, V_SMITH_GGX, 0.5, 0.1) - 1.0) > 0.01);
}

/* ---- F ---- */

/* Fresnel's equations by complex amplitudes: covers dielectrics (k = 0) and total reflection. */
static double paper_f(double n, double k, double cos_i) {
    double complex index = n + k * (double complex)_Complex_I;
    double complex cos_t = csqrt(1.0 - (1.0 - cos_i * cos_i) / (index * index));
    double complex rs = (cos_i - index * cos_t) / (cos_i + index * cos_t);
    double complex rp = (index * cos_i - cos_t) / (index * cos_i + cos_t);
    return 0.5 * (square(cabs(rs)) + square(cabs(rp)));
}

static double paper_share(int f, double n, double k, double c) {
    if (f == F_NONE) return 0.0;
    if (f == F_SCHLICK || f == F_SCHLICK_F90) return power(1.0 - c, 5.0);
    if (f == F_SCHLICK_GAUSSIAN) return power(2.0, (-5.55473 * c - 6.98316) * c);
    double extinction = f == F_CONDUCTOR ? k : 0.0, normal = paper_f(n, extinction, 1.0);
    return fmax((paper_f(n, extinction, c) - normal) / (1.0 - normal), 0.0);
}

static void fresnel_terms_follow_the_formulas_of_their_papers(void **state) {
    (void)state;
    for (int f = 0; f < F_COUNT; f++) {
        if (f == F_COOK_TORRANCE) continue; /* it has no share */
        Random random = {53};
        double worst = 0.0;
        for (int n = 0; n < 30000; n++) {
            double ior = (double)(float)power(10.0, -1.3 + 2.3 * (double)random_unit(&random));
            double k = n % 3 ? 20.0 * square((double)random_unit(&random)) : 0.0;
            float c = random_unit(&random) + 1e-5f;
            k = (double)(float)k;
            double s = (double)term_f(f, (float)ior, (float)k, min(c, 1.0f));
            assert_true(s >= 0.0 && s <= 1.0);
            /* at the critical angle the slope is infinite, and what a float rounds is seen */
            bool lossless = f != F_CONDUCTOR || k < 0.1;
            if (lossless && fabs(square(ior) - 1.0 + square((double)c)) < 0.01) continue;
            worst = fmax(worst, fabs(s - paper_share(f, ior, k, (double)min(c, 1.0f))));
        }
        for (int n = 0; n < 50; n++) { /* both ends, for anything */
            float ior = 0.05f + 0.2f * (float)n, k = (float)(n % 7) * 3.0f;
            assert_true(term_f(f, ior, k, 1.0f) < (f == F_SCHLICK_GAUSSIAN ? 1.7e-4f : 2e-6f));
            float grazing = term_f(f, ior, k, 1e-12f);
            if (f != F_NONE && fabsf(ior - 1.0f) > 0.1f) assert_true(grazing > 0.999f);
        }
        print_message("F %-14s share within %.1e of the formula\n", weft_term_name(WEFT_TERM_F, f), worst);
        if (!(worst < 2e-5)) fail_msg("F %s is off by %g", weft_term_name(WEFT_TERM_F, f), worst);
    }
    assert_true(fabs((double)term_f(F_DIELECTRIC, 1.5f, 0.0f, 0.3f) - paper_share(F_DIELECTRIC, 1.501, 0, 0.3)) > 2e-5);
    assert_true(fabs((double)term_f(F_CONDUCTOR, 1.5f, 3.0f, 0.3f) - paper_share(F_CONDUCTOR, 1.5, 3.01, 0.3)) > 2e-5);
}

static void fresnel_terms_have_their_limits(void **state) {
    (void)state;
    double apart = 0.0;
    for (int n = 1; n <= 1000; n++) {
        float c = (float)n / 1000.0f, before = c - 1e-3f;
        assert_true(term_f(F_SCHLICK, 1.5f, 0.0f, before) > term_f(F_SCHLICK, 1.5f, 0.0f, c));
        assert_true(term_f(F_DIELECTRIC, 1.5f, 0.0f, before) >= term_f(F_DIELECTRIC, 1.5f, 0.0f, c));
        for (int k = 0; k < 20; k++) {
            float ior = 0.05f + 0.5f * (float)k, s = term_f(F_DIELECTRIC, ior, 0.0f, c);
            apart = fmax(apart, (double)fabsf(s - term_f(F_CONDUCTOR, ior, 0.0f, c)));
        }
        /* nothing happens at an interface between equals */
        for (int f = F_DIELECTRIC; f <= F_CONDUCTOR; f++) assert_true(term_f(f, 1.0f, 0.0f, c) < 1e-6f);
        /* total reflection: beyond asin(0.5) from within */
        if (c < 0.86f) assert_true(term_f(F_DIELECTRIC, 0.5f, 0.0f, c) > 1.0f - 1e-6f);
    }
    print_message("dielectric and conductor of k = 0 are %.1e apart\n", apart);
    assert_true(apart < 2e-6);
    assert_true(term_f(F_DIELECTRIC, 0.5f, 0.0f, 0.9f) < 0.5f);
    /* the second colours */
    static const float seconds[F_COUNT] = {
        [F_NONE] = 0.3f,          [F_SCHLICK] = 1.0f,    [F_SCHLICK_F90] = 0.7f, [F_SCHLICK_GAUSSIAN] = 0.7f,
        [F_COOK_TORRANCE] = 1.0f, [F_DIELECTRIC] = 1.0f, [F_CONDUCTOR] = 1.0f};
    for (int f = 0; f < F_COUNT; f++) assert_float_equal(term_second(f, 0.3f, 0.7f), seconds[f], 0.0f);
}

/* Karis, "Specular BRDF Reference", 2013: the index is that of F0, channel by channel and whatever weight the
 * colour has. */
static void cook_torrance_fresnel_takes_its_index_from_f0(void **state) {
    (void)state;
    assert_float_equal(fresnel_weight_mix(term_f(F_COOK_TORRANCE, 1.5f, 3.0f, 0.15f), 0.638f, 1.0f), 0.478f, 5e-4f);
    Random random = {57};
    double worst = 0.0;
    for (int n = 0; n < 30000; n++) {
        float f_0 = 0.97f * random_unit(&random) + 1e-4f, c = random_unit(&random) + 1e-5f, w = 0.01f + 3.0f * c;
        double r = root((double)f_0), index = (1.0 + r) / (1.0 - r);
        float s = term_f(F_COOK_TORRANCE, 0.05f + random_unit(&random), 0.0f, c);
        double f = (double)fresnel_weight_mix(s, w * f_0, w * term_second(F_COOK_TORRANCE, f_0, 0.3f)) / (double)w;
        worst = fmax(worst, fabs(f - paper_f(index, 0.0, fmin((double)c, 1.0))));
        assert_float_equal(fresnel_weight_uncolored(s), term_f(F_SCHLICK, 1.5f, 0.0f, c), 1e-7f);
    }
    print_message("F cook-torrance within %.1e of the formula\n", worst);
    assert_true(worst < 1e-5);
    for (int n = 0; n <= 10; n++) { /* white, black, and the edge */
        float s = term_f(F_COOK_TORRANCE, 1.5f, 0.0f, 0.1f * (float)n);
        assert_true(fresnel_weight_mix(s, 0.0f, 1.0f) < (n ? 1e-6f : 1.0f + 1e-6f));
        if (n) assert_float_equal(fresnel_weight_mix(s, 1.0f, 1.0f), 1.0f, 2e-3f);
    }
}

/* How far the exact curves dip below normal incidence, which the shares leave out. */
static double dip(double n, double k) {
    double least = 1.0;
    for (int c = 1; c <= 4000; c++) least = fmin(least, paper_f(n, k, c / 4000.0));
    return paper_f(n, k, 1.0) - least;
}

static void dips_of_fresnel_terms_have_the_stated_size(void **state) {
    (void)state;
    static const double metals[][2] = {{1.10, 6.80}, {0.27, 2.95}, {0.05, 3.30}, {2.91, 3.08}, {3.18, 3.31}};
    double worst = 0.0;
    for (int m = 0; m < 5; m++) {
        assert_true(dip(metals[m][0], metals[m][1]) > 1e-4);
        worst = fmax(worst, dip(metals[m][0], metals[m][1]));
    }
    print_message("F of metals dips by up to %.3f, of a dielectric of 4 by %.4f\n", worst, dip(4.0, 0.0));
    assert_true(worst < 0.065);
    assert_true(dip(3.72, 0.0) < 1e-9 && dip(3.8, 0.0) > 1e-7);
}

/* ---- the lists, and the lobe made of them ---- */

static const char kind_letters[] = "dvf";
static const int counts[] = {D_COUNT, V_COUNT, F_COUNT};

/* A file for every id and an id for every file; these two ids share the file of another. */
static bool has_no_file(const char *id) { return strcmp(id, "none") == 0 || strcmp(id, "schlick-f90") == 0; }

static void every_term_has_a_file_and_a_row(void **state) {
    (void)state;
    int files = 0, rows = 0;
    DIR *folder = opendir(WEFT_SOURCE_DIR "/src/shading/terms");
    assert_non_null(folder);
    for (struct dirent *entry; (entry = readdir(folder));) {
        const char *letter = strchr(kind_letters, entry->d_name[0]);
        if (!letter || entry->d_name[1] != '_') continue;
        char id[64] = {0};
        size_t length = strlen(entry->d_name);
        assert_true(length > 4 && length < sizeof id);
        for (size_t k = 2; k < length - 2; k++) id[k - 2] = entry->d_name[k] == '_' ? '-' : entry->d_name[k];
        WeftTermKind kind = (WeftTermKind)(letter - kind_letters);
        int term = 0;
        while (weft_term_name(kind, term) && strcmp(weft_term_name(kind, term), id) != 0) term++;
        if (!weft_term_name(kind, term)) fail_msg("terms/%s has no row in terms.h", entry->d_name);
        files++;
    }
    closedir(folder);
    for (int kind = 0; kind < 3; kind++) {
        for (int k = 0; k < counts[kind]; k++) {
            const char *id = weft_term_name((WeftTermKind)kind, k), *help = weft_term_help((WeftTermKind)kind, k);
            assert_non_null(id);
            assert_true(islower((unsigned char)id[0]) && strlen(help) > 10 && strlen(help) < 70);
            for (int j = 0; j < k; j++) assert_string_not_equal(id, weft_term_name((WeftTermKind)kind, j));
            rows += !has_no_file(id);
        }
        assert_null(weft_term_name((WeftTermKind)kind, counts[kind]));
        assert_null(weft_term_help((WeftTermKind)kind, -1));
    }
    assert_int_equal(files, rows);
    assert_null(weft_term_name((WeftTermKind)3, 0));
}

/* The choices of the lobe are these lists, in this order. */
static void cook_torrance_offers_every_term(void **state) {
    (void)state;
    static const char *const names[] = {"d", "v", "f"};
    for (int kind = 0; kind < 3; kind++) {
        int param = weft_lobe_param_find(LOBE_COOK_TORRANCE, names[kind]);
        assert_true(param >= 0);
        const WeftParamInfo *row = &weft_lobe_info(LOBE_COOK_TORRANCE)->params[param];
        assert_non_null(row->choices);
        assert_int_equal((int)row->hard_high, counts[kind] - 1);
        for (int k = 0; k < counts[kind]; k++)
            assert_string_equal(row->choices[k], weft_term_name((WeftTermKind)kind, k));
        assert_null(row->choices[counts[kind]]);
    }
}

static Lobe composed(int d, int v, int f, float alpha, float stretch) {
    static const char *const names[] = {"alpha", "d", "v", "f", "stretch"};
    const float values[] = {alpha, (float)d, (float)v, (float)f, stretch};
    Lobe lobe = lobe_default((int)LOBE_COOK_TORRANCE);
    for (int k = 0; k < 5; k++) {
        int param = weft_lobe_param_find(LOBE_COOK_TORRANCE, names[k]);
        assert_true(param >= 0);
        lobe_set(&lobe, param, values[k]);
    }
    return lobe;
}

/* What is in the catalogue under a name of its own comes out of the same two terms. */
static void known_lobes_equal_their_composed_terms(void **state) {
    (void)state;
    static const struct Same {
        int id;
        int d, v;
        float anisotropy;
    } same[] = {{LOBE_GGX, D_GGX, V_SMITH_GGX_CORRELATED, 0.0f},
                {LOBE_GGX, D_GGX_ANISO, V_SMITH_GGX_ANISO, 0.7f},
                {LOBE_CHARLIE_NEUBELT, D_CHARLIE, V_NEUBELT, 0.0f},
                {LOBE_CHARLIE_CONTY_KULLA, D_CHARLIE, V_CONTY_KULLA, 0.0f}};
    Random random = {59};
    for (int n = 0; n < 4000; n++) {
        const struct Same *s = &same[n % 4];
        float alpha = 0.01f + 0.99f * random_unit(&random);
        float stretch = mix(alpha, 1.0f, s->anisotropy * s->anisotropy) / alpha;
        Lobe own = lobe_default((int)s->id), made = composed(s->d, s->v, F_SCHLICK, alpha, stretch);
        lobe_set(&own, 0, alpha);
        if (s->id == LOBE_GGX) lobe_set(&own, 1, s->anisotropy);
        Angles a = angles_between(random_direction(&random), random_direction(&random));
        LobeValue x = lobe_value(&own, a), y = lobe_value(&made, a);
        assert_true(distance((double)y.f, (double)x.f, 1e-20) < 2e-6 + 4e-7 / (double)alpha);
        if (s->id == LOBE_GGX) assert_float_equal(x.s, y.s, 1e-7f);
    }
}

/* Every D with every V: the mean weight of the samples is E, one by one and over arrays. */
static void every_pair_of_d_and_v_can_be_sampled(void **state) {
    (void)state;
    enum { N = 4000 };
    static const double cosines[] = {0.9, 0.15};
    double heaviest = 0.0, highest = 0.0;
    int over = 0;
    for (int k = 0; k < D_COUNT * V_COUNT * 2; k++) {
        int d = k / 2 % D_COUNT, v = k / 2 / D_COUNT;
        Lobe lobe = composed(d, v, F_NONE, k % 3 ? 0.25f : 0.6f, 2.0f);
        Dir o = direction_cos(cosines[k % 2], 0.4);
        double e = (double)albedo_quadrature(&lobe, o, 1e-4).f0, sum = 0.0, squares = 0.0, heavy = 0.0;
        Random random = {61 + (uint64_t)k};
        for (int n = 0; n < N; n++) {
            float u = ((float)n + random_unit(&random)) / N;
            Dir i = lobe_sample(&lobe, o, u, random_unit(&random));
            if (i.z <= 0.0f) continue;
            LobeValue value = lobe_value(&lobe, angles_between(o, i));
            double weight = (double)(value.f * i.z / value.pdf);
            sum += weight;
            squares += weight * weight;
            heavy = fmax(heavy, weight);
        }
        double mean = sum / N, error = root(fmax(squares / N - mean * mean, 0.0) / N);
        if (fabs(mean - e) > 4.5 * error + 1e-3)
            fail_msg("d=%s v=%s cos_o=%g: E %.4f, sampling %.4f +- %.4f", weft_term_name(WEFT_TERM_D, d),
                     weft_term_name(WEFT_TERM_V, v), (double)o.z, e, mean, error);
        heaviest = fmax(heaviest, heavy);
        highest = fmax(highest, e);
        over += e > 1.0 + 1e-3;
    }
    print_message("%d pairs, cos_o 0.9 and 0.15: largest weight %.1f, largest E %.2f, E > 1 in %d of %d\n",
                  D_COUNT * V_COUNT, heaviest, highest, over, D_COUNT * V_COUNT * 2);
    assert_true(heaviest < 40.0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(distributions_follow_the_formulas_of_their_papers),
        cmocka_unit_test(distributions_are_normalised),
        cmocka_unit_test(samples_of_h_follow_their_distribution),
        cmocka_unit_test(distributions_have_their_limits),
        cmocka_unit_test(visibility_terms_follow_the_formulas_of_their_papers),
        cmocka_unit_test(visibility_terms_are_finite),
        cmocka_unit_test(smith_visibility_belongs_to_its_distribution),
        cmocka_unit_test(fresnel_terms_follow_the_formulas_of_their_papers),
        cmocka_unit_test(fresnel_terms_have_their_limits),
        cmocka_unit_test(cook_torrance_fresnel_takes_its_index_from_f0),
        cmocka_unit_test(dips_of_fresnel_terms_have_the_stated_size),
        cmocka_unit_test(every_term_has_a_file_and_a_row),
        cmocka_unit_test(cook_torrance_offers_every_term),
        cmocka_unit_test(known_lobes_equal_their_composed_terms),
        cmocka_unit_test(every_pair_of_d_and_v_can_be_sampled),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
