/* sample agrees with pdf: chi-square for every lobe of the registry and for stacks of them */
#include "cases.h"

/* Something to sample: a lobe or a stack. */
typedef struct Proposal {
    const Lobe *lobe;
    const Stack *stack;
} Proposal;

static float proposal_pdf(Proposal p, Dir o, Dir i) {
    return p.stack ? stack_eval(p.stack, o, i, 0).pdf : lobe_pdf(p.lobe, angles_between(o, i));
}

static Dir proposal_sample(Proposal p, Dir o, float u, float v) {
    return p.stack ? stack_sample(p.stack, o, u, v) : lobe_sample(p.lobe, o, u, v);
}

/* Bins along one side of the grid, and cells along one side of a bin for the integral of the pdf. */
enum { BINS = 20, CELLS = 20, ALL_BINS = BINS * BINS + 1 }; /* the last counts "no sample" */

/* The grid's directions and the solid angle of each, in the order of the bins; kept until another is asked
 * for.
 */
enum { BIN_CELLS = CELLS * CELLS, ALL_CELLS = BINS * BINS * BIN_CELLS };
static float cell_x[ALL_CELLS], cell_y[ALL_CELLS], cell_z[ALL_CELLS];
static double cell_area[ALL_CELLS];

static void fill_cells(Grid grid) {
    static Grid last = {-1.0, 0.0};
    if (memcmp(&last, &grid, sizeof grid) == 0) return;
    last = grid;
    const double step = 2.0 / (BINS * CELLS);
    for (int k = 0; k < ALL_CELLS; k++) {
        int bin = k / BIN_CELLS, cell = k % BIN_CELLS;
        int row = bin / BINS * CELLS + cell / CELLS, column = bin % BINS * CELLS + cell % CELLS;
        double area;
        Dir i = grid_direction(grid, -1.0 + step * (row + 0.5), -1.0 + step * (column + 0.5), &area);
        cell_x[k] = i.x, cell_y[k] = i.y, cell_z[k] = i.z;
        cell_area[k] = area * step * step;
    }
}

/* The expected share of each bin; returns the integral over the hemisphere. */
static double integrate_pdf(Proposal p, Dir o, Grid grid, double *share) {
    float ox[BIN_CELLS], oy[BIN_CELLS], oz[BIN_CELLS], pdf[BIN_CELLS];
    for (int k = 0; k < BIN_CELLS; k++) ox[k] = o.x, oy[k] = o.y, oz[k] = o.z;
    fill_cells(grid);
    double all = 0.0;
    for (int bin = 0; bin < BINS * BINS; bin++) {
        const float *x = cell_x + bin * BIN_CELLS, *y = cell_y + bin * BIN_CELLS,
                    *z = cell_z + bin * BIN_CELLS;
        if (p.lobe) lobe_pdf_n(p.lobe, BIN_CELLS, ox, oy, oz, x, y, z, pdf);
        share[bin] = 0.0;
        for (int k = 0; k < BIN_CELLS; k++) {
            if (z[k] <= 0.0f) continue;
            if (p.stack) pdf[k] = stack_eval(p.stack, o, dir(x[k], y[k], z[k]), 0).pdf;
            share[bin] += (double)pdf[k] * cell_area[bin * BIN_CELLS + k];
        }
        all += share[bin];
    }
    return all;
}

/* Upper tail of the chi-square distribution (Edwin B. Wilson, Margaret M. Hilferty, "The Distribution of
 * Chi-square", 1931). */
static double chi_square_p(double statistic, int freedom) {
    double v = 2.0 / (9.0 * freedom), z = (cbrt(statistic / freedom) - (1.0 - v)) / (sqrt)(v);
    return 0.5 * erfc(z / (sqrt)(2.0));
}

typedef struct Bin {
    double expected, seen;
} Bin;

static int by_expectation(const void *a, const void *b) {
    double x = ((const Bin *)a)->expected, y = ((const Bin *)b)->expected;
    return (x > y) - (x < y);
}

/* p-value of the counts; bins of little expectation are counted as one. */
static double test_bins(Bin *bins) {
    qsort(bins, ALL_BINS, sizeof *bins, by_expectation);
    double statistic = 0.0;
    int used = 0;
    Bin pool = {0};
    for (int k = 0; k < ALL_BINS; k++) {
        pool.expected += bins[k].expected;
        pool.seen += bins[k].seen;
        if (pool.expected < 8.0 && k + 1 < ALL_BINS) continue;
        double d = pool.seen - pool.expected;
        statistic += d * d / pool.expected;
        used++;
        pool = (Bin){0};
    }
    return used > 1 ? chi_square_p(statistic, used - 1) : 1.0;
}

/* How many tests share the significance of 1 %: those of the stacks, and room for those of the lobes. */
enum { STACK_TESTS = 60, TESTS = 1000 };

static void check_proposal(Proposal p, Dir o, const char *name) {
    static double share[BINS * BINS];
    static Bin bins[ALL_BINS];
    Grid grid = grid_about(o);
    double all = integrate_pdf(p, o, grid, share), count = test_long() ? 2e6 : test_short() ? 2e4 : 6e4;
    if (all > 1.0 + 1e-3) fail_msg("%s: the pdf integrates to %.5f", name, all);

    for (int k = 0; k < ALL_BINS; k++) bins[k] = (Bin){.expected = k < BINS * BINS ? count * share[k] : 0.0};
    bins[ALL_BINS - 1].expected = count * (all < 1.0 ? 1.0 - all : 0.0);
    Random random = {1};
    double valid = 0.0;
    for (int n = 0; n < (int)count; n++) {
        float u = random_unit(&random), v = random_unit(&random);
        Dir i = proposal_sample(p, o, u, v);
        int k = ALL_BINS - 1;
        if (i.z > 0.0f) {
            double s, t;
            grid_place(grid, i, &s, &t);
            int row = (int)((s + 1.0) * 0.5 * BINS), column = (int)((t + 1.0) * 0.5 * BINS);
            k = (row < BINS ? row : BINS - 1) * BINS + (column < BINS ? column : BINS - 1);
            valid += 1.0;
            if (!(proposal_pdf(p, o, i) > 0.0f)) fail_msg("%s: a sample with pdf 0", name);
        }
        bins[k].seen += 1.0;
    }
    double fraction = valid / count, sigma = (sqrt)(fraction * (1.0 - fraction) / count);
    if (fabs(fraction - all) > 5.0 * sigma + 1e-3)
        fail_msg("%s: %.5f of the samples are valid, the pdf integrates to %.5f", name, fraction, all);
    double value = test_bins(bins), significance = 1.0 - (pow)(1.0 - 0.01, 1.0 / TESTS);
    if (value < significance) fail_msg("%s: sample and pdf disagree, p = %.2g", name, value);
}

static const double elevations[] = {1.0, 0.9, 0.5, 0.15, 0.02};
enum { ELEVATIONS = sizeof elevations / sizeof elevations[0] };

/* Whether a case samples as the default does: a parameter that only f sees needs no second test. */
static bool samples_as_default(const Lobe *lobe) {
    Lobe first = lobe_default(lobe->id);
    Random random = {21};
    for (int n = 0; n < 100; n++) {
        Angles a = angles_between(random_direction(&random), random_direction(&random));
        float u = random_unit(&random), v = random_unit(&random), p = lobe_pdf(lobe, a);
        Dir i = lobe_sample(lobe, a.o, u, v), j = lobe_sample(&first, a.o, u, v);
        if (p != lobe_pdf(&first, a) || i.x != j.x || i.y != j.y || i.z != j.z) return false;
    }
    return true;
}

static void lobes_sample_what_their_pdf_says(void **state) {
    (void)state;
    int tests = 0, turn = 0;
    for (int e = 0; e < ELEVATIONS; e++)
        for (int id = 0; id < weft_lobe_count(); id++)
            for (int k = 0; k < case_count(id); k++) {
                Lobe lobe = case_lobe(id, k);
                if (k > 0 && samples_as_default(&lobe)) continue;
                if (!test_turn(&turn, 1, 7)) continue;
                tests++;
                Dir o = direction_cos(elevations[e], 0.4 + e);
                check_proposal((Proposal){.lobe = &lobe}, o, case_name(&lobe, o).text);
            }
    print_message("%d proposals of lobes\n", tests);
    assert_true(tests <= TESTS - STACK_TESTS); /* else raise TESTS */
}

static void stacks_sample_what_their_pdf_says(void **state) {
    (void)state;
    static AlbedoTable table;
    Random random = {7};
    for (int k = 0; k < (test_long() ? 30 : test_short() ? 3 : 12); k++) {
        fill_albedo(&table, (k % weft_lobe_count()));
        Surface surface = random_surface(&random, k % 2);
        for (int e = 1; e < ELEVATIONS; e += 2) {
            Dir o = direction_cos(elevations[e], 1.0 + k);
            Stack stack = test_stack(&surface, k % LAYER_COUNT, &table, o);
            char name[64];
            snprintf(name, sizeof name, "surface %d cos_o=%g", k, (double)o.z);
            check_proposal((Proposal){.stack = &stack}, o, name);
        }
    }
}

/* A test that cannot fail would be none: a pdf that is 5 % off somewhere is found. */
static void a_wrong_pdf_is_found(void **state) {
    (void)state;
    static Bin bins[ALL_BINS];
    Random random = {3};
    for (int k = 0; k < ALL_BINS; k++) bins[k].expected = 1e5 / ALL_BINS * (k % 2 ? 1.05 : 0.95);
    for (int n = 0; n < 100000; n++) bins[random_bits(&random) % ALL_BINS].seen += 1.0;
    assert_true(test_bins(bins) < 1e-6);
    for (int k = 0; k < ALL_BINS; k++) bins[k] = (Bin){.expected = 1e5 / ALL_BINS};
    for (int n = 0; n < 100000; n++) bins[random_bits(&random) % ALL_BINS].seen += 1.0;
    assert_true(test_bins(bins) > 1e-3);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lobes_sample_what_their_pdf_says),
        cmocka_unit_test(stacks_sample_what_their_pdf_says),
        cmocka_unit_test(a_wrong_pdf_is_found),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
