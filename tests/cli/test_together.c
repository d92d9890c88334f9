/* One picture by all processes that mpirun starts: the bytes of one run, also after one of them was killed. Open MPI
 * itself leaves memory behind, which the sanitizer would report.
 *
 * Labels: unsanitized */
#include "run.h"

#ifndef WEFT_MPI
#define WEFT_MPI ""
#endif
#ifndef WEFT_MPIRUN
#define WEFT_MPIRUN ""
#endif

#define PICTURE  "scene.gltf", "--width=100", "--height=75", "--aov=albedo,object,samples", "--quiet", "--threads=1"
#define TOGETHER "--allow-run-as-root", "--oversubscribe", "--mca", "btl", "self,vader"

/* Leaves the test where there is no MPI. */
static void need_mpi(void) {
    if (access(WEFT_MPI, X_OK) == 0 && access(WEFT_MPIRUN, X_OK) == 0) return;
    print_message("no MPI (libopenmpi-dev, openmpi-bin): skipped\n");
    skip();
}

static pid_t start(const char *const *arguments) { return program_start(WEFT_MPIRUN, NULL, arguments); }

static void done(Ran ran) {
    if (ran.code != 0) fail_msg("exit %d: %s", ran.code, ran.err);
    ran_free(&ran);
}

static void assert_same_files(const char *a, const char *b, const char *processes) {
    size_t size;
    char *bytes = file_bytes(a, &size);
    assert_non_null(bytes);
    if (!same_bytes(b, bytes, size)) fail_msg("%s processes: %s is not %s", processes, b, a);
    free(bytes);
}

static void picture_of_several_processes_has_the_bytes_of_one(void **state) {
    (void)state;
    static const char *const counts[] = {"1", "2", "4"};
    need_mpi();
    done(RUN("render", PICTURE, "--spp=70", "--halves", "-o", "whole.exr", "-o", "whole.png"));
    done(RUN("render", PICTURE, "--spp=70", "-o", "plain.exr"));
    for (size_t k = 0; k < sizeof counts / sizeof *counts; k++) {
        done(program_end(start(LIST(TOGETHER, "-n", counts[k], WEFT_MPI, "render", PICTURE, "--spp=70", "--halves",
                                    "-o", "joined.exr", "-o", "joined.png"))));
        assert_same_files("whole.exr", "joined.exr", counts[k]);
        assert_same_files("whole.png", "joined.png", counts[k]);
        done(program_end(
            start(LIST(TOGETHER, "-n", counts[k], WEFT_MPI, "render", PICTURE, "--spp=70", "-o", "joined.exr"))));
        assert_same_files("plain.exr", "joined.exr", counts[k]);
    }
}

/* TileSums of earlier samples go to the processes that add to them. */
static void samples_are_added_together(void **state) {
    (void)state;
    need_mpi();
    static const char *const picture[] = {"render",      "scene.gltf",   "--width=100",
                                          "--height=75", "--aov=albedo", "--quiet"};
#define SAME picture[0], picture[1], picture[2], picture[3], picture[4], picture[5]
    done(RUN(SAME, "--spp=70", "-o", "whole.exr"));
    done(RUN(SAME, "--spp=32", "--chunk=1/2", "-o", "part.exr"));
    Ran ran = program_end(
        start(LIST(TOGETHER, "-n", "2", WEFT_MPI, SAME, "--spp=70", "--from=part.exr", "-o", "joined.exr")));
    done(ran);
    assert_same_files("whole.exr", "joined.exr", "2");
}

/* Returns a process that `parent` started, the last; 0: none yet. */
static pid_t last_child(pid_t parent) {
    char path[64], text[256] = "";
    snprintf(path, sizeof path, "/proc/%d/task/%d/children", (int)parent, (int)parent);
    FILE *stream = fopen(path, "r");
    if (!stream) return 0;
    const size_t size = fread(text, 1, sizeof text - 1, stream);
    fclose(stream);
    text[size] = '\0';
    long last = 0, count = 0;
    for (char *at = text, *end; (end = NULL, strtol(at, &end, 10)) > 0 && end != at; at = end, count++)
        last = strtol(at, NULL, 10);
    return count > 1 ? (pid_t)last : 0;
}

#define LONG PICTURE, "--spp=6400", "--checkpoint=point.exr", "--checkpoint-every=0.2", "-o", "joined.exr"

static void killed_process_ends_the_run_and_the_checkpoint_serves(void **state) {
    (void)state;
    need_mpi();
    done(RUN("render", PICTURE, "--spp=6400", "-o", "whole.exr"));
    pid_t run = start(LIST(TOGETHER, "-n", "2", WEFT_MPI, "render", LONG));
    for (double begin = clock_now(); access("point.exr", F_OK) != 0 && clock_now() < begin + 60.0;) sleep_seconds(0.01);
    pid_t rank = last_child(run);
    assert_true(rank > 0);
    kill(rank, SIGKILL);
    Ran ran = program_end(run);
    assert_int_not_equal(ran.code, 0);
    if (!strstr(ran.err, "exited on signal 9")) fail_msg("%s", ran.err);
    ran_free(&ran);
    assert_int_equal(access("point.exr", F_OK), 0);
    done(program_end(start(LIST(TOGETHER, "-n", "2", WEFT_MPI, "render", LONG))));
    assert_same_files("whole.exr", "joined.exr", "2");
    assert_int_not_equal(access("point.exr", F_OK), 0);
}

/* Runs `first` as rank 0 and `other` as ranks 1 and 2. */
static void assert_refused(const char *first, const char *other, int code, const char *line) {
    Ran ran = program_end(
        start(LIST(TOGETHER, "-n", "1", WEFT_MPI, "render", "scene.gltf", "--spp=2", "-o", "joined.exr", first, ":",
                   "-n", "2", WEFT_MPI, "render", "scene.gltf", "--spp=2", "-o", "joined.exr", other)));
    if (ran.code != code || !strstr(ran.err, line)) fail_msg("exit %d: %s", ran.code, ran.err);
    const char *once = strstr(ran.err, line);
    assert_null(strstr(once + 1, line)); /* by one process alone */
    ran_free(&ran);
}

static void processes_that_differ_are_refused_in_one_line(void **state) {
    (void)state;
    need_mpi();
    assert_refused("--seed=1", "--seed=2", 2, "has another picture than rank 0: seed=2, and not seed=1");
    assert_refused("--seed=1", "--material=cloth=none.json", 3, "none.json: cannot be opened");
    assert_refused("--seed=x", "--seed=x", 2, "weft: --seed: \"x\"");
    assert_refused("--chunk=1/2", "--chunk=1/2", 2, "weft-mpi: needs -o OUT, and has neither --chunk nor --noise");
    assert_refused("--turntable=3", "--turntable=3", 2, "weft-mpi: needs one picture of --engine trace");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(picture_of_several_processes_has_the_bytes_of_one),
        cmocka_unit_test(samples_are_added_together),
        cmocka_unit_test(killed_process_ends_the_run_and_the_checkpoint_serves),
        cmocka_unit_test(processes_that_differ_are_refused_in_one_line),
    };
    return cmocka_run_group_tests(tests, scene_begin, work_end);
}
