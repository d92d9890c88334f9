/* sample agrees with pdf: chi-square for every lobe of the registry and for stacks of them */

/* The grid of cases.h has the names of the one that is measured with. */
#define Grid           CasesGrid
#define grid_direction cases_grid_direction
#include "cases.h"
#undef Grid
#undef grid_direction

#include "measure/check/chi_square.h"

/* How many tests share the significance of 1 %: those of the stacks, and room for those of the lobes. */
enum { STACK_TESTS = 60, TESTS = 1600 };

static double significance(void) { return 1.0 - (pow)(1.0 - 0.01, 1.0 / TESTS); }

static ChiSquare measure(const BsdfView *view) {
    ChiSquare found;
    assert_true(chi_square_measure(view, test_long() ? 2000000 : test_short() ? 20000 : 60000, 20, 1, &found));
    return found;
}

static void check_proposal(const BsdfView *view, const char *name) {
    ChiSquare found = measure(view);
    if (!(found.integral <= 1.0 + 1e-3)) fail_msg("%s: the pdf integrates to %.5f", name, found.integral);
    if (found.stray) fail_msg("%s: %d samples with pdf 0", name, found.stray);
    if (!(found.p >= significance())) fail_msg("%s: sample and pdf disagree, p = %.2g", name, found.p);
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

static void lobe_samples_follow_their_pdf(void **state) {
    (void)state;
    int tests = 0, turn = 0;
    for (int e = 0; e < ELEVATIONS; e++)
        for (int id = 0; id < weft_lobe_count(); id++)
            for (int k = 0; k < case_count(id); k++) {
                Lobe lobe = case_lobe(id, k);
                if (k > 0 && samples_as_default(&lobe)) continue;
                if (!test_turn(&turn, 2, 7)) continue;
                tests++;
                Dir o = direction_cos(elevations[e], 0.4 + e);
                Bsdf bsdf;
                bsdf_of_lobe(&bsdf, &lobe, true);
                check_proposal(&(BsdfView){.bsdf = &bsdf, .o = o, .lobe = lobe}, case_name(&lobe, o).text);
            }
    print_message("%d proposals of lobes\n", tests);
    assert_true(tests <= TESTS - STACK_TESTS); /* else raise TESTS */
}

static void stack_pdf(const BsdfView *view, Dirs i, float *pdf) {
    for (size_t k = 0; k < i.n; k++) pdf[k] = seen_eval(&view->whole[0], dir(i.x[k], i.y[k], i.z[k]), 0).pdf;
}
static Dir stack_draw(const BsdfView *view, float u, float v) { return seen_sample(&view->whole[0], u, v); }
static const Bsdf stacked = {.pdf = stack_pdf, .sample = stack_draw};

static void stack_samples_follow_their_pdf(void **state) {
    (void)state;
    static AlbedoTable table;
    Random random = {7};
    for (int k = 0; k < (test_long() ? 30 : test_short() ? 3 : 12); k++) {
        fill_albedo(&table, (k % weft_lobe_count()));
        Surface surface = random_surface(&random, k % 2);
        if (k % 3 == 1) surface = dusted(surface, 0.1f * (float)k);
        for (int e = 1; e < ELEVATIONS; e += 2) {
            Dir o = direction_cos(elevations[e], 1.0 + k);
            BsdfView view = {.bsdf = &stacked, .o = o, .whole = {test_stack(&surface, k % LAYER_COUNT, &table, o)}};
            char name[64];
            snprintf(name, sizeof name, "surface %d cos_o=%g", k, (double)o.z);
            check_proposal(&view, name);
        }
    }
}

/* Directions below the surface are mirrored, so that they can be counted as those above are. */
static Dir mirrored(Dir i) { return dir(i.x, i.y, -i.z); }
static void through_pdf(const BsdfView *view, Dirs i, float *pdf) {
    for (size_t k = 0; k < i.n; k++) pdf[k] = seen_eval(&view->whole[0], mirrored(dir(i.x[k], i.y[k], i.z[k])), 0).pdf;
}
static Dir through_draw(const BsdfView *view, float u, float v) { return mirrored(seen_sample(&view->whole[0], u, v)); }
static const Bsdf through = {.pdf = through_pdf, .sample = through_draw};

static void stack_samples_that_go_through_follow_their_pdf(void **state) {
    (void)state;
    static AlbedoTable table;
    Random random = {9};
    fill_albedo(&table, LOBE_CHARLIE_CONTY_KULLA);
    for (int k = 0; k < 4; k++) {
        Surface surface = random_surface(&random, k % 2);
        surface.metallic = 0.0f;
        surface.diffuse_transmission = 0.3f + 0.2f * (float)k;
        surface.diffuse_transmission_color = surface.base_color;
        for (int side = 0; side < 2; side++) {
            Dir o = direction_cos(elevations[1 + k % 3], 1.0 + k);
            BsdfView view = {.bsdf = side ? &through : &stacked,
                             .o = o,
                             .whole = {test_stack(&surface, LAYER_ALBEDO_VIEW, &table, o)}};
            char name[64];
            snprintf(name, sizeof name, "thin surface %d %s cos_o=%g", k, side ? "below" : "above", (double)o.z);
            check_proposal(&view, name);
        }
    }
}

/* Lambert's pdf, 5 % too large in one half of the hemisphere and too small in the other. */
static void leaning_pdf(const BsdfView *view, Dirs i, float *pdf) {
    float lean = test_short() ? 0.2f : 0.05f; /* few samples see no less */
    for (size_t k = 0; k < i.n; k++) pdf[k] = i.z[k] / PI * (i.x[k] > 0.0f ? 1.0f + lean : 1.0f - lean);
}

/* A test that cannot fail would be none. */
static void chi_square_finds_a_wrong_pdf(void **state) {
    (void)state;
    Lobe lambert = lobe_default(LOBE_LAMBERT);
    Bsdf bsdf;
    bsdf_of_lobe(&bsdf, &lambert, true);
    for (int e = 0; e < ELEVATIONS; e++) {
        BsdfView view = {.bsdf = &bsdf, .o = direction_cos(elevations[e], 0.4 + e), .lobe = lambert};
        bsdf.pdf = leaning_pdf;
        ChiSquare found = measure(&view);
        assert_true(fabs(found.integral - 1.0) < 1e-3 && found.stray == 0);
        assert_true(found.p < significance());
    }
}

/* The pdf of ggx where alpha is 5 % larger than that of the samples. */
static void wide_pdf(const BsdfView *view, Dirs i, float *pdf) {
    Lobe wide = view->lobe;
    wide.params[0] *= test_short() ? 1.2f : 1.05f; /* few samples see no less */
    for (size_t k = 0; k < i.n; k++) pdf[k] = lobe_pdf(&wide, angles_between(view->o, dir(i.x[k], i.y[k], i.z[k])));
}

/* An error that the integral claims for itself could hide a wrong pdf where a peak is as narrow as a bin. */
static void chi_square_finds_a_width_that_is_slightly_wrong(void **state) {
    (void)state;
    Lobe ggx = lobe_default(LOBE_GGX);
    lobe_set(&ggx, 0, 0.05f);
    Bsdf bsdf;
    bsdf_of_lobe(&bsdf, &ggx, true);
    for (int e = 0; e < ELEVATIONS; e++) {
        BsdfView view = {.bsdf = &bsdf, .o = direction_cos(elevations[e], 0.4 + e), .lobe = ggx};
        bsdf_of_lobe(&bsdf, &ggx, true);
        assert_true(measure(&view).p >= significance());
        bsdf.pdf = wide_pdf;
        ChiSquare found = measure(&view);
        if (!(found.p < significance()))
            fail_msg("cos_o %g: a pdf 5 %% too wide passes, p = %.2g", elevations[e], found.p);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lobe_samples_follow_their_pdf),
        cmocka_unit_test(stack_samples_follow_their_pdf),
        cmocka_unit_test(stack_samples_that_go_through_follow_their_pdf),
        cmocka_unit_test(chi_square_finds_a_wrong_pdf),
        cmocka_unit_test(chi_square_finds_a_width_that_is_slightly_wrong),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
