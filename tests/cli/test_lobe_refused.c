/* --lobe FILE.h: names that others have, parameters that are none, bytes that are no text; compilers that
 * cannot be run; libraries in the cache that somebody else may have written */
#include "run.h"

/* The toy as FILE.h after an order to sed, with records of that name. */
static void toy_as(const char *name, const char *record, const char *macros, const char *order) {
    char line[600];
    snprintf(line, sizeof line, "sed 's/toy_/%s_/g; s/Toy/%s/g; s/TOY_/%s_/g; %s' '%s' >%s.h", name, record, macros,
             order, WEFT_SOURCE_DIR "/tests/lobes/toy.h", name);
    Ran ran = run_shell(line);
    if (ran.code) fail_msg("%s", ran.err);
    ran_free(&ran);
}

static void refused(const char *file, const char *part) {
    assert_complaint("0 0 0 0\n", LIST("eval", "lambert", "--lobe", file), 3, part);
}

static void lobe_name_that_is_taken_or_malformed_is_refused(void **state) {
    (void)state;
    static const char *const names[][4] = {
        {"toy_", "Toy", "TOY_", "lower-case letters, digits and single _ between"},
        {"a__b", "AB", "A__B", "lower-case letters, digits and single _ between"},
        {"stack", "Stack", "STACK", "its Stack would be that of shading/stack/stack.h"},
        {"slot", "Slot", "SLOT", "its Slot would be that of shading/"},
        {"surface", "Surface", "SURFACE", "its Surface would be that of shading/"},
        {"lobe", "Lobe", "LOBE", "its Lobe would be that of "},
        {"outside", "Outside", "OUTSIDE", "its Outside would be that of "},
        {"d_term", "DTerm", "D_TERM", "its DTerm would be that of "},
        {"lambert_view", "LambertView", "LAMBERT_VIEW", "its LambertView would be that of "},
    };
    char file[32];
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        toy_as(names[k][0], names[k][1], names[k][2], "");
        snprintf(file, sizeof file, "%s.h", names[k][0]);
        refused(file, names[k][3]);
    }
    toy_as("toy1", "Toy1", "TOY1", "");
    toy_as("toy_1", "Toy1", "TOY_1", "");
    assert_complaint("0 0 0 0\n", LIST("eval", "lambert", "--lobe", "toy1.h", "--lobe", "toy_1.h"), 3,
                     "toy_1.h: is not a lobe that can be taken: its Toy1 would be that of the lobe toy1");
}

static void toy_refused(const char *order, const char *part) {
    char edits[400];
    snprintf(edits, sizeof edits, "s/^#include.*/&\\n#include \"shading\\/terms.h\"/; %s", order);
    toy_as("toy2", "Toy2", "TOY2", edits);
    refused("toy2.h", part);
}

static void lobe_parameter_without_sense_is_refused(void **state) {
    (void)state;
    static const char terms[] = "parameter fade has a range or a default that its terms do not have";
    static const char help[] = "parameter fade has a help text with a control character or the end of";
    static const char infinite[] = "parameter fade has a number that is not finite";
    toy_refused("s/P(float, fade, 1.0f, 0.0f, 1.0f, 0.0f, 1.0f/P(FTerm, fade, 900, 0, 1000, 0, 1000/", terms);
    toy_refused("s/P(float, fade, 1.0f, 0.0f, 1.0f, 0.0f, 1.0f/P(FTerm, fade, 0, -1, 1, -1, 1/", terms);
    toy_refused("s/P(float, fade, 1.0f, 0.0f, 1.0f, 0.0f, 1.0f/P(FTerm, fade, 0.5f, 0, 1, 0, 1/", terms);
    toy_refused("s/P(float, fade, 1.0f, 0.0f, 1.0f, 0.0f, 1.0f/P(float, fade, 1, 0, 1, 0, 1e39f/", infinite);
    toy_refused("s/P(float, fade, 1.0f/P(float, fade, 0.0f \\/ 0.0f/", infinite);
    toy_refused("s/how much of the second/how *\\/ much/", help);
    toy_refused("s/how much of the second/how\\\\nmuch/", help);
}

static void lobe_file_with_a_zero_byte_is_refused(void **state) {
    (void)state;
    toy_as("toy2", "Toy2", "TOY2", "");
    Ran ran = run_shell("printf '\\0//' >>toy2.h");
    assert_int_equal(ran.code, 0);
    ran_free(&ran);
    refused("toy2.h", "it has a zero byte");
    toy_as("toy3", "Toy3", "TOY3", "1s/^/\\xef\\xbb\\xbf/");
    ran = RUN("models", "toy3", "--lobe", "toy3.h");
    if (ran.code) fail_msg("a mark is no fault: %s", ran.err);
    ran_free(&ran);
}

static void done(const char *line, int code, const char *part) {
    Ran ran = run_shell(line);
    if (ran.code != code || !strstr(code ? ran.err : ran.out, part))
        fail_msg("%s\nexpected %d and \"%s\", got %d, %s %s", line, code, part, ran.code, ran.out, ran.err);
    ran_free(&ran);
}

#define TOY   WEFT_SOURCE_DIR "/tests/lobes/toy.h"
#define CACHE "export XDG_CACHE_HOME=$PWD/cache; rm -rf cache; "

static void compiler_that_cannot_run_is_an_error(void **state) {
    (void)state;
    done(CACHE "env --ignore-signal=CHLD $0 models toy --lobe " TOY, 0, "toy");
    done(CACHE "CC='cc 1 2 3 4 5 6 7 8' $0 models toy --lobe " TOY, 4, "255 characters or 8 words");
    done(CACHE "CC=$(printf %0300d 1) $0 models toy --lobe " TOY, 4, "255 characters or 8 words");
    done("printf '#!/bin/sh\\necho first; echo no room left; exit 3\\n' >bad; chmod +x bad; " CACHE
         "CC=./bad $0 models toy --lobe " TOY,
         3, "does not compile: the compiler fails: no room left");
    done("printf '#!/bin/sh\\nwhile [ $1 != -o ]; do shift; done; echo text >$2\\n' >bad; " CACHE
         "CC=./bad $0 models toy --lobe " TOY,
         3, "it cannot be loaded: ");
    done("rm -rf bad cache", 0, "");
}

/* In place of the library, one that tells that it was run. */
#define HOSTILE                                                                                                        \
    CACHE "$0 models toy --lobe " TOY " >/dev/null && cp hostile.so cache/weft/*.so && chmod 700 cache/weft/*.so; "
#define RUN_IT "$0 models toy --lobe " TOY "; rm -r cache"

static void cached_library_of_another_user_is_not_run(void **state) {
    (void)state;
    done("echo '#include <stdio.h>\n__attribute__((constructor)) static void run(void) { puts(\"RUN\"); }' "
         ">hostile.c && cc -shared -fPIC hostile.c -o hostile.so && " HOSTILE RUN_IT,
         0, "RUN"); /* nobody else could have put it there */
    static const char *const open[] = {
        HOSTILE "chmod 720 cache/weft/*.so; " RUN_IT, HOSTILE "chmod 702 cache/weft/*.so; " RUN_IT,
        HOSTILE "chmod 720 cache/weft; " RUN_IT, HOSTILE "chmod 1777 cache/weft; " RUN_IT,
        HOSTILE "mv cache/weft there; ln -s ../there cache/weft; " RUN_IT};
    for (size_t k = 0; k < sizeof open / sizeof *open; k++) {
        Ran ran = run_shell(open[k]);
        if (ran.code || !strstr(ran.out, "toy") || strstr(ran.out, "RUN"))
            fail_msg("%s: %d %s %s", open[k], ran.code, ran.out, ran.err);
        ran_free(&ran);
    }
    done("umask 0; " CACHE "$0 models toy --lobe " TOY " && PATH= CC= $0 models toy --lobe " TOY
         " && /bin/rm -r cache there",
         0, "toy"); /* what is made is private */
}

static void interrupted_compilation_leaves_no_files(void **state) {
    (void)state;
    done(CACHE "mkdir -p cache && chmod 700 cache && mkdir -m 700 cache/weft cache/weft/lobe-old "
               "cache/weft/lobe-new && touch cache/weft/lobe-old/lobe.c && "
               "touch -d '2 hours ago' cache/weft/lobe-old && $0 models toy --lobe " TOY
               " && [ ! -e cache/weft/lobe-old ] && [ -e cache/weft/lobe-new ] && rm -r cache",
         0, "toy");
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(lobe_name_that_is_taken_or_malformed_is_refused),
                                       cmocka_unit_test(lobe_parameter_without_sense_is_refused),
                                       cmocka_unit_test(lobe_file_with_a_zero_byte_is_refused),
                                       cmocka_unit_test(compiler_that_cannot_run_is_an_error),
                                       cmocka_unit_test(cached_library_of_another_user_is_not_run),
                                       cmocka_unit_test(interrupted_compilation_leaves_no_files)};
    return cmocka_run_group_tests(tests, work_begin, work_end);
}
