/* Help, version, and every way to type something wrong. */
#include "run.h"

static const char *const render_options[] = {
    "-o",       "--width",      "--height",   "--spp",      "--max-depth",    "--time-limit",
    "--crop",   "--camera",     "--env",      "--exposure", "--env-rotation", "--tonemap",
    "--seed",   "--background", "--quiet",    "--threads",  "--variant",      "--set",
    "--sheen",  "--layer",      "--sampling", "--json",     "--help",         "--env-strength",
    "--preset", "--material",   "--workflow", "--profile",  "--diffuse",      "--convert",
    NULL};

static void check_fits(const char *verb, const char *help) {
    for (const char *line = help; *line; line += strcspn(line, "\n") + 1)
        if (strcspn(line, "\n") > 80) fail_msg("weft %s --help: over 80 columns: %.100s", verb, line);
}

/* The help of a verb holds each option at the start of a line, and fits. */
static void check_help(const char *verb, const char *const *options) {
    Ran ran = RUN(verb, "--help");
    assert_int_equal(ran.code, 0);
    assert_string_equal(ran.err, "");
    for (int k = 0; options[k]; k++) {
        char row[64];
        snprintf(row, sizeof row, "\n  %s ", options[k]);
        if (!strstr(ran.out, row)) fail_msg("weft %s --help lacks %s", verb, options[k]);
    }
    check_fits(verb, ran.out);
    assert_non_null(strstr(ran.out, "Usage: weft "));
    assert_non_null(strstr(ran.out, "\nExamples\n"));
    ran_free(&ran);
}

static void help_of_every_verb_names_its_options(void **state) {
    (void)state;
    check_help("render", render_options);
    check_help("models", LIST("--json", "--help"));
    check_help("eval", LIST("-p", "--albedo", "--json", "--help"));
    Ran ran = RUN("--help");
    assert_int_equal(ran.code, 0);
    assert_true(strstr(ran.out, "\n  render ") && strstr(ran.out, "\n  models ") && strstr(ran.out, "\n  eval "));
    ran_free(&ran);
    ran = RUN("--version");
    assert_int_equal(ran.code, 0);
    assert_memory_equal(ran.out, "weft ", 5);
    ran_free(&ran);
}

/* Takes the verbs from the list of them: two spaces, a verb, more spaces. */
static void help_of_every_verb_fits_a_terminal(void **state) {
    (void)state;
    Ran list = RUN("--help");
    int count = 0;
    for (char *line = strchr(list.out, '\n'); line && line[1]; line = strchr(line + 1, '\n')) {
        char verb[16] = "";
        if (sscanf(line, "\n  %15[a-z]  ", verb) != 1 || line[3] == ' ') continue;
        Ran help = RUN(verb, "--help");
        if (help.code == 0) check_fits(verb, help.out), count++;
        ran_free(&help);
    }
    if (count < 15) fail_msg("%d verbs were found", count);
    ran_free(&list);
}

static void help_and_version_work_as_words_and_as_options(void **state) {
    (void)state;
    static const struct {
        const char *words[3], *options[3];
    } pairs[] = {{{"help"}, {"--help"}}, {{"version"}, {"--version"}}, {{"help", "eval"}, {"eval", "--help"}}};
    for (size_t k = 0; k < sizeof pairs / sizeof *pairs; k++) {
        Ran word = run_with(NULL, pairs[k].words), option = run_with(NULL, pairs[k].options);
        assert_int_equal(word.code, 0);
        assert_true(word.out[0]);
        assert_string_equal(word.out, option.out);
        ran_free(&word), ran_free(&option);
    }
    assert_complaint(NULL, LIST("help", "rendr"), 2, "did you mean render?");
    assert_complaint(NULL, LIST("help", "eval", "x"), 2, "x: is one operand too many");
}

/* What is empty has no name to begin a line with. */
static void empty_argument_is_quoted_in_its_error(void **state) {
    (void)state;
    assert_complaint(NULL, LIST(""), 2, "weft: \"\": is not a verb");
    assert_complaint(NULL, LIST("models", ""), 2, "weft: \"\": is no operand");
    assert_complaint(NULL, LIST("render", "", "-o", "a.png"), 2, "weft: \"\": is no operand");
    assert_complaint(NULL, LIST("render", "a.glb", "-o", ""), 2, "weft: -o: \"\" is no value");
    assert_complaint(NULL, LIST("render", "a.glb", "-o", "a.png", "--env="), 2, "weft: --env: \"\" is no value");
    assert_complaint(NULL, LIST("check", "lambert", "--html="), 2, "weft: --html: \"\" is no value");
}

/* Lists the verbs on the error stream, as that is no answer; the first line says what is missing. */
static void without_a_verb_the_verbs_are_listed(void **state) {
    (void)state;
    static const char *const names[] = {"\n  render ", "\n  view ", "\n  models ", "\n  weave ", "\n  match "};
    Ran ran = run_with(NULL, (const char *const[]){NULL});
    assert_int_equal(ran.code, 2);
    assert_string_equal(ran.out, "");
    assert_int_equal(strncmp(ran.err, "weft: a verb is needed", 22), 0);
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) assert_non_null(strstr(ran.err, names[k]));
    ran_free(&ran);
}

static void usage_error_is_one_line(void **state) {
    (void)state;
    assert_complaint(NULL, LIST("rendr"), 2, "did you mean render?");
    assert_complaint(NULL, LIST("x\ny"), 2, "x?y: is not a verb");
    assert_complaint(NULL, LIST("render"), 2, "SCENE... -o OUT");
    assert_complaint(NULL, LIST("render", "a.glb"), 2, "-o OUT");
    assert_complaint(NULL, LIST("render", "a.glb", "b.glb", "-o", "o.png"), 2, "one file for 2 assets");
    assert_complaint(NULL, LIST("render", "a.glb", "-o"), 2, "-o: needs a value");
    assert_complaint(NULL, LIST("render", "a.glb", "-o", "o.png", "--spp", "--quiet"), 2, "--spp: needs a value");
    assert_complaint(NULL, LIST("render", "a.glb", "-o", "o.png", "--time-limt", "3"), 2, "did you mean --time-limit?");
    assert_complaint(NULL, LIST("render", "a.glb", "-o", "o.png", "--widht=3"), 2, "did you mean --width?");
    assert_complaint(NULL, LIST("render", "a.glb", "-o", "o.png", "--zzzzzz"), 2, "weft render --help");
    assert_complaint(NULL, LIST("render", "a.glb", "-o", "o.png", "--quiet=1"), 2, "takes no value");
    assert_complaint(NULL, LIST("render", "a.glb", "-o", "o.png", "--spp", "3", "--spp=4"), 2, "given twice");
    assert_complaint(NULL, LIST("render", "a.glb", "-o", "o.jpg"), 2, "o.jpg: has no suffix");
    assert_complaint(NULL, LIST("models", "charlie-nuebelt"), 2, "did you mean charlie-neubelt?");
    assert_complaint(NULL, LIST("eval"), 2, "MODEL");
    assert_complaint(NULL, LIST("eval", "gx"), 2, "did you mean ggx?");
    assert_complaint(NULL, LIST("eval", "ggx", "-p", "alpha"), 2, "name=value");
    assert_complaint(NULL, LIST("eval", "ggx", "-p", "beta=1"), 2, "beta: is not a parameter");
    assert_complaint(NULL, LIST("eval", "ggx", "-p", "alpha=1x"), 2, "1x: is not a value");
}

/* Every wrong number is refused before anything is read: there is no a.glb. */
static void numbers_outside_their_range_are_refused(void **state) {
    (void)state;
    static const char *const wrong[] = {"--width=0",
                                        "--width=65537",
                                        "--width=1.5",
                                        "--height=-3",
                                        "--height=",
                                        "--spp=0",
                                        "--spp=12x",
                                        "--spp=nan",
                                        "--spp=1e99",
                                        "--max-depth=0",
                                        "--time-limit=0",
                                        "--time-limit=inf",
                                        "--time-limit=3s",
                                        "--seed=-1",
                                        "--threads=0",
                                        "--exposure=nan",
                                        "--threads=257",
                                        "--env=-1",
                                        "--exposure=1,2",
                                        "--env-rotation=x",
                                        "--env-strength=-1",
                                        "--crop=1,2,3",
                                        "--crop=0,0,0,5",
                                        "--crop=0,0,5,5,",
                                        "--crop=950,0,20,5",
                                        "--crop=0.5,0,2,2",
                                        "--crop=nan,0,2,2",
                                        "--tonemap=filmic",
                                        "--sampling=all",
                                        "--background=blue",
                                        "--background=1,2",
                                        "--background=-1,0,0",
                                        "--sheen=velvet",
                                        "--layer=glue",
                                        "--set=roughness=1",
                                        "--set=cloth.roughness",
                                        "--env-ambient=-1",
                                        "--env-reflection=x",
                                        "--exposure=33",
                                        "--exposure=automatic",
                                        "--white-balance=0",
                                        "--white-balance=6500,51",
                                        "--white-balance=6500,0,0",
                                        "--white-balance=warm"};
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        char name[32];
        snprintf(name, sizeof name, "%.*s", (int)strcspn(wrong[k], "="), wrong[k]);
        bool by_value = strcmp(name, "--sheen") == 0 || strcmp(name, "--layer") == 0;
        assert_complaint(NULL, LIST("render", "a.glb", "-o", "o.png", wrong[k]), 2, by_value ? "is not a" : name);
    }
}

/* A number that the command would not need is looked at all the same. */
static void numbers_without_a_use_are_checked(void **state) {
    (void)state;
    static const char *const wrong[] = {"--size=0", "--size=1000000", "--size=20.5", "--seed=x", "--yarn=steel"};
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++)
        assert_complaint(NULL, LIST("weave", "plain", wrong[k]), 2, strchr(wrong[k], '=') + 1);
    assert_complaint(NULL, LIST("weave", "plain; both 600k 600r", "--yarn=steel"), 2, "steel");
    assert_complaint(NULL, LIST("render", "builtin:ball", "--engine=raster", "-o", "a.png", "--spp=0"), 2, "--spp");
    assert_complaint(NULL, LIST("view", "--windowless", "--frames=0"), 2, "--frames");
}

/* Only options that the verb has are offered; fit has no samples a pixel. */
static void words_of_other_renderers_are_understood(void **state) {
    (void)state;
    static const char *const pairs[][2] = {{"--samples=4", "did you mean --spp?"},
                                           {"--size=64", "did you mean --width?"},
                                           {"--output=o.png", "did you mean -o?"},
                                           {"--resolution=64", "did you mean --width?"},
                                           {"--out=o.png", "did you mean -o?"},
                                           {"--environment=a.hdr", "did you mean --env?"},
                                           {"--bounces=1", "the path tracer has --max-depth"},
                                           {"--hdri=a.hdr", "did you mean --env?"}};
    for (size_t k = 0; k < sizeof pairs / sizeof *pairs; k++)
        assert_complaint(NULL, LIST("render", "a.glb", pairs[k][0]), 2, pairs[k][1]);
    assert_complaint(NULL, LIST("fit", "--samples=4", "a"), 2, "see weft fit --help");
    assert_complaint(NULL, LIST("view", "--size=64", "a.glb"), 2, "did you mean --width?");
}

static void floor_options_without_a_floor_are_refused(void **state) {
    (void)state;
    static const char *const verbs[] = {"render", "view"};
    for (int k = 0; k < 2; k++) {
        assert_complaint(NULL, LIST(verbs[k], "builtin:cloth", "--floor-reflection=0.5"), 2,
                         "--floor-reflection: needs --floor");
        assert_complaint(NULL, LIST(verbs[k], "builtin:cloth", "--floor-roughness=0.5"), 2,
                         "--floor-roughness: needs --floor");
    }
}

static void closed_pipe_ends_a_command_quietly(void **state) {
    (void)state;
    Ran ran = run_shell("\"$0\" models | head -n 1");
    assert_int_equal(ran.code, 0);
    assert_string_equal(ran.err, "");
    assert_string_equal(ran.out, "D terms: distributions\n");
    ran_free(&ran);
    ran = run_shell("yes 30 0 60 180 | \"$0\" eval lambert | head -n 1"); /* ends only if the pipe ends it */
    assert_string_equal(ran.err, "");
    ran_free(&ran);
}

static void full_disk_is_an_error(void **state) {
    (void)state;
    static const char *const lines[] = {"\"$0\" models > /dev/full", "\"$0\" --help > /dev/full",
                                        "yes 30 0 60 180 | \"$0\" eval lambert > /dev/full"};
    for (size_t k = 0; k < sizeof lines / sizeof *lines; k++) {
        Ran ran = run_shell(lines[k]);
        assert_int_equal(ran.code, 4);
        assert_true(one_complaint(ran.err));
        ran_free(&ran);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(help_of_every_verb_names_its_options),
        cmocka_unit_test(help_of_every_verb_fits_a_terminal),
        cmocka_unit_test(usage_error_is_one_line),
        cmocka_unit_test(without_a_verb_the_verbs_are_listed),
        cmocka_unit_test(numbers_outside_their_range_are_refused),
        cmocka_unit_test(closed_pipe_ends_a_command_quietly),
        cmocka_unit_test(full_disk_is_an_error),
        cmocka_unit_test(help_and_version_work_as_words_and_as_options),
        cmocka_unit_test(empty_argument_is_quoted_in_its_error),
        cmocka_unit_test(numbers_without_a_use_are_checked),
        cmocka_unit_test(words_of_other_renderers_are_understood),
        cmocka_unit_test(floor_options_without_a_floor_are_refused),
    };
    return cmocka_run_group_tests(tests, work_begin, work_end);
}
