/* The random walk against what is known of the slab: its phase function, single scattering, conservation,
 * reciprocity, figures published with another program, and the published table's own rule */
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
#include "measure/check/chi_square.h"
#include "shading/media/fibre_medium.h"
#include "walks.h"

static const double degree = PI_DOUBLE / 180.0;
static Judge all;

/* ---- one flake ------------------------------------------------------------------------------------------
 */

/* The sphere about the fibres' axis, cut where a flake's light is: with y = asinh((nu + nu_i) / s) cells are
 * even, since D falls off from nu = -nu_i over a width of s. */
typedef struct Sphere {
    double s, nu, low, high; /* nu: of wi; the range of y */
    double e[3][3];          /* two unit vectors across the axis, and the axis */
} Sphere;

static Sphere sphere_make(const WalkMedium *m, const double wi[3]) {
    Sphere sphere = {.s = m->s};
    double *x = sphere.e[0], *y = sphere.e[1], *t = sphere.e[2], r = hypot(m->axis[0], m->axis[2]);
    memcpy(t, m->axis, sizeof m->axis);
    x[0] = t[2] / r, x[2] = -t[0] / r; /* the axes of these tests are not along y */
    for (int c = 0; c < 3; c++) {
        int a = (c + 1) % 3, b = (c + 2) % 3;
        y[c] = t[a] * x[b] - t[b] * x[a];
        sphere.nu += wi[c] * t[c];
    }
    sphere.low = asinh((sphere.nu - 1.0) / m->s);
    sphere.high = asinh((sphere.nu + 1.0) / m->s);
    return sphere;
}

/* The direction at (u, v) of the unit square, and the solid angle per unit of its area. */
static double sphere_at(const Sphere *sphere, double u, double v, double w[3]) {
    double range = sphere->high - sphere->low, y = sphere->low + range * u, phi = 2.0 * PI_DOUBLE * v;
    double nu = fmin(fmax(sphere->s * sinh(y) - sphere->nu, -1.0), 1.0), r = (sqrt)(1.0 - nu * nu);
    for (int c = 0; c < 3; c++)
        w[c] = r * (cos)(phi)*sphere->e[0][c] + r * (sin)(phi)*sphere->e[1][c] + nu * sphere->e[2][c];
    return sphere->s * cosh(y) * range * 2.0 * PI_DOUBLE;
}

static void sphere_place(const Sphere *sphere, const double w[3], double *u, double *v) {
    double at[3] = {0.0, 0.0, 0.0};
    for (int k = 0; k < 3; k++)
        for (int c = 0; c < 3; c++) at[k] += w[c] * sphere->e[k][c];
    double phi = atan2(at[1], at[0]) / (2.0 * PI_DOUBLE);
    *u = (asinh((at[2] + sphere->nu) / sphere->s) - sphere->low) / (sphere->high - sphere->low);
    *v = phi - (floor)(phi);
}

static const double flakes[][5] = {
    /* alpha, tilt, and wi: mu, phi; how far a midpoint sum may err */
    {0.0323, 0.0, 0.01, 0.3, 1e-3},   {0.0323, 0.0, 0.9, 0.3, 1e-3}, {0.05, 30.0, 0.3, 2.0, 1e-3},
    {0.2, 20.0, 0.2, 1.0, 3e-4},      {0.2, 0.0, 0.99, 1.0, 3e-4},   {0.5, 45.0, 0.5, -2.0, 3e-4},
    {0.5, 10.0, 0.9848, 0.001, 3e-4}, {1.0, 0.0, 0.7, 0.0, 1e-6},
};
enum { FLAKES = sizeof flakes / sizeof flakes[0] };

static WalkMedium flake_medium(int k, double wi[3]) {
    WalkDesc desc = slab(flakes[k][0], 1.0, 1.0, flakes[k][1] * degree);
    set_direction(wi, flakes[k][2], flakes[k][3]);
    return walk_medium(&desc);
}

/* Heitz et al., equation of the phase function: the integral of D / (4 sigma) over wo is 1. */
static void phase_function_integrates_to_one(void **state) {
    (void)state;
    enum { CELLS = 500 };
    for (int k = 0; k < FLAKES; k++) {
        double wi[3], w[3], sum = 0.0;
        WalkMedium m = flake_medium(k, wi);
        Sphere sphere = sphere_make(&m, wi);
        for (int a = 0; a < CELLS; a++)
            for (int b = 0; b < CELLS; b++) {
                double area = sphere_at(&sphere, (a + 0.5) / CELLS, (b + 0.5) / CELLS, w);
                sum += walk_phase(&m, wi, w) * area / ((double)CELLS * CELLS);
            }
        print_message("alpha %.4f tilt %2.0f mu_i %.2f: 1 %+.1e\n", flakes[k][0], flakes[k][1], flakes[k][2],
                      sum - 1.0);
        assert_true(fabs(sum - 1.0) < flakes[k][4]);
    }
}

static Dir to_dir(const double w[3]) { return dir((float)w[0], (float)w[1], (float)w[2]); }

/* A point of the sphere for the shading text, whose flake wants it from outside. */
static void text_turn(const WalkMedium *m, const double wi[3], uint64_t number, double out[3]) {
    uint64_t stream = stream_start(6, number);
    double point[3], z = 2.0 * unit_double(stream_next(&stream)) - 1.0;
    set_direction(point, z, 2.0 * PI_DOUBLE * unit_double(stream_next(&stream)));
    Dir d = flake_scatter((float)m->s, to_dir(m->axis), to_dir(wi), to_dir(point));
    out[0] = (double)d.x, out[1] = (double)d.y, out[2] = (double)d.z;
}

static void walk_away(const WalkMedium *m, const double wi[3], uint64_t number, double out[3]) {
    Walker walker = walk_start(wi, 5, number);
    walk_scatter(m, &walker);
    memcpy(out, walker.d, sizeof walker.d);
}

/* Directions in bins against the integral of p over each. */
static double turn_p(int k, void (*turn)(const WalkMedium *, const double *, uint64_t, double *)) {
    enum { BINS = 16, CELLS = 20, SIDE = BINS * CELLS };
    static Bin bins[BINS * BINS];
    /* never more than 200,000, which would find the errors of the sums */
    long long few = test_walks(2e5), count = few < 200000 ? few : 200000;
    double wi[3], w[3], u, v;
    WalkMedium m = flake_medium(k, wi);
    Sphere sphere = sphere_make(&m, wi);
    memset(bins, 0, sizeof bins);
    for (int a = 0; a < SIDE; a++)
        for (int b = 0; b < SIDE; b++) {
            double area = sphere_at(&sphere, (a + 0.5) / SIDE, (b + 0.5) / SIDE, w) / ((double)SIDE * SIDE);
            bins[a / CELLS * BINS + b / CELLS].expected += (double)count * walk_phase(&m, wi, w) * area;
        }
    for (long long n = 0; n < count; n++) {
        turn(&m, wi, (uint64_t)n, w);
        sphere_place(&sphere, w, &u, &v);
        int row = (int)fmin(fmax(u * BINS, 0.0), BINS - 1), column = (int)fmin(v * BINS, BINS - 1);
        bins[row * BINS + column].seen += 1.0;
    }
    return chi_square_bins(bins, BINS * BINS);
}

static void sampled_flakes_follow_the_phase_function(void **state) {
    (void)state;
    double least = 1.0, limit = 1.0 - (pow)(0.99, 1.0 / (2 * FLAKES));
    for (int k = 0; k < 2 * FLAKES; k++) {
        double p = turn_p(k / 2, k % 2 ? text_turn : walk_away);
        least = fmin(least, p);
        if (!(p > limit))
            fail_msg("%s, alpha %g tilt %g mu_i %g: p = %.2g", k % 2 ? "text" : "walk", flakes[k / 2][0],
                     flakes[k / 2][1], flakes[k / 2][2], p);
    }
    print_message("the least of %d p values: %.2g\n", 2 * FLAKES, least);
}

/* The same formulas in single and in double precision, and what the text does at its ends. */
static void medium_of_the_shading_text_is_that_of_the_walks(void **state) {
    (void)state;
    uint64_t stream = stream_start(3, 0);
    double worst = 0.0;
    for (int n = 0; n < 100000; n++) {
        double u[7], wi[3], wo[3];
        for (int k = 0; k < 7; k++) u[k] = unit_double(stream_next(&stream));
        WalkDesc desc = slab(0.03 * (pow)(1.0 / 0.03, u[0]), 1.0, 1.0, n % 2 ? u[1] : 0.0);
        WalkMedium m = walk_medium(&desc);
        set_direction(wi, 2.0 * u[2] - 1.0, 7.0 * u[3]);
        set_direction(wo, 2.0 * u[4] - 1.0, 7.0 * u[5]);
        Dir i = to_dir(wi), o = to_dir(wo), t = to_dir(m.axis), h = dir(i.x + o.x, i.y + o.y, i.z + o.z);
        float s = (float)m.s, sigma = flake_sigma(s, dir_dot(i, t));
        double reference = walk_phase(&m, wi, wo), q = (double)dir_dot(h, h);
        double found = (double)(0.25f * flake_d(s, dir_dot(h, h), dir_dot(i, t) + dir_dot(o, t)) / sigma);
        /* a ridge of width s magnifies what rounding does to nu, and so does a short half vector */
        double error = fabs(found / reference - 1.0), sigma2 = (double)(sigma * sigma);
        double rounding = 1e-6 * (1.0 / (m.s * (sqrt)(q)) + 1.0 / sigma2);
        worst = fmax(worst, error / rounding);
        assert_true(error < rounding);
    }
    print_message("phase function of the text: at most %.2f of what rounding explains\n", worst);
}

/* Down to what lobes may be asked, all is finite; where x is small, 1 - exp(-x) keeps its digits. */
static void medium_of_the_shading_text_is_finite_at_its_limits(void **state) {
    (void)state;
    static const float cosines[] = {1e-30f, 1e-20f, 1e-7f, 1e-3f, 0.5f, 0.999999f, 1.0f};
    static const float tilts[] = {0.0f, 1e-4f, 0.7f, 1.57079633f};
    for (int n = 0; n < 7 * 7 * 4 * 4 * 3 * 2; n++) {
        float mu = cosines[n % 7], nu = cosines[n / 7 % 7], tilt = tilts[n / 49 % 4];
        float phi = (float)(n / 196 % 4) * 1.57079633f, s = n / 784 % 3 ? n / 784 % 3 == 1 ? 1.0f : 9e-4f : 1e-4f;
        float r = (sqrtf)(1.0f - mu * mu), q = (sqrtf)(1.0f - nu * nu), thickness = n / 2352 ? 8.0f : 0.01f;
        Dir o = dir(r, 0.0f, mu), i = dir(q * (cosf)(phi), q * (sinf)(phi), nu);
        if (n / 196 % 4 == 2) i = dir(-q, 0.0f, nu);
        float f = flake_single(s, flake_axis(tilt, 0.0f), thickness, o, i);
        float g = flake_single(s, flake_axis(tilt, 0.0f), thickness, i, o);
        assert_true(isfinite(f) && f >= 0.0f && !(f < g || f > g));
        Dir d = flake_scatter(s, flake_axis(tilt, 0.0f), o, dir(-o.x, -o.y, -o.z));
        assert_true(isfinite(d.x + d.y + d.z));
    }
    for (double x = 1e-8; x < 80.0; x *= 1.1) {
        double reference = -expm1(-x) / x, found = (double)flake_visibility((float)x, 1.0f, 1.0f) / (double)(float)x;
        assert_true(fabs(found / reference - 1.0) < 6e-7);
    }
}

/* ---- one flake and no more --------------------------------------------------------------------------------
 */

static const double slabs[][6] = {
    /* alpha, thickness, albedo, tilt, and wo: mu, phi */
    {0.35, 1.0, 1.0, 0.0, 0.1, 0.0}, {0.5, 1.0, 1.0, 0.0, 0.4, 0.0},  {0.5, 2.0, 0.8, 0.0, 0.4, 0.0},
    {0.8, 0.25, 1.0, 0.0, 0.7, 0.0}, {0.6, 1.0, 1.0, 30.0, 0.5, 0.4}, {0.4, 4.0, 0.5, 45.0, 0.2, 2.5},
    {1.0, 1.0, 1.0, 0.0, 0.05, 0.0}, {0.7, 0.5, 0.3, 20.0, 0.9, 1.0},
};
enum { SLABS = sizeof slabs / sizeof slabs[0] };

static WalkDesc slab_of(int k) { return slab(slabs[k][0], slabs[k][1], slabs[k][2], slabs[k][3] * degree); }
static const char *slab_name(int k) {
    static char text[120];
    snprintf(text, sizeof text, "alpha %g thickness %g albedo %g tilt %g mu %g", slabs[k][0], slabs[k][1], slabs[k][2],
             slabs[k][3], slabs[k][4]);
    return text;
}

static double single(int k, const double wo[3], const double wi[3]) {
    Dir t = flake_axis((float)(slabs[k][3] * degree), 0.0f);
    float s = (float)(slabs[k][0] * slabs[k][0]);
    return slabs[k][2] * (double)flake_single(s, t, (float)slabs[k][1], to_dir(wo), to_dir(wi));
}

/* R of one flake: a midpoint sum of f1 mu over mu = x^2 and phi. */
static void walks_of_one_flake_return_single_scattering(void **state) {
    (void)state;
    enum { CELLS = 300 };
    for (int k = 0; k < SLABS; k++) {
        double wo[3], wi[3], sum = 0.0;
        WalkCount count = run(slab_of(k), slabs[k][4], slabs[k][5], 1e5, NULL);
        set_direction(wo, slabs[k][4], slabs[k][5]);
        for (int a = 0; a < CELLS; a++)
            for (int b = 0; b < CELLS; b++) {
                double x = (a + 0.5) / CELLS, mu = x * x;
                set_direction(wi, mu, 2.0 * PI_DOUBLE * (b + 0.5) / CELLS);
                sum += single(k, wo, wi) * mu * 2.0 * x * 2.0 * PI_DOUBLE / ((double)CELLS * CELLS);
            }
        WalkEstimate once = walk_share(count.reflected_single, count.walks);
        judge(&all, slab_name(k), once.mean, sum, once.error);
    }
}

/* The same at single directions: what next-event estimation finds from the second flake on, and f1. */
static void f_of_walks_is_single_plus_multiple_scattering(void **state) {
    (void)state;
    enum { PLACES = 3 };
    for (int k = 0; k < SLABS; k++) {
        double wo[3], wi[3 * PLACES];
        WalkEstimate rest[PLACES], whole[PLACES];
        set_direction(wo, slabs[k][4], slabs[k][5]);
        set_direction(wi, 0.3, 0.5), set_direction(wi + 3, 0.7, 2.0), set_direction(wi + 6, 0.95, -1.0);
        WalkDesc desc = slab_of(k);
        desc.directions = PLACES, desc.wi = wi, desc.multiple = true;
        run(desc, slabs[k][4], slabs[k][5], 6e4, rest);
        desc.multiple = false, desc.seed = next_seed();
        run(desc, slabs[k][4], slabs[k][5], 6e4, whole);
        for (int p = 0; p < PLACES; p++)
            judge(&all, slab_name(k), whole[p].mean, rest[p].mean + single(k, wo, wi + 3 * p),
                  hypot(rest[p].error, whole[p].error));
    }
}

/* ---- all flakes
 * -------------------------------------------------------------------------------------------- */

static void every_walk_ends_above_below_or_absorbed(void **state) {
    (void)state;
    for (int k = 0; k < SLABS; k++) {
        WalkCount c = run(slab_of(k), slabs[k][4], slabs[k][5], 2e4, NULL);
        assert_true(c.walks >= test_walks(2e4) && c.walks % WALK_BATCHES == 0);
        assert_true(c.reflected + c.transmitted + c.absorbed == c.walks);
        assert_true((c.absorbed == 0) == (slabs[k][2] >= 1.0));
        assert_true(c.reflected_single <= c.reflected && c.reflected <= c.flakes);
    }
    /* black flakes let through what misses them, which is Beer's law; no fibres let through all */
    WalkDesc black = slab(0.5, 0.7, 0.0, 30.0 * degree);
    WalkCount c = run(black, 0.6, 1.0, 1e5, NULL);
    WalkMedium m = walk_medium(&black);
    double wo[3];
    set_direction(wo, 0.6, 1.0);
    WalkEstimate through = walk_share(c.transmitted, c.walks);
    assert_true(c.reflected == 0 && c.flakes == c.absorbed);
    judge(&all, "black", through.mean, (exp)(-walk_sigma(&m, wo) * 0.7 / 0.6), through.error);
    c = run(slab(0.5, 0.0, 1.0, 0.0), 0.6, 0.0, 1e3, NULL);
    assert_true(c.transmitted == c.walks && c.flakes == 0);
}

/* The walk forth and the walk back share nothing but the medium. */
static void f_of_walks_is_reciprocal(void **state) {
    (void)state;
    static const double pairs[][3] = {{0.15, 0.6, 0.5}, {0.3, 0.3, 3.0}, {0.9, 0.4, 1.5}};
    for (int k = 0; k < SLABS; k++)
        for (int p = 0; p < 3; p++) {
            double o[3], i[3];
            WalkEstimate forth, back;
            WalkDesc desc = slab_of(k);
            set_direction(o, pairs[p][0], 1.0), set_direction(i, pairs[p][1], 1.0 + pairs[p][2]);
            desc.directions = 1, desc.wi = i;
            run(desc, pairs[p][0], 1.0, 6e4, &forth);
            desc.wi = o, desc.seed = next_seed();
            run(desc, pairs[p][1], 1.0 + pairs[p][2], 6e4, &back);
            judge(&all, slab_name(k), forth.mean, back.mean, hypot(forth.error, back.error));
        }
}

/* f mu over the hemisphere is what the walks count: a midpoint sum over mu = x^2 and phi. */
static void f_of_walks_integrates_to_their_albedo(void **state) {
    (void)state;
    enum { RINGS = 16, SPOKES = 12, PLACES = RINGS * SPOKES };
    for (int k = 1; k < SLABS; k += 3) {
        double wi[3 * PLACES], sum = 0.0, error = 0.0;
        WalkEstimate f[PLACES];
        for (int n = 0; n < PLACES; n++) {
            double x = (n / SPOKES + 0.5) / RINGS;
            set_direction(wi + 3 * n, x * x, 2.0 * PI_DOUBLE * (n % SPOKES) / SPOKES);
        }
        WalkDesc desc = slab_of(k);
        desc.directions = PLACES, desc.wi = wi;
        WalkCount count = run(desc, slabs[k][4], slabs[k][5], 1e4, f);
        for (int n = 0; n < PLACES; n++) {
            double x = (n / SPOKES + 0.5) / RINGS;
            double weight = 2.0 * x * x * x * 2.0 * PI_DOUBLE / PLACES;
            sum += f[n].mean * weight;
            error += f[n].error * weight; /* at the most, since they share their walks */
        }
        WalkEstimate r = walk_share(count.reflected, count.walks);
        print_message("%s: R %.4f +- %.4f, integral of f mu %.4f +- %.4f\n", slab_name(k), r.mean, r.error, sum, error);
        assert_true(fabs(sum - r.mean) < 3.0 * hypot(r.error, error));
    }
}

/* ---- figures of others
 * -------------------------------------------------------------------------------------- */

/* R by a program that knows no chance, which adds and doubles layers: alpha, thickness, albedo, tilt, mu,
 * phi, R and how well that is known; and the walks to take. */
static void albedo_of_walks_equals_published_doubling(void **state) {
    (void)state;
    static const double figures[][9] = {
        {1.0 / 31.0, 1.0, 1.0, 0.0, 0.01, 0.0, 0.29060, 1e-4, 3e4},
        {2.0 / 31.0, 1.0, 1.0, 0.0, 0.01, 0.0, 0.53068, 1e-4, 3e4},
        {3.0 / 31.0, 1.0, 1.0, 0.0, 1.0 / 31.0, 0.0, 0.36555, 1e-4, 3e4},
        {0.5, 2.0, 0.8, 0.0, 0.4, 0.0, 0.126135, 1e-5, 5e5},
        {0.25, 1.0, 1.0, 0.0, 0.95, 0.0, 3.2129e-4, 1e-7, 1e6},
        {0.6, 1.0, 1.0, 30.0, 0.5, 0.4, 0.12751, 1e-5, 5e5},
        {0.5, 1.0, 1.0, 45.0, 0.5, 0.4, 0.05725, 4e-5, 5e5},
    };
    for (size_t k = 0; k < sizeof figures / sizeof figures[0]; k++) {
        const double *n = figures[k];
        WalkCount count = run(slab(n[0], n[1], n[2], n[3] * degree), n[4], n[5], n[8], NULL);
        WalkEstimate r = walk_share(count.reflected, count.walks);
        char name[64];
        snprintf(name, sizeof name, "alpha %.4f mu %.4f", n[0], n[4]);
        print_message("%s: R %.5f +- %.5f, theirs %.5f\n", name, r.mean, r.error, n[6]);
        judge(&all, name, r.mean, n[6], hypot(r.error, n[7]));
    }
}

/* Zeltner, Burley and Chiang's table of R (the program is published with the talk): a walk ends with its 16th
 * flake, and what is then inside counts as reflected where the last direction points up. Their values at
 * three entries come out by that rule, and by no other. */
static void walks_cut_after_16_flakes_give_the_published_table(void **state) {
    (void)state;
    static const double entries[][3] = {
        {1.0 / 31.0, 0.01, 0.05839}, {2.0 / 31.0, 0.01, 0.38834}, {3.0 / 31.0, 1.0 / 31.0, 0.29827}};
    const long long walks = test_walks(1e5), theirs = 2000000;
    for (int k = 0; k < 3; k++) {
        WalkDesc desc = slab(entries[k][0], 1.0, 1.0, 0.0);
        WalkMedium m = walk_medium(&desc);
        long long up = 0, still_inside = 0;
        set_direction(desc.wo, entries[k][1], 0.0);
        for (long long n = 0; n < walks; n++) {
            Walker walker = walk_start(desc.wo, 1, (uint64_t)n);
            int flake = 0;
            while (flake < 16 && walk_fly(&m, &walker)) walk_scatter(&m, &walker), flake++;
            up += walker.d[2] > 0.0;
            still_inside += flake == 16;
        }
        WalkEstimate r = walk_share(up, walks);
        double error = hypot(r.error, walk_share((long long)(entries[k][2] * (double)theirs), theirs).error);
        print_message("alpha %.4f mu %.4f: %.5f +- %.5f, the table %.5f; %.0f %% are cut off\n", entries[k][0],
                      entries[k][1], r.mean, r.error, entries[k][2], 100.0 * (double)still_inside / (double)walks);
        judge(&all, "the talk's table", r.mean, entries[k][2], error);
    }
}

/* ---- the estimates themselves
 * -------------------------------------------------------------------------------- */

static void walks_with_any_number_of_threads_are_the_same(void **state) {
    (void)state;
    double wi[3];
    WalkEstimate f[2];
    WalkCount count[2];
    set_direction(wi, 0.5, 2.0);
    for (int k = 0; k < 2; k++) {
        WalkDesc desc = slab(0.3, 1.0, 0.9, 0.3);
        desc.directions = 1, desc.wi = wi, desc.seed = 1, desc.threads = 1 + 2 * k;
        count[k] = run(desc, 0.4, 0.0, 1e4, &f[k]);
    }
    assert_memory_equal(&f[0], &f[1], sizeof f[0]);
    assert_memory_equal(&count[0], &count[1], sizeof count[0]);
}

/* Runs of other seeds scatter about their mean as their standard errors say. */
static void standard_errors_of_walks_match_their_scatter(void **state) {
    (void)state;
    enum { RUNS = 200 };
    double wi[3], mean = 0.0, squares = 0.0, said = 0.0;
    WalkEstimate f[RUNS];
    set_direction(wi, 0.6, 1.0);
    for (int k = 0; k < RUNS; k++) {
        WalkDesc desc = slab(0.6, 1.0, 1.0, 0.0);
        desc.directions = 1, desc.wi = wi;
        run(desc, 0.4, 0.0, 2560, &f[k]);
        mean += f[k].mean / RUNS;
    }
    for (int k = 0; k < RUNS; k++) {
        squares += (f[k].mean - mean) * (f[k].mean - mean) / (RUNS - 1);
        said += f[k].error * f[k].error / RUNS;
    }
    print_message("variance over seeds is %.3f of what is said\n", squares / said);
    assert_true(fabs(squares / said - 1.0) < 4.0 * (sqrt)(2.0 / RUNS)); /* of a chi-square, 4 deviations */
}

/* A test that cannot fail would be none: a medium wrong by a fiftieth is found. */
static void walks_in_a_wrong_medium_are_told_apart(void **state) {
    (void)state;
    WalkCount right = run(slab(0.5, 1.0, 1.0, 0.0), 0.4, 0.0, 4e5, NULL);
    WalkCount wrong = run(slab(0.51, 1.0, 1.0, 0.0), 0.4, 0.0, 4e5, NULL);
    WalkEstimate a = walk_share(right.reflected, right.walks), b = walk_share(wrong.reflected, wrong.walks);
    if (test_walks(10.0) < 10) skip();
    assert_true(fabs(a.mean - b.mean) > judge_limit() * hypot(a.error, b.error));
}

static int end(void **state) {
    (void)state;
    judge_print(&all);
    return 0;
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(phase_function_integrates_to_one),
        cmocka_unit_test(sampled_flakes_follow_the_phase_function),
        cmocka_unit_test(medium_of_the_shading_text_is_that_of_the_walks),
        cmocka_unit_test(medium_of_the_shading_text_is_finite_at_its_limits),
        cmocka_unit_test(walks_of_one_flake_return_single_scattering),
        cmocka_unit_test(f_of_walks_is_single_plus_multiple_scattering),
        cmocka_unit_test(every_walk_ends_above_below_or_absorbed),
        cmocka_unit_test(f_of_walks_is_reciprocal),
        cmocka_unit_test(f_of_walks_integrates_to_their_albedo),
        cmocka_unit_test(albedo_of_walks_equals_published_doubling),
        cmocka_unit_test(walks_cut_after_16_flakes_give_the_published_table),
        cmocka_unit_test(walks_with_any_number_of_threads_are_the_same),
        cmocka_unit_test(standard_errors_of_walks_match_their_scatter),
        cmocka_unit_test(walks_in_a_wrong_medium_are_told_apart),
    };
    return cmocka_run_group_tests(tests, NULL, end);
}
