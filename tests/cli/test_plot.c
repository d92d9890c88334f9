/* weft plot: files of every kind, numbers as JSON and CSV, one line for every mistake. */
#include <math.h>

#include <jansson.h>

#include "base/pi.h"
#include "run.h"
#include "weft/weft.h"
#include "woven_presets.h"

static const char *const kinds[] = {"polar", "lobe3d", "cartesian", "albedo",    "furnace",
                                    "slice", "sphere", "samples",   "difference"};
enum { KINDS = sizeof kinds / sizeof *kinds };

static void assert_begins(const char *path, const char *magic) {
    size_t size;
    char *bytes = file_bytes(path, &size);
    assert_non_null(bytes);
    assert_true(size > 1000);
    assert_memory_equal(bytes, magic, strlen(magic));
    free(bytes);
    unlink(path);
}

static void every_kind_of_plot_is_written(void **state) {
    (void)state;
    static const char *const files[][2] = {
        {"a.png", "\x89PNG"}, {"a.svg", "<?xml"}, {"a.pdf", "%PDF"}, {"A.PNG", "\x89PNG"}};
    for (int k = 0; k < KINDS; k++) {
        const char *const *file = files[k % 4];
        Ran ran = RUN("plot", kinds[k], "charlie-neubelt:alpha=0.3", "ggx", "--quick", "--size", "400", "-o", file[0]);
        if (ran.code != 0) fail_msg("%s: %d: %s", kinds[k], ran.code, ran.err);
        assert_string_equal(ran.out, "");
        assert_string_equal(ran.err, "");
        ran_free(&ran);
        assert_begins(file[0], file[1]);
    }
}

static void models_of_all_kinds_share_one_figure(void **state) {
    (void)state;
    Ran ran = RUN("plot", "polar", "fibre", "three:sheen_roughness=0.4", "preset:velvet", "--view", "30", "--view",
                  "75", "--log", "--cos", "--channel", "red", "--title", "A & B <c>", "-o", "all.svg");
    if (ran.code != 0) fail_msg("%d: %s", ran.code, ran.err);
    ran_free(&ran);
    size_t size;
    char *svg = file_bytes("all.svg", &size);
    assert_non_null(strstr(svg, "<title>A &amp; B &lt;c&gt;</title>"));
    free(svg);
    ran = RUN("plot", "report", "fibre", "three", "--quick", "-o", "page.html");
    if (ran.code != 0) fail_msg("%d: %s", ran.code, ran.err);
    ran_free(&ran);
    assert_begins("page.html", "<!DOCTYPE html>");
}

static void file_of(const char *path, const char *text) { file_make(path, text, strlen(text)); }

/* Presets that are woven, and a material file that is, without a word of what is left out. */
static void weaves_are_plotted_as_any_model(void **state) {
    (void)state;
    int count = 0;
    for (int k = 0; weft_preset_name(k); k++) {
        char model[96];
        if (woven_family(weft_preset_name(k)) < 0) continue;
        snprintf(model, sizeof model, "preset:%s", weft_preset_name(k));
        Ran ran = RUN("plot", "cartesian", model, "--quick", "--csv", "-o", "weave.svg");
        if (ran.code != 0 || *ran.err) fail_msg("%s: %d: %s", model, ran.code, ran.err);
        assert_non_null(strstr(ran.out, model));
        ran_free(&ran);
        count++;
    }
    assert_true(count >= WOVEN_PRESETS);
    assert_begins("weave.svg", "<?xml");
    file_of("shot.json", "{\"weave\": {\"draft\": \"plain; warp 1#ff0000; weft 1#0000ff\"}}");
    assert_complaint(NULL, LIST("plot", "samples", "shot.json", "-o", "shot.png"), 2, "is not a lobe");
    Ran ran = RUN("plot", "report", "shot.json", "woven", "--quick", "-o", "shot.html");
    if (ran.code != 0 || *ran.err) fail_msg("%d: %s", ran.code, ran.err);
    ran_free(&ran);
    assert_begins("shot.html", "<!DOCTYPE html>");
    file_of("none.json", "{\"weave\": {\"draft\": \"nowhere.wif\"}}");
    assert_complaint(NULL, LIST("plot", "polar", "none.json", "-o", "none.svg"), 3,
                     "nowhere.wif: cannot be opened: No such file or directory (the draft of none.json)");
    unlink("none.json");
    unlink("shot.json");
}

static void json_has_the_numbers_that_are_drawn(void **state) {
    (void)state;
    Ran ran = RUN("plot", "cartesian", "lambert:color=0.5", "ggx:alpha=0.3", "--view", "45", "--json");
    assert_int_equal(ran.code, 0);
    json_error_t problem;
    json_t *root = json_loads(ran.out, 0, &problem);
    if (!root) fail_msg("line %d: %s", problem.line, problem.text);
    assert_string_equal(json_string_value(json_object_get(root, "kind")), "cartesian");
    json_t *panels = json_object_get(root, "panels");
    assert_int_equal(json_array_size(panels), 2);
    json_t *series = json_object_get(json_array_get(panels, 0), "series");
    assert_int_equal(json_array_size(series), 2);
    json_t *y = json_object_get(json_array_get(series, 0), "y");
    assert_true(json_array_size(y) > 300);
    for (size_t k = 0; k < json_array_size(y); k++)
        assert_true(fabs(json_number_value(json_array_get(y, k)) - 0.5 / PI_DOUBLE) < 1e-6);
    assert_string_equal(json_string_value(json_object_get(json_array_get(series, 1), "label")), "ggx:alpha=0.3");
    json_decref(root);
    ran_free(&ran);
    for (int k = 0; k < KINDS; k++) { /* all are JSON, and a file beside it is no harm */
        ran = RUN("plot", kinds[k], "ashikhmin-neubelt", "lambert", "--quick", "--json", "-o", "beside.png");
        assert_int_equal(ran.code, 0);
        root = json_loads(ran.out, 0, &problem);
        if (!root) fail_msg("%s: line %d: %s", kinds[k], problem.line, problem.text);
        assert_true(json_array_size(json_object_get(root, "panels")) > 0);
        json_decref(root);
        ran_free(&ran);
        assert_begins("beside.png", "\x89PNG");
    }
}

/* Lines that start with a heading, each of as many fields. */
static void csv_has_one_row_for_each_sample(void **state) {
    (void)state;
    static const char *const headings[][3] = {{"polar", "panel,series,x,y\n", "lambert"},
                                              {"difference", "panel,channel,x,y,value\n", "max(A, B)"},
                                              {"sphere", "panel,channel,x,y,value\n", ",r,"}};
    for (int k = 0; k < 3; k++) {
        Ran ran = RUN("plot", headings[k][0], "lambert", "ggx", "--quick", "--csv");
        assert_int_equal(ran.code, 0);
        assert_memory_equal(ran.out, headings[k][1], strlen(headings[k][1]));
        assert_non_null(strstr(ran.out, headings[k][2]));
        size_t fields = 0, lines = 0;
        for (const char *s = headings[k][1]; *s; s++) fields += *s == ',';
        for (const char *line = ran.out; *line; line += strcspn(line, "\n") + 1, lines++) {
            size_t commas = 0;
            bool quoted = false;
            for (const char *s = line; *s && *s != '\n'; s++) {
                if (*s == '"') quoted = !quoted;
                commas += *s == ',' && !quoted;
            }
            assert_int_equal(commas, fields);
        }
        assert_true(lines > 500);
        ran_free(&ran);
    }
}

static void two_runs_write_the_same_bytes(void **state) {
    (void)state;
    static const char *const files[] = {"one.svg", "one.pdf", "one.png"};
    for (int k = 0; k < 3; k++) {
        char *first = NULL;
        size_t size = 0;
        for (int turn = 0; turn < 2; turn++) {
            Ran ran = RUN("plot", k ? "lobe3d" : "slice", "fibre", "three", "--quick", "-o", files[k]);
            assert_int_equal(ran.code, 0);
            ran_free(&ran);
            if (turn)
                assert_true(same_bytes(files[k], first, size));
            else
                first = file_bytes(files[k], &size);
        }
        free(first);
    }
}

static void plot_commands_without_sense_are_refused(void **state) {
    (void)state;
    assert_complaint(NULL, LIST("plot"), 2, "lacks an operand");
    assert_complaint(NULL, LIST("plot", "polar"), 2, "lacks an operand");
    assert_complaint(NULL, LIST("plot", "poler", "ggx", "-o", "a.png"), 2, "did you mean polar?");
    assert_complaint(NULL, LIST("plot", "zzzzzz", "ggx", "-o", "a.png"), 2, "see weft plot --help");
    assert_complaint(NULL, LIST("plot", "polar", "ggx"), 2, "needs -o FILE");
    assert_complaint(NULL, LIST("plot", "report", "ggx"), 2, "needs -o FILE.html");
    assert_complaint(NULL, LIST("plot", "polar", "gxx", "-o", "a.png"), 2, "did you mean ggx?");
    assert_complaint(NULL, LIST("plot", "polar", "ggx:alhpa=1", "-o", "a.png"), 2, "alhpa");
    assert_complaint(NULL, LIST("plot", "polar", "none.binary", "-o", "a.png"), 3, "none.binary: cannot be opened");
    assert_complaint(NULL, LIST("plot", "difference", "ggx", "-o", "a.png"), 2, "is of two models, not 1");
    assert_complaint(NULL, LIST("plot", "difference", "ggx", "ggx", "ggx", "-o", "a.png"), 2, "not 3");
    assert_complaint(NULL, LIST("plot", "samples", "three", "-o", "a.png"), 2, "three: is not a lobe");
    assert_complaint(NULL, LIST("plot", "polar", "ggx", "-o", "a.jpg"), 2, "a plot is a .png, .svg or .pdf");
    assert_complaint(NULL, LIST("plot", "report", "ggx", "-o", "a.png"), 2, "a report is an .html");
    assert_complaint(NULL, LIST("plot", "report", "ggx", "--json", "-o", "a.html"), 2, "has no numbers");
    assert_complaint(NULL, LIST("plot", "polar", "ggx", "-o", "no/a.png"), 4, "no/a.png: cannot be written");
    assert_complaint(NULL, LIST("plot", "polar", "ggx", "--json", "--csv"), 2, "does not go with --json");
    assert_complaint(NULL, LIST("plot", "polar", "ggx", "--view", "90", "-o", "a.png"), 2, "below 90");
    assert_complaint(NULL, LIST("plot", "polar", "ggx", "--view", "x", "-o", "a.png"), 2, "--view");
    assert_complaint(NULL, LIST("plot", "polar", "ggx", "--size", "12", "-o", "a.png"), 2, "--size");
    assert_complaint(NULL, LIST("plot", "polar", "ggx", "--size", "400x", "-o", "a.png"), 2, "--size");
    assert_complaint(NULL, LIST("plot", "polar", "ggx", "--size", "99999", "-o", "a.png"), 2, "--size");
    assert_complaint(NULL, LIST("plot", "polar", "ggx", "--channel", "alpha", "-o", "a.png"), 2,
                     "not one of luminance, red, green, blue");
    assert_complaint(
        NULL, LIST("plot", "polar", "ggx", "ggx", "ggx", "ggx", "ggx", "ggx", "ggx", "ggx", "ggx", "-o", "a.png"), 2,
        "one operand too many");
    assert_complaint(NULL,
                     LIST("plot", "polar", "ggx", "--view", "1", "--view", "2", "--view", "3", "--view", "4", "--view",
                          "5", "--view", "6", "--view", "7", "-o", "a.png"),
                     2, "more than 6 times");
    size_t size;
    assert_null(file_bytes("a.png", &size));
}

static void plot_help_lists_the_kinds(void **state) {
    (void)state;
    Ran ran = RUN("plot", "--help");
    assert_int_equal(ran.code, 0);
    for (int k = 0; k < KINDS; k++) {
        char line[40];
        snprintf(line, sizeof line, "\n  %s ", kinds[k]);
        if (!strstr(ran.out, line)) fail_msg("help lacks %s", kinds[k]);
    }
    assert_non_null(strstr(ran.out, "\n  report "));
    for (const char *line = ran.out; *line; line += strcspn(line, "\n") + 1) assert_true(strcspn(line, "\n") <= 80);
    ran_free(&ran);
}

/* Text is drawn with a font that weft names: what fonts a user has, and whether fontconfig works, changes nothing. */
static void figure_is_the_same_whatever_fonts_are_configured(void **state) {
    (void)state;
    if (access("/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf", R_OK) != 0) skip();
    static const char *const suffixes[] = {"svg", "pdf", "png"};
    char line[300];
    for (int k = 0; k < 3; k++) {
        snprintf(line, sizeof line,
                 "$0 plot polar ggx -o usual.%s >/dev/null && FONTCONFIG_FILE=/nowhere FONTCONFIG_PATH=/nowhere "
                 "$0 plot polar ggx -o fonts.%s >/dev/null && cmp usual.%s fonts.%s",
                 suffixes[k], suffixes[k], suffixes[k], suffixes[k]);
        Ran ran = run_shell(line);
        if (ran.code != 0 || strstr(ran.err, "ontconfig"))
            fail_msg("%s: %d: %s%s", suffixes[k], ran.code, ran.out, ran.err);
        ran_free(&ran);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_kind_of_plot_is_written),
        cmocka_unit_test(models_of_all_kinds_share_one_figure),
        cmocka_unit_test(weaves_are_plotted_as_any_model),
        cmocka_unit_test(json_has_the_numbers_that_are_drawn),
        cmocka_unit_test(csv_has_one_row_for_each_sample),
        cmocka_unit_test(two_runs_write_the_same_bytes),
        cmocka_unit_test(plot_commands_without_sense_are_refused),
        cmocka_unit_test(figure_is_the_same_whatever_fonts_are_configured),
        cmocka_unit_test(plot_help_lists_the_kinds),
    };
    return cmocka_run_group_tests(tests, work_begin, work_end);
}
