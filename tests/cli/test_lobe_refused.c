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
    toy_refused("s/\"how much of the second[^\"]*\"/NULL/", "parameter fade has no help text");
    toy_refused("s/\"how much of the second[^\"]*\"/\"\"/", "parameter fade has no help text");
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

/* A compiler whose libraries tell that they are run, and one whose do not; of one name, so of one place in the cache. */
#define COMPILERS                                                                                                      \
    "printf '%s\\n' '#include <stdio.h>' '__attribute__((constructor)) static void run(void) { puts(\"RUN\"); }' "     \
    ">run.h; "                                                                                                         \
    "printf '%s\\n' '#!/bin/sh' 'exec cc $RUN \"$@\"' >bad; chmod +x bad; export CC=./bad; " CACHE
#define TELLING "RUN=\"-include $PWD/run.h\" $0 models toy --lobe " TOY " >/dev/null; "
#define RUN_IT  "$0 models toy --lobe " TOY "; rm -r cache bad run.h"

static void cached_library_of_another_user_is_not_run(void **state) {
    (void)state;
    done(COMPILERS TELLING RUN_IT, 0, "RUN"); /* nobody else could have put it there */
    static const char *const open[] = {
        COMPILERS TELLING "chmod 720 cache/weft/*.so; " RUN_IT, COMPILERS TELLING "chmod 702 cache/weft/*.so; " RUN_IT,
        COMPILERS TELLING "chmod 720 cache/weft; " RUN_IT, COMPILERS TELLING "chmod 1777 cache/weft; " RUN_IT,
        COMPILERS TELLING "mv cache/weft there; ln -s ../there cache/weft; " RUN_IT};
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

/* Damaged in each way, it is made anew, once; a library that weft has not made is not run. */
static void damaged_library_in_the_cache_is_made_anew(void **state) {
    (void)state;
    static const char *const damages[] = {"truncate -s 9000 $F",
                                          "truncate -s 0 $F",
                                          "echo >>$F",
                                          "rm $F; mkfifo $F",
                                          "rm $F; ln -s /dev/zero $F",
                                          "dd if=/dev/zero of=$F bs=4096 seek=1 count=1 conv=notrunc 2>/dev/null",
                                          "cp /bin/true $F; chmod 700 $F"};
    char line[1000];
    done(CACHE "echo 60 0 30 40 >asked; $0 eval toy asked --lobe " TOY " >good && echo well", 0, "well");
    for (size_t k = 0; k < sizeof damages / sizeof *damages; k++) {
        snprintf(line, sizeof line,
                 "export XDG_CACHE_HOME=$PWD/cache; F=$(ls cache/weft/*.so) && { %s; } && "
                 "timeout 60 $0 eval toy asked --lobe " TOY
                 " >now 2>told && cmp good now && [ -f $F ] && [ ! -L $F ] && "
                 "PATH=/nowhere $0 eval toy asked --lobe " TOY " >now 2>told && "
                 "cmp good now && [ ! -s told ] && echo well",
                 damages[k]);
        done(line, 0, "well");
    }
    done("rm -r cache asked good now told", 0, "");
}

/* A library that cannot be kept, since a folder is in its place, is used all the same. */
static void library_that_the_cache_cannot_take_is_used(void **state) {
    (void)state;
    done(CACHE "echo 60 0 30 40 >asked; $0 eval toy asked --lobe " TOY " >good && F=$(ls cache/weft/*.so) && rm $F && "
               "mkdir $F && $0 eval toy asked --lobe " TOY " >now 2>told; cmp good now && "
               "grep -q 'is not used as a cache: it cannot be written: ' told && echo well; e=$?; "
               "rm -rf cache asked good now told; exit $e",
         0, "well");
}

static void killed_compilation_is_swept_away(void **state) {
    (void)state;
    done(CACHE "mkdir -p cache tmp/weft-lobe-old tmp/weft-lobe-new tmp/other && touch tmp/weft-lobe-old/lobe.c && "
               "touch -d '2 hours ago' tmp/weft-lobe-old tmp/other && TMPDIR=$PWD/tmp $0 models toy --lobe " TOY
               " && [ \"$(echo $(ls tmp))\" = 'other weft-lobe-new' ]; e=$?; rm -r cache tmp; exit $e",
         0, "toy");
}

/* The compiler sleeps in a child of its own; weft leaves neither, and no files. */
static void signal_ends_the_compiler_too(void **state) {
    (void)state;
    static const char *const verbs[] = {"render builtin:spheres -o a.png", "eval toy", "models toy"};
    char line[700];
    for (size_t k = 0; k < sizeof verbs / sizeof *verbs; k++) {
        snprintf(line, sizeof line,
                 CACHE "printf '#!/bin/sh\\nsleep 600 & echo $! >number; wait\\n' >bad; chmod +x bad; mkdir tmp; "
                       "TMPDIR=$PWD/tmp CC=$PWD/bad $0 %s --lobe " TOY " & P=$!; "
                       "while [ ! -s number ]; do sleep 0.05; done; kill -TERM $P; wait $P; e=$?; sleep 0.2; "
                       "case \"$(cat /proc/$(cat number)/stat 2>/dev/null)\" in *') Z '*|'') ;; *) echo still;; esac; "
                       "ls tmp; rm -rf bad tmp number cache; exit $e",
                 verbs[k]);
        Ran ran = run_shell(line);
        if (ran.code != 130 || ran.out[0] || !one_complaint(ran.err) || !strstr(ran.err, "interrupted"))
            fail_msg("%s: %d \"%s\" \"%s\"", verbs[k], ran.code, ran.out, ran.err);
        ran_free(&ran);
    }
}

static void symbol_that_is_missing_is_named(void **state) {
    (void)state;
    static const char order[] =
        "s/^FN LobeValue/float nowhere(float x);\\n&/; s/float i = pow/float i = nowhere(1.0f) * pow/";
    static const char *const compilers[] = {"cc", "cc -Wl,-z,defs"};
    toy_as("toy2", "Toy2", "TOY2", order);
    for (int k = 0; k < 2; k++) {
        setenv("CC", compilers[k], 1);
        refused("toy2.h", "nowhere");
    }
    unsetenv("CC");
}

/* Nothing in weft reads the whole text again for each of its lines: 900,000 empty ones take no 2 s of a processor,
 * though the reader of the dialect and the compiler pass over them too. */
static void lobe_file_of_many_lines_is_read_once(void **state) {
    (void)state;
    toy_as("toy2", "Toy2", "TOY2", "");
    done(CACHE "yes '' | head -n 900000 >>toy2.h; $0 models toy2 --lobe toy2.h && ulimit -t 2 && "
               "$0 models toy2 --lobe toy2.h; e=$?; rm -r cache; exit $e",
         0, "toy2");
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(lobe_name_that_is_taken_or_malformed_is_refused),
                                       cmocka_unit_test(lobe_parameter_without_sense_is_refused),
                                       cmocka_unit_test(lobe_file_with_a_zero_byte_is_refused),
                                       cmocka_unit_test(compiler_that_cannot_run_is_an_error),
                                       cmocka_unit_test(cached_library_of_another_user_is_not_run),
                                       cmocka_unit_test(damaged_library_in_the_cache_is_made_anew),
                                       cmocka_unit_test(library_that_the_cache_cannot_take_is_used),
                                       cmocka_unit_test(killed_compilation_is_swept_away),
                                       cmocka_unit_test(signal_ends_the_compiler_too),
                                       cmocka_unit_test(symbol_that_is_missing_is_named),
                                       cmocka_unit_test(lobe_file_of_many_lines_is_read_once)};
    return cmocka_run_group_tests(tests, work_begin, work_end);
}
