/* `weft eval` against formulas written out here in double precision, independently of the catalogue. */
#include "base/pi.h"
#include "run.h"

#include <math.h>

#include "weft/weft.h"

typedef struct Vector {
    double x, y, z;
} Vector;

static Vector vector(double theta, double phi) {
    double t = theta * PI_DOUBLE / 180.0, p = phi * PI_DOUBLE / 180.0;
    return (Vector){sin(t) * cos(p), sin(t) * sin(p), cos(t)};
}
static double dot(Vector a, Vector b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

static Vector half(Vector o, Vector i) {
    Vector s = {o.x + i.x, o.y + i.y, o.z + i.z};
    double l = sqrt(dot(s, s));
    return (Vector){s.x / l, s.y / l, s.z / l};
}

/* Walter et al. 2007 with the height-correlated Smith term by Lambda, Heitz 2014. */
static double lambda_ggx(double alpha, Vector w) {
    double tan2 = (1.0 - w.z * w.z) / (w.z * w.z);
    return 0.5 * (sqrt(1.0 + alpha * alpha * tan2) - 1.0);
}
static double d_ggx(double alpha, double cos_h) {
    double t = cos_h * cos_h * (alpha * alpha - 1.0) + 1.0;
    return alpha * alpha / (PI_DOUBLE * t * t);
}
static double f_ggx(double alpha, Vector o, Vector i) {
    double g2 = 1.0 / (1.0 + lambda_ggx(alpha, o) + lambda_ggx(alpha, i));
    return d_ggx(alpha, half(o, i).z) * g2 / (4.0 * o.z * i.z);
}
static double pdf_ggx(double alpha, Vector o, Vector i) {
    return d_ggx(alpha, half(o, i).z) / ((1.0 + lambda_ggx(alpha, o)) * 4.0 * o.z);
}

/* Conty Estevez and Kulla 2017, equation 2, over the denominator of Neubelt and Pettineo 2013. */
static double f_charlie_neubelt(double alpha, Vector o, Vector i) {
    double cos_h = half(o, i).z, sin_h = sqrt(1.0 - cos_h * cos_h);
    double d = (2.0 + 1.0 / alpha) * pow(sin_h, 1.0 / alpha) / (2.0 * PI_DOUBLE);
    return d / (4.0 * (o.z + i.z - o.z * i.z));
}

static void assert_near(double value, double expected, double relative, const char *what) {
    if (!(fabs(value - expected) <= relative * fabs(expected) + 1e-9))
        fail_msg("%s: %.9g, expected %.9g", what, value, expected);
}

/* Directions over the hemisphere, degrees: rows theta_o phi_o theta_i phi_i. */
enum { ANGLES = 200 };
static double angles[ANGLES][4];
static char angle_lines[ANGLES * 64];

static void make_angles(void) {
    size_t used = 0;
    for (int k = 0; k < ANGLES; k++) {
        double u[4]; /* fractions of irrational multiples fill a box evenly */
        for (int d = 0; d < 4; d++) u[d] = fmod((k + 1) * pow(0.5 * (sqrt(5.0) - 1.0), d + 1.0) * 1.3247, 1.0);
        double row[4] = {1.0 + 84.0 * u[0], 360.0 * u[1], 1.0 + 84.0 * u[2], 360.0 * u[3]};
        int length = snprintf(angle_lines + used, sizeof angle_lines - used, "%.6f %.6f\t%.6f,%.6f\n", row[0], row[1],
                              row[2], row[3]);
        assert_int_equal(
            sscanf(angle_lines + used, "%lf %lf %lf,%lf", &angles[k][0], &angles[k][1], &angles[k][2], &angles[k][3]),
            4);
        used += (size_t)length;
    }
}

/* Evaluates all angles; rows are f_r f_g f_b pdf. */
static void evaluate(const char *const *arguments, double rows[ANGLES][4]) {
    Ran ran = run_with(angle_lines, arguments);
    assert_int_equal(ran.code, 0);
    assert_string_equal(ran.err, "");
    const char *text = ran.out;
    for (int k = 0; k < ANGLES; k++) {
        int used = 0;
        assert_int_equal(sscanf(text, "%lf %lf %lf %lf%n", &rows[k][0], &rows[k][1], &rows[k][2], &rows[k][3], &used),
                         4);
        assert_int_equal(text[used], '\n');
        text += used + 1;
    }
    assert_int_equal(*text, '\0');
    ran_free(&ran);
}

static void eval_of_lambert_is_one_over_pi(void **state) {
    (void)state;
    double rows[ANGLES][4];
    evaluate(LIST("eval", "lambert", "-p", "color=1,0.5,0.25"), rows);
    for (int k = 0; k < ANGLES; k++) {
        assert_near(rows[k][0], 1.0 / PI_DOUBLE, 1e-6, "red");
        assert_near(rows[k][1], 0.5 / PI_DOUBLE, 1e-6, "green");
        assert_near(rows[k][2], 0.25 / PI_DOUBLE, 1e-6, "blue");
        assert_near(rows[k][3], cos(angles[k][2] * PI_DOUBLE / 180.0) / PI_DOUBLE, 1e-5, "pdf");
    }
}

static void eval_of_ggx_is_its_formula(void **state) {
    (void)state;
    double rows[ANGLES][4];
    evaluate(LIST("eval", "ggx", "-p", "alpha=0.3", "-p", "f0=0.04,0.5,1", "-p", "f90=1"), rows);
    for (int k = 0; k < ANGLES; k++) {
        Vector o = vector(angles[k][0], angles[k][1]), i = vector(angles[k][2], angles[k][3]);
        double s = pow(1.0 - dot(i, half(o, i)), 5.0), f = f_ggx(0.3, o, i);
        assert_near(rows[k][0], f * (0.04 + 0.96 * s), 1e-4, "red");
        assert_near(rows[k][1], f * (0.5 + 0.5 * s), 1e-4, "green");
        assert_near(rows[k][2], f, 1e-4, "blue");
        assert_near(rows[k][3], pdf_ggx(0.3, o, i), 1e-4, "pdf");
    }
}

static void eval_of_charlie_neubelt_is_its_formula(void **state) {
    (void)state;
    double rows[ANGLES][4];
    evaluate(LIST("eval", "charlie-neubelt", "-p", "alpha=0.25"), rows);
    for (int k = 0; k < ANGLES; k++) {
        Vector o = vector(angles[k][0], angles[k][1]), i = vector(angles[k][2], angles[k][3]);
        double f = f_charlie_neubelt(0.25, o, i);
        for (int c = 0; c < 3; c++) assert_near(rows[k][c], f, 1e-3, "f");
        assert_true(rows[k][3] > 0.0);
    }
}

static void file_and_standard_input_print_the_same(void **state) {
    (void)state;
    file_make("angles.txt", angle_lines, strlen(angle_lines));
    Ran piped = run_with(angle_lines, LIST("eval", "ggx")), filed = RUN("eval", "ggx", "angles.txt"),
        dashed = run_with(angle_lines, LIST("eval", "ggx", "-"));
    assert_int_equal(filed.code, 0);
    assert_string_equal(piped.out, filed.out);
    assert_string_equal(piped.out, dashed.out);
    ran_free(&piped), ran_free(&filed), ran_free(&dashed);
}

static void eval_at_or_below_the_horizon_is_zero(void **state) {
    (void)state;
    static const char lines[] = "90 0 10 0\n10 0 90 0\n100 0 10 0\n10 0 91 45\n180 0 180 0\n";
    Ran ran = run_with(lines, LIST("eval", "charlie-neubelt"));
    assert_int_equal(ran.code, 0);
    assert_string_equal(ran.out, "0 0 0 0\n0 0 0 0\n0 0 0 0\n0 0 0 0\n0 0 0 0\n");
    ran_free(&ran);
}

static void empty_lines_and_comments_are_skipped(void **state) {
    (void)state;
    Ran ran = run_with("# angles\n\n  \t\r\n10,20, 30 ,40\r\n  10\t20 30 40", LIST("eval", "lambert"));
    assert_int_equal(ran.code, 0);
    const char *second = strchr(ran.out, '\n') + 1;
    assert_int_equal(strlen(ran.out), 2 * strlen(second)); /* two equal lines */
    assert_memory_equal(ran.out, second, strlen(second));
    ran_free(&ran);
}

/* As spreadsheets write it in front of a table. */
static void byte_order_mark_of_the_input_is_skipped(void **state) {
    (void)state;
    Ran plain = run_with("10,20,30,40\n", LIST("eval", "lambert")), marked = run_with("\xef\xbb\xbf"
                                                                                      "10,20,30,40\n",
                                                                                      LIST("eval", "lambert"));
    assert_int_equal(marked.code, 0);
    assert_string_equal(marked.out, plain.out);
    ran_free(&plain), ran_free(&marked);
}

/* What comes before the bad line is answered, the line is named, nothing after it is read. */
static void malformed_line_is_named_by_its_number(void **state) {
    (void)state;
    static const char *const wrong[] = {"1 2 3",     "1 2 3 4 5", "1 2 3 x", "1 2 3 4x", "1,,2,3,4",
                                        "1 2 3 nan", "1 2 inf 4", "1;2;3;4", ",1,2,3,4", "1 2 3 4,"};
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        char input[128];
        snprintf(input, sizeof input, "0 0 0 0\n# note\n%s\n0 0 0 0\n", wrong[k]);
        Ran ran = run_with(input, LIST("eval", "lambert"));
        if (ran.code != 3 || !one_complaint(ran.err) || !strstr(ran.err, "line 3"))
            fail_msg("\"%s\": %d, %s", wrong[k], ran.code, ran.err);
        assert_int_equal(strcspn(ran.out, "\n") + 1, strlen(ran.out));
        ran_free(&ran);
    }
    char *endless = malloc(100001);
    assert_non_null(endless);
    memset(endless, '1', 100000);
    endless[100000] = '\0';
    assert_complaint(endless, LIST("eval", "lambert"), 3, "line 1: is too long");
    free(endless);
    assert_complaint(NULL, LIST("eval", "lambert", "no such file"), 3, "no such file: cannot be opened");
    assert_complaint(NULL, LIST("eval", "lambert", "/"), 3, "/: cannot be read");
}

/* An artist's roughness in the place of a lobe's own width. */
static void roughness_option_means_the_roughness_of_artists(void **state) {
    (void)state;
    const char *pairs = "30 0 60 180\n10 20 80 40\n";
    Ran own = run_with(pairs, LIST("eval", "charlie-neubelt", "-p", "alpha=0.25")),
        rough = run_with(pairs, LIST("eval", "charlie-neubelt", "-p", "roughness=0.5"));
    assert_int_equal(rough.code, 0);
    assert_string_equal(own.out, rough.out);
    ran_free(&own);
    ran_free(&rough);
    assert_complaint(pairs, LIST("eval", "lambert", "-p", "roughness=0.5"), 2, "has nothing that a roughness sets");
}

static void albedo_of_lambert_is_one(void **state) {
    (void)state;
    Ran ran = run_with("1\n0.5\n0.01\n", LIST("eval", "lambert", "--albedo"));
    assert_int_equal(ran.code, 0);
    const char *text = ran.out;
    for (int k = 0; k < 3; k++) {
        char *end;
        assert_near(strtod(text, &end), 1.0, 1e-4, "albedo");
        assert_int_equal(*end, '\n');
        text = end + 1;
    }
    assert_int_equal(*text, '\0');
    ran_free(&ran);
}

/* Midpoints over (cos_i, phi): enough for a lobe as smooth as alpha 0.5. */
static double albedo_charlie_neubelt(double alpha, double cos_o) {
    const int n = 400;
    Vector o = {sqrt(1.0 - cos_o * cos_o), 0.0, cos_o};
    double sum = 0.0;
    for (int a = 0; a < n; a++)
        for (int b = 0; b < n; b++) {
            double z = (a + 0.5) / n, phi = 2.0 * PI_DOUBLE * (b + 0.5) / n, r = sqrt(1.0 - z * z);
            sum += f_charlie_neubelt(alpha, o, (Vector){r * cos(phi), r * sin(phi), z}) * z;
        }
    return sum * 2.0 * PI_DOUBLE / n / n;
}

static void albedo_of_charlie_neubelt_is_its_integral(void **state) {
    (void)state;
    Ran ran = run_with("0.7 \n", LIST("eval", "charlie-neubelt", "-p", "alpha=0.5", "-p", "color=1,0.5,0", "--albedo"));
    double e[3], expected = albedo_charlie_neubelt(0.5, 0.7);
    assert_int_equal(ran.code, 0);
    assert_int_equal(sscanf(ran.out, "%lf %lf %lf", &e[0], &e[1], &e[2]), 3);
    assert_near(e[0], expected, 1e-3, "red");
    assert_near(e[1], 0.5 * expected, 1e-3, "green");
    assert_near(e[2], 0.0, 1e-3, "blue");
    ran_free(&ran);
    assert_complaint("0\n", LIST("eval", "lambert", "--albedo"), 3, "line 1: is not a cosine");
    assert_complaint("1.01\n", LIST("eval", "lambert", "--albedo"), 3, "line 1: is not a cosine");
}

/* The terms of two lobes of the catalogue give these lobes, by ids and by the names of sources. */
/* Three numbers of one line. */
static void three_of(const char *const *arguments, const char *input, double f[3]) {
    Ran ran = run_with(input, arguments);
    if (ran.code != 0) fail_msg("%s", ran.err);
    int used = 0;
    assert_int_equal(sscanf(ran.out, "%lf %lf %lf%n", &f[0], &f[1], &f[2], &used), 3);
    assert_string_equal(ran.out + used, "\n"); /* no pdf */
    ran_free(&ran);
}

/* Whatever plot and match take: presets, profiles, workflows, material files, measurements. */
static void eval_of_any_model_is_its_reflection(void **state) {
    (void)state;
    static const char pair[] = "30 0 30 180\n";
    const float wo[3] = {0.5f, 0.0f, 0.8660254f}, wi[1][3] = {{-0.5f, 0.0f, 0.8660254f}};
    static const char *const names[] = {"preset:velvet", "satin", "profile:three", "metallic"};
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        double f[3];
        three_of(LIST("eval", names[k]), pair, f);
        for (int c = 0; c < 3; c++) assert_true(f[c] > 1e-4 && f[c] < 100.0);
    }
    WeftMaterial material;
    WeftReflection *reflection;
    float expected[1][3];
    double f[3];
    assert_int_equal(weft_material_read("preset:velvet", &material, NULL, NULL), WEFT_OK);
    assert_int_equal(weft_reflection_create(&material, &reflection, NULL), WEFT_OK);
    weft_reflection_eval(reflection, WEFT_PART_ALL, wo, 1, wi, expected);
    weft_reflection_free(reflection);
    three_of(LIST("eval", "preset:velvet"), pair, f);
    for (int c = 0; c < 3; c++) assert_near(f[c], (double)expected[0][c], 1e-5, "velvet");
    three_of(LIST("eval", "three:base_color=0.5,sheen_color=0,specular=0"), pair, f);
    assert_near(f[0], 0.5 / PI_DOUBLE, 1e-2, "a grey base");

    static const char grey[] = "{\"base_color\":0.5,\"specular\":0}";
    file_make("grey.json", grey, sizeof grey - 1);
    three_of(LIST("eval", "grey.json"), pair, f);
    assert_near(f[1], 0.5 / PI_DOUBLE, 1e-2, "a material file");
    Ran ran = run_shell("\"$0\" bake bsdf lambert -o grey.bsdf --quiet");
    assert_int_equal(ran.code, 0);
    ran_free(&ran);
    three_of(LIST("eval", "grey.bsdf"), pair, f);
    assert_near(f[2], 1.0 / PI_DOUBLE, 1e-2, "a measurement");
    ran = run_with("0.8\n", LIST("eval", "grey.bsdf", "--albedo"));
    assert_int_equal(ran.code, 0);
    assert_near(strtod(ran.out, NULL), 1.0, 0.03, "its E");
    ran_free(&ran);
    ran = run_with(pair, LIST("eval", "ggx:alpha=0.3")); /* a lobe with settings has its pdf */
    assert_int_equal(ran.code, 0);
    assert_int_equal(sscanf(ran.out, "%lf %lf %lf %lf", &f[0], &f[1], &f[2], &f[2]), 4);
    ran_free(&ran);
    assert_complaint(pair, LIST("eval", "preset:velvet", "-p", "sheen=1"), 2, "write preset:velvet:KEY=VALUE");
    assert_complaint(pair, LIST("eval", "none.bsdf"), 3, "none.bsdf: cannot be opened");
    assert_complaint(pair, LIST("eval", "preset:vlvet"), 2, "velvet");
}

/* Other files of the same suffixes are named for what they are. */
static void files_that_are_no_measurement_are_named(void **state) {
    (void)state;
    static const struct {
        const char *name, *bytes, *said;
    } files[] = {
        {"layer.bsdf", "<?xml version=\"1.0\"?>\n<WindowElement xmlns=\"http://windows.lbl.gov\">\n",
         "XML of a window layer"},
        {"scatter.bsdf", "Source  Measured\nSymmetry  PlaneSymmetrical\nScatterAzimuth  4\n0 45 90 135\n",
         "text of a scatterometer"},
        {"lines.bsdf", "# theta phi value\n0 0 0.3\n10 0 0.29\n20 0 0.27\n", "it is text"},
        {"cotton.binary", "<html><body>404 not found, sorry for that</body></html>", "it is HTML"},
        {"cotton.bin", "PK\003\004 and so on and so on and so on", "zip archive"},
    };
    for (size_t k = 0; k < sizeof files / sizeof *files; k++) {
        file_make(files[k].name, files[k].bytes, strlen(files[k].bytes));
        assert_complaint("0 0 0 0\n", LIST("eval", files[k].name), 3, files[k].said);
        assert_complaint(NULL, LIST("plot", "polar", files[k].name, "-o", "x.svg"), 3, files[k].said);
    }
}

static void terms_given_to_cook_torrance_make_a_lobe(void **state) {
    (void)state;
    static double rows[ANGLES][4], same[ANGLES][4];
    evaluate(LIST("eval", "cook-torrance", "-p", "d=charlie", "-p", "v=neubelt", "-p", "f=none", "-p", "alpha=0.25"),
             rows);
    for (int k = 0; k < ANGLES; k++) {
        Vector o = vector(angles[k][0], angles[k][1]), i = vector(angles[k][2], angles[k][3]);
        assert_near(rows[k][0], f_charlie_neubelt(0.25, o, i), 1e-4, "charlie over neubelt");
    }
    evaluate(
        LIST("eval", "cook-torrance", "-p", "d=charlie-d", "-p", "v=ashikhmin-v", "-p", "f=none", "-p", "alpha=0.25"),
        same);
    assert_memory_equal(rows, same, sizeof rows);
    evaluate(LIST("eval", "cook-torrance", "-p", "d=ashikhmin", "-p", "v=conty-kulla", "-p", "f=none"), rows);
    evaluate(LIST("eval", "cook-torrance", "-p", "d=ashikhmin-d", "-p", "v=charlie-v", "-p", "f=none"), same);
    assert_memory_equal(rows, same, sizeof rows);
}

static void ambiguous_names_are_refused(void **state) {
    (void)state;
    static const char several[] = "several have this name: charlie-neubelt, charlie-conty-kulla";
    assert_complaint("", LIST("eval", "charlie"), 2, several);
    assert_complaint("", LIST("eval", "ashikhmin"), 2, "ashikhmin-neubelt, ashikhmin-conty-kulla");
    assert_complaint("", LIST("eval", "charlie-v"), 2, "charlie-v: is not a lobe");
    assert_complaint("", LIST("eval", "cook-torrance", "-p", "d=charlie-v"), 2, "charlie-v: is not a value");
    assert_complaint("", LIST("eval", "cook-torrance", "-p", "v=charlie"), 2, "what v may be");
    assert_complaint("", LIST("eval", "cook-torrance", "-p", "v=2"), 2, "2: is not a value");
}

static void implausible_parameter_is_a_warning(void **state) {
    (void)state;
    Ran ran = run_with("10 0 20 0\n", LIST("eval", "ggx", "-p", "alpha=9"));
    assert_int_equal(ran.code, 0);
    assert_true(one_complaint(ran.err));
    assert_memory_equal(ran.err, "weft: warning: alpha", 20);
    ran_free(&ran);
    ran = run_with("10 0 20 0\n", LIST("eval", "ggx", "-p", "color=-1"));
    assert_int_equal(ran.code, 0);
    assert_true(one_complaint(ran.err)); /* of three channels */
    ran_free(&ran);
}

/* A number that the lobe does not compute with is told, once, whichever verb it is given to. */
static void parameters_outside_the_fitted_range_are_a_warning(void **state) {
    (void)state;
    static const char words[] = "fibre: is outside the range that was fitted: alpha 0.105 of fibres that lean "
                                "counts as 0.38";
    Ran ran = run_with("30 0 60 180\n", LIST("eval", "fibre", "-p", "alpha=0.105", "-p", "tilt=0.5"));
    assert_int_equal(ran.code, 0);
    assert_non_null(strstr(ran.err, words));
    assert_null(strchr(strchr(ran.err, '\n') + 1, '\n'));
    ran_free(&ran);
    ran = run_with("30 0 60 180\n", LIST("eval", "fibre", "-p", "alpha=0.105"));
    assert_int_equal(ran.code, 0);
    assert_string_equal(ran.err, "");
    ran_free(&ran);
    ran = RUN("plot", "polar", "fibre:alpha=0.105,tilt=0.5", "-o", "lean.svg");
    assert_int_equal(ran.code, 0);
    assert_non_null(strstr(ran.err, words));
    ran_free(&ran);
    ran = RUN("render", "builtin:cloth", "--sheen", "fibre", "--set", "*.sheen_roughness=0.3", "--set", "*.nap=30",
              "--set", "*.sheen_color=1", "--width=16", "--height=12", "--spp=1", "-o", "lean.png");
    assert_int_equal(ran.code, 0);
    assert_non_null(strstr(ran.err, "is outside the range that was fitted: alpha 0.09 of"));
    ran_free(&ran);
}

int main(void) {
    make_angles();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(eval_of_lambert_is_one_over_pi),
        cmocka_unit_test(eval_of_ggx_is_its_formula),
        cmocka_unit_test(eval_of_charlie_neubelt_is_its_formula),
        cmocka_unit_test(file_and_standard_input_print_the_same),
        cmocka_unit_test(eval_at_or_below_the_horizon_is_zero),
        cmocka_unit_test(empty_lines_and_comments_are_skipped),
        cmocka_unit_test(byte_order_mark_of_the_input_is_skipped),
        cmocka_unit_test(malformed_line_is_named_by_its_number),
        cmocka_unit_test(roughness_option_means_the_roughness_of_artists),
        cmocka_unit_test(albedo_of_lambert_is_one),
        cmocka_unit_test(albedo_of_charlie_neubelt_is_its_integral),
        cmocka_unit_test(eval_of_any_model_is_its_reflection),
        cmocka_unit_test(files_that_are_no_measurement_are_named),
        cmocka_unit_test(terms_given_to_cook_torrance_make_a_lobe),
        cmocka_unit_test(ambiguous_names_are_refused),
        cmocka_unit_test(implausible_parameter_is_a_warning),
        cmocka_unit_test(parameters_outside_the_fitted_range_are_a_warning),
    };
    return cmocka_run_group_tests(tests, work_begin, work_end);
}
