/* The baked tables of fibres: that of the catalogue against the solved slab where nothing was fitted, a small
 * one made anew, and the transformed cosines of ltc-fibre fitted again */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "fibre/solver_reference.h"
#include "shading/albedo.h"
#include "shading/lobe_tables.h"
#include "shading/registry.h"
#include "weft/weft.h"

static Lobe lobe_at_alpha(int id, double alpha) {
    Lobe lobe = lobe_default(id);
    lobe_set(&lobe, 0, (float)alpha);
    return lobe;
}

static void lobe_from_the_table_follows_the_solved_slab(void **state) {
    (void)state;
    if (getenv("WEFT_TEST_SHORT")) skip();
    enum { ALPHAS = 4 };
    static const double alpha[ALPHAS] = {0.231, 0.41, 0.63, 0.9}, white[] = {1.0};
    SolvedGrid grid = {ALPHAS, 1, 0, 1, 24, 5, alpha, white, NULL, 1.0};
    SolvedSet set;
    double mean = 0.0;
    assert_true(solved_set_make(&grid, 0, NULL, NULL, &set));
    for (int s = 0; s < set.count; s++) {
        const SolvedSlab *t = &set.slabs[s];
        Lobe lobe = lobe_at_alpha(LOBE_FIBRE_TABLE, t->slab.alpha);
        double *f = calloc((size_t)t->pairs, sizeof *f);
        FitError error;
        assert_non_null(f);
        for (int p = 0; p < t->pairs; p++) {
            double wi[3], wo[3];
            solved_pair(t, p, wi, wo);
            Dir i = dir((float)wi[0], (float)wi[1], (float)wi[2]),
                o = dir((float)wo[0], (float)wo[1], (float)wo[2]);
            f[p] = (double)lobe_eval(&lobe, angles_between(o, i)) - solved_single_scatter(t, p);
        }
        assert_true(solved_error(t, f, &error));
        free(f);
        mean += error.mean / ALPHAS;
        if (!(error.worst < 0.02 && error.albedo < 5e-3 && error.most < 1.0))
            fail_msg("alpha %g: worst %g, R %g", t->slab.alpha, error.worst, error.albedo);
    }
    if (!(mean < 0.005)) fail_msg("mean %g", mean);
    solved_set_free(&set);
}

static WeftImage baked(const char *kind, const WeftLobe *lobe, int width, int height, int threads) {
    WeftImage table;
    WeftError error = {0};
    WeftBakeDesc desc = {.kind = kind, .lobe = lobe, .width = width, .height = height, .threads = threads};
    if (weft_bake(&desc, NULL, &table, &error) != WEFT_OK) fail_msg("%s", error.text);
    assert_int_equal(table.channels, 4);
    return table;
}

/* The same on any number of threads, every number a half float. */
static void small_table_is_baked_the_same_again(void **state) {
    (void)state;
    WeftImage one = baked("fibre-table", NULL, 4, 2, 1), two = baked("fibre-table", NULL, 4, 2, 2);
    const float *a = one.pixels, *b = two.pixels;
    for (int k = 0; k < 4 * 2 * 4; k++) {
        int exponent;
        double part = ldexp(frexp((double)a[k], &exponent), 11);
        assert_true(a[k] >= b[k] && a[k] <= b[k]);
        assert_true(exponent < -13 || part == (rint)(part));
    }
    weft_image_free(&one);
    weft_image_free(&two);
    WeftError error;
    WeftBakeDesc narrow = {.kind = "fibre-table", .width = 1, .height = 4};
    assert_int_not_equal(weft_bake(&narrow, NULL, &one, &error), WEFT_OK);
}

/* One row of the catalogue's table against E of fibre by quadrature, and z, q, b within their ranges. */
static void transformed_cosines_keep_the_albedo(void **state) {
    (void)state;
    lobe_tables_make();
    TableRef t = lobe_table_refs[1];
    int rows = t.rows / 4, cells = rows * t.columns;
    for (int row = 0; row < rows; row += 5)
        for (int column = 1; column < t.columns; column += 6) {
            double x = column / (t.columns - 1.0),
                   root = (double)t.low + (double)(t.high - t.low) * row / (rows - 1.0);
            Lobe lobe = lobe_at_alpha(LOBE_FIBRE, root * root);
            double z = x * x;
            Dir o = dir((float)(sqrt)(1.0 - z * z), 0.0f, (float)z);
            double e = (double)albedo_quadrature(&lobe, o, 1e-5).f0;
            const float *texel = t.texels + row * t.columns + column;
            if (!(fabs((double)texel[3 * cells] - e) < 2e-3))
                fail_msg("row %d column %d: %g and not %g", row, column, (double)texel[3 * cells], e);
            assert_true(texel[0] > 0.0f && texel[cells] >= 0.0f);
        }
}

/* The file's first line, carried out again. */
static void table_file_is_what_its_command_makes(void **state) {
    (void)state;
    if (getenv("WEFT_TEST_SHORT")) skip();
    setenv("XDG_CACHE_HOME", "/dev/null", 1); /* no fit that was kept */
    WeftLobe lobe;
    lobe_tables_make();
    TableRef t = lobe_table_refs[1];
    int rows = t.rows / 4, cells = rows * t.columns;
    assert_int_equal(weft_lobe_init("fibre", &lobe, NULL), WEFT_OK);
    WeftImage again = baked("ltc-level", &lobe, t.columns, rows, 0);
    const float *texels = again.pixels;
    for (int c = 0; c < 4; c++)
        for (int k = 0; k < cells; k++) {
            double want = (double)t.texels[c * cells + k], got = (double)texels[k * 4 + c];
            if (!(fabs(got - want) <= 1e-6 * fmax(fabs(want), 1.0)))
                fail_msg("cell %d, channel %d: %.9g and not %.9g", k, c, got, want);
        }
    weft_image_free(&again);
}

static void table_of_the_catalogue_is_what_its_command_makes(void **state) {
    (void)state;
    if (!getenv("WEFT_TEST_LONG")) skip();
    lobe_tables_make();
    TableRef t = lobe_table_refs[2];
    int rows = t.rows / 4, cells = rows * t.columns;
    WeftImage again = baked("fibre-table", NULL, t.columns, rows, 0);
    const float *texels = again.pixels;
    for (int c = 0; c < 4; c++)
        for (int k = 0; k < cells; k++) assert_float_equal(texels[k * 4 + c], t.texels[c * cells + k], 1e-6f);
    weft_image_free(&again);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lobe_from_the_table_follows_the_solved_slab),
        cmocka_unit_test(small_table_is_baked_the_same_again),
        cmocka_unit_test(transformed_cosines_keep_the_albedo),
        cmocka_unit_test(table_file_is_what_its_command_makes),
        cmocka_unit_test(table_of_the_catalogue_is_what_its_command_makes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
