/* --lobe FILE.h: a lobe of the user's own gives the numbers, the pictures and the text that the same file
 * gives as a row of lobes.list; and files that are none are told in one line */
#include <sys/stat.h>

#include "base/pi.h"
#include "run.h"

/* Lobes of the catalogue under another name: with one colour, two, a second of its own; with views and
 * prepared records of their own; with terms to choose from. */
static const char *const twins[][3] = {{"lambert", "Lambert", "LAMBERT"},
                                       {"wrap", "Wrap", "WRAP"},
                                       {"patry", "Patry", "PATRY"},
                                       {"eon", "Eon", "EON"},
                                       {"threads", "Threads", "THREADS"},
                                       {"burley", "Burley", "BURLEY"},
                                       {"burley_coat", "BurleyCoat", "BURLEY_COAT"},
                                       {"charlie_khronos", "CharlieKhronos", "CHARLIE_KHRONOS"},
                                       {"cook_torrance", "CookTorrance", "COOK_TORRANCE"}};
enum { TWINS = sizeof twins / sizeof *twins };

static const char *id_of(const char *name, char id[64]) {
    snprintf(id, 64, "%s", name);
    for (char *c = id; *c; c++)
        if (*c == '_') *c = '-';
    return id;
}

/* my_NAME.h, by one rule for all. */
static void make_twin(int k, char file[64], char id[64]) {
    char line[700];
    const char *name = twins[k][0], *record = twins[k][1], *macros = twins[k][2];
    snprintf(file, 64, "my_%s.h", name);
    snprintf(line, sizeof line,
             "sed 's/\\b%s_/my_%s_/g; s/(%s, %s)/(my_%s, %s)/g; s/\\b%s/My%s/g; s/\\b%s_/MY_%s_/g' "
             "'" WEFT_SOURCE_DIR "/src/shading/lobes/%s.h' >%s",
             name, name, name, record, name, record, record, record, macros, macros, name, file);
    Ran ran = run_shell(line);
    assert_int_equal(ran.code, 0);
    ran_free(&ran);
    char own[64];
    snprintf(own, sizeof own, "my_%.50s", name);
    id_of(own, id);
}

static const char pairs[] = "60 0 30 40\n10 20 85 170\n0 0 0 0\n89 -30 70 200\n45 90 45 270\n";

/* Leaves out every my-, my_, My and MY_. */
static char *plain(char *bytes) {
    char *to = bytes;
    assert_non_null(bytes);
    for (const char *c = bytes; *c;) {
        if (strncmp(c, "my-", 3) == 0 || strncmp(c, "my_", 3) == 0 || strncmp(c, "MY_", 3) == 0)
            c += 3;
        else if (strncmp(c, "My", 2) == 0)
            c += 2;
        else
            *to++ = *c++;
    }
    *to = 0;
    return bytes;
}

/* The same words, and numbers that differ by rounding at the most: the library may come from another
 * compiler. */
static void assert_alike(const char *a, const char *b) {
    while (*a && *b) {
        char *end_a, *end_b;
        double x = strtod(a, &end_a), y = strtod(b, &end_b), bound = 1e-9 + 2e-5 * (x < 0.0 ? -x : x);
        if (end_a > a && end_b > b && x - y < bound && y - x < bound)
            a = end_a, b = end_b;
        else if (*a++ != *b++)
            fail_msg("\"%.60s\" is not \"%.60s\"", a - 1, b - 1);
    }
    assert_int_equal(*a, *b);
}

/* Runs both and compares standard output but for the names; arguments of the twin end with --lobe FILE. */
static void assert_same(const char *input, const char *const *twin, const char *const *original) {
    Ran a = run_with(input, twin), b = run_with(input, original);
    if (a.code || b.code) fail_msg("%d %s%d %s", a.code, a.err, b.code, b.err);
    assert_alike(plain(a.out), b.out);
    assert_true(strlen(a.out) > 20);
    ran_free(&a);
    ran_free(&b);
}

static void a_file_evaluates_as_a_row(void **state) {
    (void)state;
    char file[64], own[64], id[64];
    for (int k = 0; k < TWINS; k++) {
        make_twin(k, file, own);
        id_of(twins[k][0], id);
        assert_same(pairs, LIST("eval", own, "-p", "color=.5,.3,.2", "--lobe", file),
                    LIST("eval", id, "-p", "color=.5,.3,.2"));
        assert_same("0.3\n0.9\n", LIST("eval", own, "--albedo", "--lobe", file), LIST("eval", id, "--albedo"));
    }
}

static void done(const char *const *arguments) {
    Ran ran = run_with(NULL, arguments);
    if (ran.code) fail_msg("%s %s: %d %s", arguments[0], arguments[1], ran.code, ran.err);
    ran_free(&ran);
}

static void a_file_exports_as_a_row(void **state) {
    (void)state;
    static const char *const targets[] = {"glsl", "hlsl", "c"};
    char file[64], own[64];
    make_twin(3, file, own);
    for (int k = 0; k < 3; k++) {
        done(LIST("export", own, "--target", targets[k], "-o", "twin.txt", "--lobe", file));
        done(LIST("export", "eon", "--target", targets[k], "-o", "eon.txt"));
        size_t size;
        char *a = plain(file_bytes("twin.txt", &size)), *b = file_bytes("eon.txt", &size);
        const char *from_a = strstr(a, "*/"), *from_b = strstr(b, "*/"); /* the head names file and command */
        assert_non_null(from_a);
        assert_non_null(from_b);
        assert_string_equal(from_a, from_b);
        free(a);
        free(b);
    }
}

static void a_file_renders_as_a_row(void **state) {
    (void)state;
    char file[64], own[64], base[64], base_file[64];
    make_twin(7, file, own);
    make_twin(5, base_file, base);
    for (int k = 0; k < 2; k++) {
        const char *engine = k ? "raster" : "trace", *samples = k ? "--width" : "--spp";
        done(LIST("render", "builtin:spheres", "--engine", engine, samples, "16", "--height", "16", "--sheen", own,
                  "--diffuse", base, "--layer", "albedo-max", "--lobe", file, "--lobe", base_file, "-o", "twin.exr"));
        done(LIST("render", "builtin:spheres", "--engine", engine, samples, "16", "--height", "16", "--sheen",
                  "charlie-khronos", "--diffuse", "burley", "--layer", "albedo-max", "-o", "row.exr"));
        done(LIST("diff", "twin.exr", "row.exr", "--max", "1e-8"));
    }
}

static void a_file_is_plotted_matched_and_fitted(void **state) {
    (void)state;
    char file[64], own[64];
    make_twin(2, file, own);
    Ran ran = RUN("match", own, "patry", "--lobe", file);
    assert_int_equal(ran.code, 0);
    assert_non_null(strstr(ran.out, "cosine"));
    ran_free(&ran);
    assert_same(NULL, LIST("plot", "polar", own, "--title", "x", "--json", "--lobe", file),
                LIST("plot", "polar", "patry", "--title", "x", "--json"));
    ran = run_shell("for o in 10 30 50 70; do for i in 5 25 45 65; do echo $o 0 $i 60; done; done >asked && "
                    "$0 eval patry -p roughness=0.3 <asked | paste -d ' ' asked - | "
                    "sed 's/ /,/g; s/,[^,]*$//' >fit.csv && "
                    "$0 fit fit.csv --lobe my_patry.h --lobe my-patry --json");
    if (ran.code) fail_msg("%d %s", ran.code, ran.err);
    assert_non_null(strstr(ran.out, "\"my-patry\""));
    ran_free(&ran);
}

static void passport_of_a_file_is_that_of_a_row(void **state) {
    (void)state;
    char file[64], own[64];
    make_twin(1, file, own);
    Ran a = RUN("check", own, "--quick", "--lobe", file, "--json"), b = RUN("check", "wrap", "--quick", "--json");
    assert_int_equal(a.code, 0);
    assert_int_equal(b.code, 0);
    plain(a.out);
    /* up to the samples, whose p swings with rounding; the exit code is for these */
    const char *from_a = strstr(a.out, "\"albedo\""), *from_b = strstr(b.out, "\"albedo\"");
    const char *to_a = strstr(a.out, "\"sampling"), *to_b = strstr(b.out, "\"sampling");
    assert_true(from_a && from_b && to_a && to_b);
    a.out[to_a - a.out] = b.out[to_b - b.out] = '\0';
    assert_alike(from_a, from_b);
    ran_free(&a);
    ran_free(&b);
}

/* The toy: a lobe of a new kind, with prepared state and a colour rule of its own. */
#define TOY WEFT_SOURCE_DIR "/tests/lobes/toy.h"

static void assert_near(double x, double expected) {
    if (!(x > expected - 1e-6 && x < expected + 1e-6)) fail_msg("%g is not %g", x, expected);
}

static void toy_loaded_from_a_file_is_listed_as_a_lobe(void **state) {
    (void)state;
    double f[4];
    Ran ran = run_with("60 0 0 0\n", LIST("eval", "toy", "-p", "color=.5,1,.5", "-p", "roughness=0", "--lobe", TOY));
    if (ran.code) fail_msg("%s", ran.err);
    assert_int_equal(sscanf(ran.out, "%lf %lf %lf %lf", f, f + 1, f + 2, f + 3), 4);
    /* in front s is 0: 3 / (2 pi) cos 60 c, and the density 3 / (2 pi) */
    assert_near(f[0], 0.11936620);
    assert_near(f[1], 0.23873241);
    assert_near(f[3], 0.47746483);
    ran_free(&ran);
    ran = run_with("60 0 60 90\n", LIST("eval", "toy", "-p", "color=.5,1,.5", "-p", "roughness=1", "--lobe", TOY));
    assert_int_equal(sscanf(ran.out, "%lf", f), 1);
    assert_near(f[0], 0.5 / PI_DOUBLE * (0.75 + 0.25 * 0.5)); /* s = 1/4, second colour c c */
    ran_free(&ran);
    ran = RUN("models", "toy", "--lobe", TOY);
    assert_non_null(strstr(ran.out, "how slowly it darkens"));
    assert_non_null(strstr(ran.out, "scattered twice"));
    ran_free(&ran);
    ran = RUN("models", "--lobe", TOY);
    assert_non_null(strstr(ran.out, "\n  toy "));
    ran_free(&ran);
    done(LIST("check", "toy", "--quick", "--max-albedo", "1.001", "--max-reciprocity", "1e-5", "--lobe", TOY));
}

/* The writer: what functions write through references is the same in the text of every language. */
#define WRITER WEFT_SOURCE_DIR "/tests/lobes/writer.h"

static const char writer_main[] =
    "#include \"writer.c\"\n"
    "#include <stdio.h>\n"
    "int main(void) {\n"
    "    WeftxDir o = {0.6f, 0.0f, 0.8f}, i[2] = {{0.0f, 0.6f, 0.8f}, {0.96f, 0.0f, 0.28f}};\n"
    "    WeftxRgb c = {0.5f, 1.0f, 0.25f};\n"
    "    for (int k = 0; k < 2; k++) {\n"
    "        WeftxRgb f = weftx_writer_eval(weftx_writer_default(), c, c, o, i[k]);\n"
    "        printf(\"%.8g %.8g %.8g %.8g\\n\", f.r, f.g, f.b,\n"
    "               weftx_writer_pdf(weftx_writer_default(), o, i[k]));\n"
    "    }\n"
    "    return 0;\n"
    "}\n";

static void exported_c_of_a_lobe_file_evaluates_as_the_lobe(void **state) {
    (void)state;
    done(LIST("export", "writer", "--target", "c", "-o", "writer.c", "--lobe", WRITER));
    file_make("main.c", writer_main, strlen(writer_main));
    Ran made = run_shell("cc -std=c99 -Wall -Wextra -Wno-unused-variable -Werror -O1 main.c -o writer -lm && "
                         "./writer");
    if (made.code) fail_msg("%s", made.err);
    Ran asked = run_with("36.8698976 0 36.8698976 90\n36.8698976 0 73.7397953 0\n",
                         LIST("eval", "writer", "-p", "color=.5,1,.25", "--lobe", WRITER));
    if (asked.code) fail_msg("%s", asked.err);
    const char *a = made.out, *b = asked.out;
    for (int k = 0; k < 8; k++) {
        char *end_a, *end_b;
        double x = strtod(a, &end_a), y = strtod(b, &end_b);
        assert_true(end_a > a && end_b > b && y > 0.0);
        if (!(x > y * 0.9999 && x < y * 1.0001)) fail_msg("%g is not %g", x, y);
        a = end_a, b = end_b;
    }
    ran_free(&made);
    ran_free(&asked);
    done(LIST("export", "writer", "--target", "glsl", "-o", "writer.glsl", "--lobe", WRITER));
    made = run_shell("command -v glslangValidator >/dev/null || exit 0; { echo '#version 330 core'; cat "
                     "writer.glsl; echo 'out vec4 c; void main() { c = vec4(weft_writer_eval("
                     "weft_writer_default(), vec3(1), vec3(1), vec3(0, 0, 1), vec3(0, 0, 1)), 1); }'; } "
                     ">writer.frag && glslangValidator writer.frag && grep -q writer_halve writer.frag");
    if (made.code) fail_msg("%s%s", made.out, made.err);
    ran_free(&made);
}

/* Its loops over arrays are ones of vectors, as those of the catalogue: the test vector. */
static void toy_loaded_from_a_file_compiles_to_vector_loops(void **state) {
    (void)state;
#if defined(__x86_64__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__)
    Ran ran = run_shell("XDG_CACHE_HOME=$PWD/cache CC= $0 models toy --lobe '" TOY "' >/dev/null && "
                        "'" WEFT_SOURCE_DIR "/tests/vector.sh' cache/weft/*.so 6; code=$?; rm -r cache; exit $code");
    if (ran.code != 0 && ran.code != 77) fail_msg("%s%s", ran.out, ran.err);
    ran_free(&ran);
#else
    skip();
#endif
}

/* Bad files. */

static void file_of(const char *name, const char *text) { file_make(name, text, strlen(text)); }

/* The toy after an order to sed, as toy2.h. */
static void toy_with(const char *order) {
    char line[600];
    snprintf(line, sizeof line, "sed 's/toy_/toy2_/g; s/Toy/Toy2/g; s/TOY_/TOY2_/g' '%s' | sed '%s' >toy2.h", TOY,
             order);
    Ran ran = run_shell(line);
    assert_int_equal(ran.code, 0);
    ran_free(&ran);
}

static void refused(const char *file, int code, const char *part) {
    assert_complaint("0 0 0 0\n", LIST("eval", "lambert", "--lobe", file), code, part);
}

static void bad_lobe_file_is_an_error_of_one_line(void **state) {
    (void)state;
    refused("nowhere.h", 3, "nowhere.h: cannot be opened");
    assert_int_equal(mkdir("folder.h", 0700), 0);
    refused("folder.h", 3, "folder.h");
    assert_int_equal(rmdir("folder.h"), 0);
    file_of("lambert.h", "");
    refused("lambert.h", 3, "the catalogue has a lobe lambert");
    file_of("Bad Name.h", "");
    refused("Bad Name.h", 3, "lower-case letters");
    refused("lambert", 3, "lambert: cannot be opened");
    file_of("empty.h", "");
    refused("empty.h", 3, "it has no EMPTY_PARAMS(");

    toy_with("s/p->power = 1.0f - m.roughness;/p->power = 1.0f - m.rougness;/");
    refused("toy2.h", 3, "toy2.h:25: does not compile: ");
    toy_with("s/p->power = 1.0f - m.roughness;/p->power = = 1;/");
    refused("toy2.h", 3, "toy2.h:25: does not compile: ");
    toy_with("s/#include \"shading.lobe.lobe.h\"/#include \"other.h\"/");
    refused("toy2.h", 3, "toy2.h:14: is not shading text: includes other.h, which does not exist");
    toy_with("s/{ float power, scale, fade; }/{ float power, scale, fade, big[166]; }/");
    refused("toy2.h", 3, "Toy2Prepared has 676 bytes, and 672 is the most");
    toy_with("s/P(float, fade, 1.0f, 0.0f/P(float, fade, 1.0f, 2.0f/");
    refused("toy2.h", 3, "the ranges of fade do not nest");
    toy_with("s/TRAIT_CONSERVES/TRAIT_REFERENCE/");
    refused("toy2.h", 3, "random walks are for the lobes of the catalogue");
}

/* The cache is new and $PATH has no cc, or $CC no program. */
static void lobe_file_without_a_compiler_is_an_error(void **state) {
    (void)state;
    static const char *const none[] = {
        "mkdir -p cache bin && ln -sf /usr/bin/env bin/env && XDG_CACHE_HOME=$PWD/cache CC= PATH=$PWD/bin "
        "$0 models toy --lobe " TOY,
        "XDG_CACHE_HOME=$PWD/cache CC='no-such-compiler -O' $0 models toy --lobe " TOY};
    for (int k = 0; k < 2; k++) {
        Ran ran = run_shell(none[k]);
        if (ran.code != 4 || !one_complaint(ran.err) || !strstr(ran.err, "needs a C compiler"))
            fail_msg("%d %s", ran.code, ran.err);
        ran_free(&ran);
    }
    Ran ran = run_shell("XDG_CACHE_HOME=$PWD/cache $0 models toy --lobe " TOY " && ls cache/weft && "
                        "XDG_CACHE_HOME=$PWD/cache PATH=$PWD/bin $0 models toy --lobe " TOY " && "
                        "/bin/rm -r cache bin");
    if (ran.code) fail_msg("what was compiled once is not taken: %s", ran.err);
    assert_non_null(strstr(ran.out, ".so"));
    ran_free(&ran);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_file_evaluates_as_a_row),
        cmocka_unit_test(a_file_exports_as_a_row),
        cmocka_unit_test(a_file_renders_as_a_row),
        cmocka_unit_test(a_file_is_plotted_matched_and_fitted),
        cmocka_unit_test(passport_of_a_file_is_that_of_a_row),
        cmocka_unit_test(toy_loaded_from_a_file_is_listed_as_a_lobe),
        cmocka_unit_test(exported_c_of_a_lobe_file_evaluates_as_the_lobe),
        cmocka_unit_test(toy_loaded_from_a_file_compiles_to_vector_loops),
        cmocka_unit_test(bad_lobe_file_is_an_error_of_one_line),
        cmocka_unit_test(lobe_file_without_a_compiler_is_an_error),
    };
    return cmocka_run_group_tests(tests, work_begin, work_end);
}
