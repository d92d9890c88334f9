/* The baked tables of fibres: that of the catalogue against the solved slab where nothing was fitted, a small
 * one made anew, the transformed cosines of ltc-fibre fitted again, and those of ltc-fibre-published walked again
 *
 * Labels: slow unsanitized */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "fibre/solver_reference.h"
#include "shading/catalogue/albedo.h"
#include "shading/catalogue/registry.h"
#include "shading/lobe/lobe_tables.h"
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
            Dir i = dir((float)wi[0], (float)wi[1], (float)wi[2]), o = dir((float)wo[0], (float)wo[1], (float)wo[2]);
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

static WeftImage baked_of(const char *kind, const WeftLobe *lobe, int width, int height, int threads, int channels) {
    WeftImage table;
    WeftError error = {0};
    WeftBakeDesc desc = {.kind = kind, .lobe = lobe, .width = width, .height = height, .threads = threads};
    if (weft_bake(&desc, NULL, &table, &error) != WEFT_OK) fail_msg("%s", error.text);
    assert_int_equal(table.channels, channels);
    return table;
}
static WeftImage baked(const char *kind, const WeftLobe *lobe, int width, int height, int threads) {
    return baked_of(kind, lobe, width, height, threads, 4);
}

/* The same on any number of threads, every number a half float. */
static void small_table_is_baked_the_same_again(void **state) {
    (void)state;
    WeftImage one = baked("fibre-table", NULL, 2, 2, 1), two = baked("fibre-table", NULL, 2, 2, 2);
    const float *a = one.pixels, *b = two.pixels;
    for (int k = 0; k < 2 * 2 * 4; k++) {
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
    TableRef t = lobe_table_refs[LOBE_TABLE_ltc_fibre];
    int rows = t.rows / 4, cells = rows * t.columns;
    for (int row = 0; row < rows; row += 5)
        for (int column = 1; column < t.columns; column += 6) {
            double x = column / (t.columns - 1.0), root = (double)t.low + (double)(t.high - t.low) * row / (rows - 1.0);
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
    TableRef t = lobe_table_refs[LOBE_TABLE_ltc_fibre];
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
    TableRef t = lobe_table_refs[LOBE_TABLE_fibre];
    int rows = t.rows / 4, cells = rows * t.columns;
    WeftImage again = baked("fibre-table", NULL, t.columns, rows, 0);
    const float *texels = again.pixels;
    for (int c = 0; c < 4; c++)
        for (int k = 0; k < cells; k++) assert_float_equal(texels[k * 4 + c], t.texels[c * cells + k], 1e-6f);
    weft_image_free(&again);
}

/* ---- ltc-fibre-published ------------------------------------------------------------------------------- */

enum { NODES = 32 };
static float published(int channel, int row, int column) {
    return lobe_table_refs[LOBE_TABLE_ltc_fibre_published].texels[(channel * NODES + row) * NODES + column];
}

/* Entries of Zeltner, Burley and Chiang's table (the program is published with the talk): alpha and cos_o in steps of
 * 1 / 31, a, b and R. The walks that it was made of have noise of their own, as do weft's. */
static void published_table_is_near_the_talks(void **state) {
    (void)state;
    static const struct {
        int row, column;
        float want[3];
    } entries[] = {{4, 1, {0.05152f, -0.02772f, 0.42999f}},   {8, 4, {0.17244f, -0.02431f, 0.31773f}},
                   {13, 0, {0.16755f, -0.17802f, 0.69548f}},  {16, 16, {0.49060f, -0.05014f, 0.15718f}},
                   {22, 28, {0.71997f, -0.03495f, 0.13785f}}, {31, 31, {0.87958f, 0.00003f, 0.34187f}}};
    static const float limits[] = {0.012f, 0.012f, 0.0015f};
    float most[3] = {0};
    lobe_tables_make();
    for (size_t k = 0; k < sizeof entries / sizeof entries[0]; k++)
        for (int c = 0; c < 3; c++) {
            float got = published(c, entries[k].row, entries[k].column);
            most[c] = fmaxf(most[c], fabsf(got - entries[k].want[c]));
            if (!(fabsf(got - entries[k].want[c]) < limits[c]))
                fail_msg("row %d column %d channel %d: %g, the talk's %g", entries[k].row, entries[k].column, c,
                         (double)got, (double)entries[k].want[c]);
        }
    print_message("six of the talk's entries: a within %.4f, b within %.4f, R within %.4f\n", (double)most[0],
                  (double)most[1], (double)most[2]);
}

/* Its corners, of which the roughest are fitted on their own: a walk is a function of its number alone. */
static void published_table_is_what_its_command_makes(void **state) {
    (void)state;
    if (getenv("WEFT_TEST_SHORT")) skip();
    WeftError error;
    WeftImage refused, again = baked_of("ltc-fibre-published", NULL, 2, 2, 0, 3);
    const float *texels = again.pixels;
    lobe_tables_make();
    for (int corner = 0; corner < 4; corner++)
        for (int c = corner < 2 ? 2 : 0; c < 3; c++) {
            float got = texels[corner * 3 + c], want = published(c, corner / 2 * 31, corner % 2 * 31);
            if (!(fabsf(got - want) < 1e-4f))
                fail_msg("corner %d channel %d: %.9g and not %.9g", corner, c, (double)got, (double)want);
        }
    weft_image_free(&again);
    WeftBakeDesc narrow = {.kind = "ltc-fibre-published", .width = 1, .height = 4};
    assert_int_not_equal(weft_bake(&narrow, NULL, &refused, &error), WEFT_OK);
}

/* The talk's formula once more, with the entries mixed in its way: linear in cos_o and in alpha. */
static double published_f_cos(double alpha, const double o[3], const double i[3]) {
    double x = o[2] * (NODES - 1), y = alpha * (NODES - 1), sine = hypot(o[0], o[1]), m[3];
    int column = (int)fmin(x, NODES - 2), row = (int)fmin(y, NODES - 2);
    x -= column, y -= row;
    for (int c = 0; c < 3; c++)
        m[c] = (1.0 - y) * ((1.0 - x) * (double)published(c, row, column) + x * (double)published(c, row, column + 1)) +
               y * ((1.0 - x) * (double)published(c, row + 1, column) + x * (double)published(c, row + 1, column + 1));
    double along = (i[0] * o[0] + i[1] * o[1]) / sine, across = (i[1] * o[0] - i[0] * o[1]) / sine;
    double v[3] = {m[0] * along + m[1] * i[2], m[0] * across, i[2]};
    double square = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
    return m[2] * m[0] * m[0] * v[2] / (3.14159265358979324 * square * square);
}

static void published_lobe_has_the_talks_formula(void **state) {
    (void)state;
    lobe_tables_make();
    for (int n = 0; n < 2000; n++) {
        double part[5]; /* a Kronecker sequence */
        for (int k = 0; k < 5; k++) part[k] = fmod(n * (sqrt)(k < 2 ? 2.0 + k : 2.0 * k + 1.0), 1.0);
        double alpha = 0.05 + 0.95 * part[0], cos_o = 0.01 + 0.98 * part[1], cos_i = 0.01 + 0.98 * part[2];
        double phi_o = 6.28 * part[3], phi_i = 6.28 * part[4];
        double so = (sqrt)(1.0 - cos_o * cos_o), si = (sqrt)(1.0 - cos_i * cos_i);
        double o[3] = {so * (cos)(phi_o), so * (sin)(phi_o), cos_o},
               i[3] = {si * (cos)(phi_i), si * (sin)(phi_i), cos_i};
        Lobe lobe = lobe_at_alpha(LOBE_LTC_FIBRE_PUBLISHED, alpha);
        Dir wo = dir((float)o[0], (float)o[1], (float)o[2]), wi = dir((float)i[0], (float)i[1], (float)i[2]);
        double got = (double)lobe_eval(&lobe, angles_between(wo, wi)) * cos_i;
        double want = published_f_cos(alpha, o, i);
        if (!(fabs(got - want) < 2e-4 * want + 1e-7))
            fail_msg("alpha %g cos_o %g cos_i %g: %g and not %g", alpha, cos_o, cos_i, got, want);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lobe_from_the_table_follows_the_solved_slab),
        cmocka_unit_test(small_table_is_baked_the_same_again),
        cmocka_unit_test(transformed_cosines_keep_the_albedo),
        cmocka_unit_test(table_file_is_what_its_command_makes),
        cmocka_unit_test(table_of_the_catalogue_is_what_its_command_makes),
        cmocka_unit_test(published_table_is_near_the_talks),
        cmocka_unit_test(published_table_is_what_its_command_makes),
        cmocka_unit_test(published_lobe_has_the_talks_formula),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
