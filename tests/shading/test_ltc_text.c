/* The text of the linearly transformed cosine: the matrices are those of its formulas, samples fall where the
 * pdf says, nothing is infinite at grazing, and GLSL says the same as C */
/* The grid of cases.h has the names of the one that is measured with. */
#define Grid           CasesGrid
#define grid_direction cases_grid_direction
#include "cases.h"
#undef Grid
#undef grid_direction

#include <sys/stat.h>
#include <unistd.h>

#include "measure/check/chi_square.h"
#include "raster/frame/compute.h"
#include "scratch.h"
#include "shading/ltc/ltc_table.h"

typedef struct Entries {
    float z, q, b, r;
} Entries;

static float between(Random *random, float low, float high) { return mix(low, high, random_unit(random)); }

/* Blunt to sharp, leaning either way. */
static Entries random_entries(Random *random) {
    return (Entries){(expf)(between(random, -4.0f, 1.5f)), between(random, 0.0f, 1.5f), between(random, -1.5f, 1.5f),
                     between(random, 0.0f, 0.8f)};
}

static Ltc transform(Entries e, Dir o) { return ltc_of(e.z, e.q, e.b, e.r, o.z); }

/* The way of the paper: a frame with x along o, the five entries of M^-1 written out, its inverse by
 * cofactors, all in double precision. */
typedef struct Matrix {
    double m[3][3];
} Matrix;

static Matrix frame(Dir o) {
    double s = hypot((double)o.x, (double)o.y), c = (double)o.x / s, n = (double)o.y / s;
    return (Matrix){{{c, n, 0.0}, {-n, c, 0.0}, {0.0, 0.0, 1.0}}};
}

static Matrix written_out(Entries e, Dir o) {
    double s = hypot((double)o.x, (double)o.y), c = (double)o.z;
    return (Matrix){{{c * c + (double)e.q * s * s, 0.0, (double)e.b * s},
                     {0.0, 1.0, 0.0},
                     {-(double)e.r * (double)e.b * s, 0.0, (double)e.z}}};
}

static Matrix product(Matrix a, Matrix b) {
    Matrix p = {0};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            for (int k = 0; k < 3; k++) p.m[i][j] += a.m[i][k] * b.m[k][j];
    return p;
}

static Matrix transposed(Matrix a) {
    Matrix t;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) t.m[i][j] = a.m[j][i];
    return t;
}

static double determinant(Matrix a) {
    double sum = 0.0;
    for (int j = 0; j < 3; j++)
        sum += a.m[0][j] * (a.m[1][(j + 1) % 3] * a.m[2][(j + 2) % 3] - a.m[1][(j + 2) % 3] * a.m[2][(j + 1) % 3]);
    return sum;
}

static Matrix inverse(Matrix a) {
    Matrix b;
    double d = determinant(a);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            int p = (j + 1) % 3, q = (j + 2) % 3, r = (i + 1) % 3, s = (i + 2) % 3;
            b.m[i][j] = (a.m[p][r] * a.m[q][s] - a.m[p][s] * a.m[q][r]) / d;
        }
    return b;
}

static void times(Matrix a, Dir w, double v[3]) {
    for (int i = 0; i < 3; i++) v[i] = a.m[i][0] * (double)w.x + a.m[i][1] * (double)w.y + a.m[i][2] * (double)w.z;
}

static void assert_near(Dir got, const double want[3], double factor, double size) {
    double off = fabs((double)got.x - factor * want[0]) + fabs((double)got.y - factor * want[1]) +
                 fabs((double)got.z - factor * want[2]);
    if (!(off <= 3e-6 * size))
        fail_msg("%g %g %g, not %g %g %g", (double)got.x, (double)got.y, (double)got.z, factor * want[0],
                 factor * want[1], factor * want[2]);
}

static void ltc_matrices_equal_their_written_form(void **state) {
    (void)state;
    Random random = {11};
    for (int k = 0; k < 20000; k++) {
        Entries e = random_entries(&random);
        Dir o = random_direction(&random), w = random_direction(&random);
        Ltc m = transform(e, o);
        Matrix f = frame(o), inner = written_out(e, o), all = product(transposed(f), product(inner, f));
        double det = determinant(inner), v[3], back[3];
        assert_true(fabs((double)m.det - det) < 2e-6 * det + 1e-7);
        times(all, w, v);
        assert_near(ltc_inverse(m, o, w), v, 1.0, 4.0 + (double)e.z);
        times(inverse(all), w, back);
        assert_near(ltc_forward(m, o, w), back, det, 10.0 + 4.0 * (double)e.z);
        double r2 = v[0] * v[0] + v[1] * v[1] + v[2] * v[2], pdf = fmax(v[2], 0.0) * det / (PI_DOUBLE * r2 * r2);
        if (r2 > 1e-2) assert_true(fabs((double)ltc_pdf(m, o, w) - pdf) < 1e-3 * pdf + 1e-5 * det / (r2 * r2));
        /* the horizon's normal: what the cosine's axis sees of w_z >= 0 */
        Matrix i = inverse(inner);
        double n = i.m[2][2] / hypot(i.m[2][0], i.m[2][2]);
        assert_true(fabs((double)ltc_above(m, o) - 0.5 * (1.0 + n)) < 1e-5);
    }
}

/* Samples, behind the signature of what is measured: the entries lie in the parameters of a lobe. */
static Ltc viewed(const BsdfView *view) {
    const float *p = view->lobe.params;
    return ltc_of(p[0], p[1], p[2], p[3], view->o.z);
}
static void pdf_of(const BsdfView *view, Dirs i, float *pdf) {
    for (size_t k = 0; k < i.n; k++) pdf[k] = ltc_pdf(viewed(view), view->o, dir(i.x[k], i.y[k], i.z[k]));
}
static Dir sample_of(const BsdfView *view, float u, float v) { return ltc_sample(viewed(view), view->o, u, v); }
static const Bsdf transformed = {.pdf = pdf_of, .sample = sample_of};

static void ltc_samples_follow_their_pdf(void **state) {
    (void)state;
    enum { TESTS = 40 };
    static const double cosines[] = {1.0, 0.9, 0.5, 0.15, 0.02};
    Random random = {12};
    int turn = 0;
    for (int k = 0; k < TESTS; k++) {
        Entries e = random_entries(&random);
        e.z = max(e.z, 0.15f); /* the bins crowd about the mirror direction, not about this peak */
        if (!test_turn(&turn, 1, 4)) continue;
        BsdfView view = {.bsdf = &transformed, .o = direction_cos(cosines[k % 5], 0.3 + k)};
        float *p = view.lobe.params;
        p[0] = e.z, p[1] = e.q, p[2] = e.b, p[3] = e.r;
        ChiSquare found;
        assert_true(chi_square_measure(&view, test_long() ? 1000000 : test_short() ? 20000 : 60000, 20, 1, &found));
        double above = (double)ltc_above(viewed(&view), view.o);
        if (found.stray || !(fabs(found.integral - above) < 0.01) || !(found.p >= 1.0 - (pow)(1.0 - 0.01, 1.0 / TESTS)))
            fail_msg("z %g q %g b %g r %g cos_o %g: p %.2g, integral %.4f and %.4f", (double)e.z, (double)e.q,
                     (double)e.b, (double)e.r, (double)view.o.z, found.p, found.integral, above);
    }
}

static void extreme_ltc_matrices_give_finite_values(void **state) {
    (void)state;
    static const float zs[] = {1e-8f, 1e-3f, 1.0f, 100.0f}, qs[] = {0.0f, 1e-6f, 1.0f, 50.0f};
    static const float bs[] = {-100.0f, -1.0f, 0.0f, 1e-5f, 1.0f, 100.0f}, rs[] = {0.0f, 1e-4f, 1.0f, 30.0f};
    static const float cosines[] = {1e-30f, 1e-12f, 1e-5f, 0.1f, 1.0f};
    Random random = {13};
    for (size_t k = 0; k < 4 * 4 * 6 * 4 * 25; k++) {
        float c = cosines[k % 5], n = cosines[k / 5 % 5];
        Entries e = {zs[k / 25 % 4], qs[k / 100 % 4], bs[k / 400 % 6], rs[k / 2400 % 4]};
        Dir o = dir(sqrtf(1.0f - c * c), 0.0f, c);
        double phi = k % 3 == 0 ? PI_DOUBLE : 6.0 * (double)random_unit(&random);
        Dir i = dir(sqrtf(1.0f - n * n) * (float)(cos)(phi), sqrtf(1.0f - n * n) * (float)(sin)(phi), n);
        Ltc m = transform(e, o);
        float pdf = ltc_pdf(m, o, i), above = ltc_above(m, o);
        Dir w = ltc_sample(m, o, random_unit(&random), random_unit(&random));
        if (!(isfinite(pdf) && pdf >= 0.0f && m.det > 0.0f && isfinite(m.det) && above >= 0.0f && above <= 1.0f &&
              isfinite(w.x + w.y + w.z)))
            fail_msg("z %g q %g b %g r %g cos_o %g cos_i %g: pdf %g above %g det %g", (double)e.z, (double)e.q,
                     (double)e.b, (double)e.r, (double)c, (double)n, (double)pdf, (double)above, (double)m.det);
    }
}

/* A table of random numbers that are allowed. */
enum { ROWS = 3, COLUMNS = 5, PLANES = 6 };
static float texels[PLANES * ROWS * COLUMNS];

static LtcTable table(void) {
    Random random = {14};
    for (int k = 0; k < ROWS * COLUMNS; k++) {
        Entries e = random_entries(&random);
        const float planes[PLANES] = {e.z, e.q, e.b, e.r, between(&random, 0.0f, 2.0f), between(&random, 0.0f, 1.0f)};
        for (int p = 0; p < PLANES; p++) texels[p * ROWS * COLUMNS + k] = planes[p];
    }
    return (LtcTable){texels, ROWS, COLUMNS, 0.2f, 0.9f};
}

static void ltc_tables_are_interpolated_between_nodes(void **state) {
    (void)state;
    LtcTable t = table();
    for (int row = 0; row < ROWS; row++)
        for (int column = 0; column < COLUMNS; column++)
            for (int half = 0; half < 2; half++) {
                if (half && column + 1 == COLUMNS) continue;
                float x = ((float)column + 0.5f * (float)half) / (COLUMNS - 1);
                float y = mix(t.low, t.high, (float)row / (ROWS - 1));
                LtcLobe l = ltc_table_at(t, x * x, y * y);
                int at = row * COLUMNS + column;
                const float *a = texels + at, *b = a + half, *f0 = a + LTC_AMPLITUDE * ROWS * COLUMNS;
                assert_true(fabsf(l.m.z - 0.5f * (*a + *b)) < 1e-4f);
                assert_true(fabsf(l.f0 - 0.5f * (*f0 + f0[half])) < 1e-4f);
            }
    /* beyond the ends, and a table of one row */
    assert_true(fabsf(ltc_table_at(t, 2.0f, 9.0f).m.z - texels[ROWS * COLUMNS - 1]) < 1e-5f);
    assert_true(fabsf(ltc_table_at(t, -1.0f, -1.0f).m.z - texels[0]) < 1e-5f);
    LtcTable one = {texels, 1, COLUMNS, 0.0f, 0.0f};
    assert_true(fabsf(ltc_table_at(one, 1.0f, 0.3f).m.z - texels[COLUMNS - 1]) < 1e-5f);
}

/* GLSL. */

static void begin_text(Text *text, TextLanguage language) {
    text_begin(text, &(TextDesc){.language = language, .tables = true});
    text_include(text, "shading/ltc/ltc_table.h");
}

static void ltc_text_is_valid_glsl(void **state) {
    (void)state;
    static const TextLanguage languages[] = {TEXT_GLSL_330, TEXT_GLSL_ES_300, TEXT_GLSL_450};
    if (system("command -v glslangValidator >/dev/null 2>&1") != 0) {
        print_message("glslangValidator is not installed\n");
        skip();
    }
    char folder[SCRATCH_SIZE], path[64], command[256];
    assert_true(scratch_make(folder));
    for (int l = 0; l < 3; l++) {
        Text text;
        WeftError error;
        begin_text(&text, languages[l]);
        text_line(&text,
                  "\n%sout vec4 color;\nvoid main() {\n    LtcTable t;\n    t.texels = 0;\n    t.rows = 3;\n"
                  "    t.columns = 5;\n    t.low = 0.2;\n    t.high = 0.9;\n"
                  "    Dir o = dir(0.6, 0.0, 0.8);\n    LtcLobe l = ltc_table_at(t, o.z, 0.3);\n"
                  "    Dir i = ltc_sample(l.m, o, 0.2, 0.3);\n"
                  "    color = vec4(ltc_pdf(l.m, o, i), ltc_above(l.m, o), l.f0, l.f90);\n}",
                  languages[l] == TEXT_GLSL_450 ? "layout(location = 0) " : "");
        if (text_end(&text, &error) != WEFT_OK) fail_msg("%s", error.text);
        snprintf(path, sizeof path, "%s/%d.frag", folder, l);
        FILE *file = fopen(path, "wb");
        assert_non_null(file);
        assert_true(fputs(text.bytes, file) >= 0);
        assert_int_equal(fclose(file), 0);
        snprintf(command, sizeof command, "cd %s && glslangValidator %s -S frag %d.frag", folder,
                 languages[l] == TEXT_GLSL_450 ? "-V -o /dev/null" : "", l);
        assert_int_equal(system(command), 0);
        text_free(&text);
    }
    assert_true(scratch_remove(folder));
}

enum { PAIRS = 4096 };

/* in0: o, parameter. in1: i. in2: u, v. */
static const char body[] =
    "    LtcTable t;\n    t.texels = 0;\n    t.rows = 3;\n    t.columns = 5;\n    t.low = 0.2;\n    t.high = "
    "0.9;\n"
    "    Dir o = dir(in0.x, in0.y, in0.z);\n    LtcLobe l = ltc_table_at(t, o.z, in0.w);\n"
    "    Dir s = ltc_sample(l.m, o, in2.x, in2.y);\n"
    "    out0 = vec4(ltc_pdf(l.m, o, dir(in1.x, in1.y, in1.z)), ltc_above(l.m, o), l.f0, l.f90);\n"
    "    out1 = vec4(s.x, s.y, s.z, l.m.det);\n";

static void compare_on(TextLanguage language) {
    GlContext *context;
    Compute *compute;
    Text text;
    WeftError error = {0};
    if (context_create(language, &context, &error) != WEFT_OK) {
        print_message("%s\n", error.text);
        skip();
    }
    LtcTable t = table();
    begin_text(&text, language);
    assert_int_equal(text_end(&text, &error), WEFT_OK);
    ComputeDesc desc = {.name = "a transform", .text = &text, .body = body, .inputs = 3, .outputs = 2};
    if (compute_create(context, &desc, &compute, &error) != WEFT_OK) fail_msg("%s", error.text);
    assert_int_equal(compute_tables(compute, &(TextTable){texels, PLANES * ROWS, COLUMNS, NULL}, 1, &error), WEFT_OK);
    static float in[3][4 * PAIRS], out[2][4 * PAIRS];
    Random random = {15};
    for (int k = 0; k < PAIRS; k++) {
        Dir o = random_direction(&random), i = random_direction(&random);
        const float rows[3][4] = {{o.x, o.y, o.z, random_unit(&random)},
                                  {i.x, i.y, i.z, 0.0f},
                                  {random_unit(&random), random_unit(&random), 0.0f, 0.0f}};
        for (int j = 0; j < 3; j++) memcpy(&in[j][4 * k], rows[j], sizeof rows[j]);
    }
    const float *const ins[] = {in[0], in[1], in[2]};
    float *const outs[] = {out[0], out[1]};
    assert_int_equal(compute_run(compute, PAIRS, ins, outs, &error), WEFT_OK);
    int beyond = 0;
    for (int k = 0; k < PAIRS; k++) {
        const float *a = &in[0][4 * k], *b = &in[1][4 * k], *c = &in[2][4 * k];
        Dir o = dir(a[0], a[1], a[2]);
        LtcLobe l = ltc_table_at(t, o.z, a[3]);
        Dir s = ltc_sample(l.m, o, c[0], c[1]);
        const float want[2][4] = {{ltc_pdf(l.m, o, dir(b[0], b[1], b[2])), ltc_above(l.m, o), l.f0, l.f90},
                                  {s.x, s.y, s.z, l.m.det}};
        for (int j = 0; j < 8; j++) {
            float got = out[j / 4][4 * k + j % 4], expected = want[j / 4][j % 4];
            beyond += !(fabsf(got - expected) < 5e-4f * (fabsf(expected) + 0.02f));
        }
    }
    if (beyond > 8 * PAIRS / 1000) fail_msg("%d of %d numbers differ", beyond, 8 * PAIRS);
    compute_destroy(compute);
    text_free(&text);
    context_destroy(context);
}

static void ltc_text_in_glsl_agrees_with_c(void **state) {
    (void)state;
    compare_on(TEXT_GLSL_330);
    compare_on(TEXT_GLSL_ES_300);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ltc_matrices_equal_their_written_form),
        cmocka_unit_test(ltc_samples_follow_their_pdf),
        cmocka_unit_test(extreme_ltc_matrices_give_finite_values),
        cmocka_unit_test(ltc_tables_are_interpolated_between_nodes),
        cmocka_unit_test(ltc_text_is_valid_glsl),
        cmocka_unit_test(ltc_text_in_glsl_agrees_with_c),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
