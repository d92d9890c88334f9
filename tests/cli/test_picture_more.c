/* Samples that are added to a picture later, and checkpoints of a process that is killed: the bytes of one run. */
#include "run.h"

#include "weft/image.h"

#define PICTURE "scene.gltf", "--width=100", "--height=75", "--crop=3,5,90,66", "--aov=albedo,depth,samples", "--quiet"

static void done(Ran ran) {
    if (ran.code != 0) fail_msg("exit %d: %s", ran.code, ran.err);
    ran_free(&ran);
}

static void assert_same_files(const char *a, const char *b) {
    size_t size;
    char *bytes = file_bytes(a, &size);
    assert_non_null(bytes);
    if (!same_bytes(b, bytes, size)) fail_msg("%s is not %s", b, a);
    free(bytes);
}

static void whole_make(const char *spp, const char *option) {
    done(RUN("render", PICTURE, "-o", "whole.exr", "-o", "whole.png", spp, option));
}

/* Renders two parts of 32 samples. */
static void parts_make(const char *option) {
    done(RUN("render", PICTURE, "--spp=32", "--chunk=1/2", "-o", "old-1.exr", option));
    done(RUN("render", PICTURE, "--spp=32", "--chunk=2/2", "-o", "old-2.exr", option));
}

/* Two parts of 32 samples become three of 70: the rays are those of the new samples alone, and the old parts may lie
 * among the new ones. */
static void later_samples_are_those_of_one_run(void **state) {
    (void)state;
    static const char *const options[] = {NULL, "--halves", "--floor"};
    static const char *const chunks[] = {"--chunk=1/3", "--chunk=2/3", "--chunk=3/3"};
    static const char *const files[] = {"new-1.exr", "new-2.exr", "new-3.exr"};
    for (size_t k = 0; k < sizeof options / sizeof *options; k++) {
        whole_make("--spp=70", options[k]);
        parts_make(options[k]);
        for (int part = 0; part < 3; part++)
            done(RUN("render", PICTURE, "--spp=70", "--from=old-2.exr", "--from=old-1.exr", chunks[part], "-o",
                     files[part], options[k]));
        done(RUN("merge", "old-1.exr", files[2], files[0], "old-2.exr", files[1], "-o", "merged.exr", "-o",
                 "merged.png"));
        assert_same_files("whole.exr", "merged.exr");
        assert_same_files("whole.png", "merged.png");
        done(
            RUN("render", PICTURE, "--spp=70", "--from=old-2.exr", "--from=old-1.exr", "-o", "joined.exr", options[k]));
        assert_same_files("whole.exr", "joined.exr");
    }
}

static double number_after(const char *text, const char *key) {
    const char *at = strstr(text, key);
    if (!at) fail_msg("no %s in %s", key, text);
    return strtod(at + strlen(key), NULL);
}

static void only_new_samples_are_traced_and_a_part_tells_the_truth(void **state) {
    (void)state;
    parts_make(NULL);
    Ran whole = RUN("render", PICTURE, "--spp=64", "--json", "-o", "whole.exr");
    Ran more = RUN("render", PICTURE, "--spp=64", "--json", "-o", "joined.exr", "--from=old-1.exr", "--from=old-2.exr");
    const double ratio = number_after(more.out, "\"rays\": ") / number_after(whole.out, "\"rays\": ");
    if (!(ratio > 0.45 && ratio < 0.55)) fail_msg("%g of the rays: %s", ratio, more.out);
    ran_free(&whole);
    ran_free(&more);
    Ran part = RUN("render", PICTURE, "--spp=32", "--json", "--chunk=1/2", "-o", "part.exr");
    assert_true(number_after(part.out, "\"samples_per_pixel\": ") == 32.0);
    assert_true(number_after(part.out, "\"pixels\": ") == 90.0 * (16 + 16 + 2));
    assert_null(strstr(part.out, "\"tone\""));
    assert_non_null(strstr(part.out, "\"of\": 2"));
    ran_free(&part);
}

static void parts_that_cannot_grow_are_refused_by_name(void **state) {
    (void)state;
    parts_make(NULL);
    done(RUN("render", PICTURE, "--spp=20", "--chunk=1/1", "-o", "odd.exr"));
    static const struct {
        const char *from, *option;
        int code;
        const char *line;
    } refused[] = {
        {"--from=old-1.exr", "--spp=16", 2, "old-1.exr: has 32 samples a pixel, more than --spp 16"},
        {"--from=odd.exr", "--spp=64", 3,
         "odd.exr: ends at 20 samples a pixel; more can be added after a multiple of 16"},
        {"--from=old-1.exr", "--seed=4", 2, "old-1.exr: --from is of another picture: seed=0, and not seed=4"},
        {"--from=old-1.exr", "--halves", 2, "halves=0, and not halves=1"},
        {"--from=old-1.exr", "--set=cloth.sheen_roughness=0.4", 2, "scene="},
        {"--from=whole.png", "--spp=64", 3, "whole.png: "},
        {"--from=whole.exr", "--spp=64", 3, "whole.exr: is no part of a picture"},
        {"--from=none.exr", "--spp=64", 3, "none.exr: "},
        {"--from=old-1.exr", "--time-limit=3", 2, "--from: not with --time-limit"},
        {"--from=old-1.exr", "--turntable=3", 2, "--from: needs one picture of --engine trace"},
    };
    whole_make("--spp=20", NULL);
    for (size_t k = 0; k < sizeof refused / sizeof *refused; k++)
        assert_complaint(NULL, LIST("render", PICTURE, "-o", "joined.exr", refused[k].from, refused[k].option),
                         refused[k].code, refused[k].line);
    Ran ran = RUN("render", "scene.gltf", "--width=100", "--height=75", "--crop=3,5,90,66",
                  "--aov=albedo,depth,samples", "--spp=64", "--from=old-2.exr", "-o", "joined.exr");
    assert_int_equal(ran.code, 0);
    assert_non_null(strstr(ran.err, "--from: no file has the pixels from row 0 on"));
    ran_free(&ran);
    size_t size;
    char *bytes = file_bytes("old-1.exr", &size);
    for (size_t k = 1; k < 8; k++) { /* truncated */
        file_make("cut.exr", bytes, size * k / 8);
        assert_complaint(NULL, LIST("render", PICTURE, "--spp=64", "--from=cut.exr", "-o", "joined.exr"), 3,
                         "cut.exr: ");
    }
    free(bytes);
}

/* ---- checkpoints */

/* Returns the samples of a picture that takes seconds; under sanitizers (WEFT_TEST_SHORT=1) a quarter of them do. */
static const char *long_spp(void) { return getenv("WEFT_TEST_SHORT") ? "--spp=1600" : "--spp=6400"; }

#define LONG PICTURE, long_spp(), "--checkpoint=point.exr", "--checkpoint-every=0.05"

static bool is_there(const char *path) { return access(path, F_OK) == 0; }

/* Kills a render with a checkpoint again and again, until one ends; returns how many were killed. */
static int kill_and_go_on(const char *const *arguments) {
    int kills = 0;
    for (;; kills++) {
        pid_t child = program_start(WEFT_PROGRAM, NULL, arguments);
        int status = 0;
        for (double start = clock_now(); clock_now() < start + 0.3 + 0.1 * kills;) {
            sleep_seconds(0.01);
            if (waitpid(child, &status, WNOHANG) != 0) {
                assert_true(WIFEXITED(status));
                assert_int_equal(WEXITSTATUS(status), 0);
                return kills;
            }
        }
        kill(child, SIGKILL);
        assert_int_equal(waitpid(child, &status, 0), child);
        assert_true(kills < 400);
    }
}

static void killed_render_goes_on_from_its_checkpoint(void **state) {
    (void)state;
    done(RUN("render", PICTURE, long_spp(), "-o", "whole.exr", "-o", "whole.png"));
    const int kills = kill_and_go_on(LIST("render", LONG, "-o", "killed.exr", "-o", "killed.png", "--threads=1"));
    assert_true(kills > 1);
    assert_same_files("whole.exr", "killed.exr");
    assert_same_files("whole.png", "killed.png");
    assert_false(is_there("point.exr"));
    for (int part = 1; part <= 2; part++)
        kill_and_go_on(LIST("render", LONG, part == 1 ? "--chunk=1/2" : "--chunk=2/2", "-o",
                            part == 1 ? "part-1.exr" : "part-2.exr"));
    done(RUN("merge", "part-1.exr", "part-2.exr", "-o", "killed.exr"));
    assert_same_files("whole.exr", "killed.exr");
    assert_false(is_there("point.exr"));
}

#define ENDLESS PICTURE, "--spp=100000", "--checkpoint=point.exr", "--checkpoint-every=0.05"

/* Ends a render by a signal when it has written its first checkpoint. */
static Ran interrupt(const char *const *arguments) {
    pid_t child = program_start(WEFT_PROGRAM, NULL, arguments);
    await_handler(child);
    for (double start = clock_now(); !is_there("point.exr") && clock_now() - start < 60.0;) sleep_seconds(0.01);
    kill(child, SIGTERM);
    return program_end(child);
}

static void interrupted_render_leaves_its_checkpoint(void **state) {
    (void)state;
    unlink("point.exr");
    Ran ran = interrupt(LIST("render", ENDLESS, "--chunk=1/1", "-o", "part.exr"));
    if (ran.code != 130) fail_msg("exit %d: %s", ran.code, ran.err);
    assert_non_null(strstr(ran.err, "interrupted: point.exr has what there is, from which the same command goes on"));
    ran_free(&ran);
    assert_true(is_there("point.exr"));
    unlink("point.exr");
    ran = interrupt(LIST("render", ENDLESS, "-o", "sofar.exr"));
    assert_int_equal(ran.code, 130);
    ran_free(&ran);
    assert_true(is_there("point.exr") && is_there("sofar.exr"));
}

static void checkpoint_of_another_picture_is_refused_and_kept(void **state) {
    (void)state;
    unlink("point.exr");
    Ran ran = interrupt(LIST("render", ENDLESS, "-o", "sofar.exr"));
    ran_free(&ran);
    size_t size;
    char *bytes = file_bytes("point.exr", &size);
    static const struct {
        const char *option, *line;
    } others[] = {
        {"--spp=64", "point.exr: is a checkpoint of another picture: spp=100000, and not spp=64"},
        {"--seed=1", "spp=100000, and not spp=64"},
        {"--set=cloth.sheen_roughness=0.4", "scene="},
    };
    for (size_t k = 0; k < sizeof others / sizeof *others; k++) {
        assert_complaint(NULL, LIST("render", PICTURE, "--checkpoint=point.exr", "-o", "whole.exr", others[k].option),
                         2, others[k].line);
        assert_true(same_bytes("point.exr", bytes, size));
    }
    for (size_t k = 1; k < 8; k++) { /* truncated: named, and not overwritten */
        file_make("cut.exr", bytes, size * k / 8);
        ran = RUN("render", PICTURE, "--spp=100000", "--checkpoint=cut.exr", "-o", "whole.exr");
        assert_int_equal(ran.code, 3);
        assert_true(one_complaint(ran.err) && strstr(ran.err, "cut.exr: "));
        ran_free(&ran);
        assert_true(same_bytes("cut.exr", bytes, size * k / 8));
    }
    free(bytes);
    whole_make("--spp=4", NULL);
    assert_complaint(NULL, LIST("render", PICTURE, "--checkpoint=whole.exr", "-o", "other.exr"), 2,
                     "whole.exr: is there and is no checkpoint");
    assert_complaint(NULL, LIST("render", PICTURE, "--checkpoint=other.exr", "-o", "other.exr"), 2,
                     "other.exr: is both -o and --checkpoint");
    assert_complaint(NULL, LIST("render", PICTURE, "--checkpoint=a.png", "-o", "other.exr"), 2, "must be an .exr");
    assert_complaint(NULL, LIST("render", PICTURE, "--checkpoint-every=5", "-o", "other.exr"), 2, "needs --checkpoint");
    assert_complaint(NULL, LIST("render", PICTURE, "--checkpoint=p.exr", "--time-limit=5", "-o", "other.exr"), 2,
                     "--checkpoint: not with --time-limit");
}

/* The file of a lobe is part of what its pictures depend on. */
static void parts_of_another_lobe_are_refused(void **state) {
    (void)state;
    done(run_shell("sed 's/toy/mine/g; s/TOY/MINE/g; s/Toy/Mine/g' " WEFT_SOURCE_DIR "/tests/lobes/toy.h >mine.h"));
    done(RUN("render", PICTURE, "--spp=4", "--chunk=1/2", "--lobe=mine.h", "-o", "part-1.exr"));
    done(run_shell("echo '/* other */' >>mine.h"));
    done(RUN("render", PICTURE, "--spp=4", "--chunk=2/2", "--lobe=mine.h", "-o", "part-2.exr"));
    assert_complaint(NULL, LIST("merge", "part-1.exr", "part-2.exr", "-o", "merged.exr"), 2,
                     "part-2.exr: is of another picture than part-1.exr: scene=");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(later_samples_are_those_of_one_run),
        cmocka_unit_test(only_new_samples_are_traced_and_a_part_tells_the_truth),
        cmocka_unit_test(parts_that_cannot_grow_are_refused_by_name),
        cmocka_unit_test(killed_render_goes_on_from_its_checkpoint),
        cmocka_unit_test(interrupted_render_leaves_its_checkpoint),
        cmocka_unit_test(checkpoint_of_another_picture_is_refused_and_kept),
        cmocka_unit_test(parts_of_another_lobe_are_refused),
    };
    return cmocka_run_group_tests(tests, scene_begin, work_end);
}
