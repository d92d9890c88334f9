/* A render killed at any moment leaves the old picture or a complete new one. */
#include "run.h"

static const char *const outputs[] = {"a.png", "a.exr", "a.hdr"};
enum { OUTPUTS = 3, KILLS = 12 };

typedef struct Bytes {
    char *bytes;
    size_t size;
} Bytes;

/* Large and with few samples, so that much of the time goes into writing. */
static pid_t start(const char *seed) {
    return program_start(WEFT_PROGRAM, NULL,
                         LIST("render", "scene.gltf", "--width=512", "--height=384", "--spp=1", "--max-depth=1",
                              "--seed", seed, "-o", outputs[0], "-o", outputs[1], "-o", outputs[2]));
}

/* Renders to the end and keeps what came out; returns the seconds it took. */
static double keep(const char *seed, Bytes kept[OUTPUTS]) {
    double started = clock_now();
    Ran ran = program_end(start(seed));
    double seconds = clock_now() - started;
    if (ran.code != 0) fail_msg("exit %d: %s", ran.code, ran.err);
    ran_free(&ran);
    for (int k = 0; k < OUTPUTS; k++) {
        kept[k].bytes = file_bytes(outputs[k], &kept[k].size);
        assert_non_null(kept[k].bytes);
    }
    return seconds;
}

static void killed_render_leaves_old_or_new_files_complete(void **state) {
    (void)state;
    Bytes old[OUTPUTS], fresh[OUTPUTS];
    keep("1", old);
    double seconds = keep("2", fresh);
    int killed = 0;
    for (int round = 0; round < KILLS; round++) {
        for (int k = 0; k < OUTPUTS; k++) file_make(outputs[k], old[k].bytes, old[k].size);
        pid_t child = start("2");
        sleep_seconds(seconds * (0.2 + 0.8 * round / (KILLS - 1)));
        kill(child, SIGKILL);
        Ran ran = program_end(child);
        killed += ran.code == 128 + SIGKILL;
        ran_free(&ran);
        for (int k = 0; k < OUTPUTS; k++)
            if (!same_bytes(outputs[k], old[k].bytes, old[k].size) &&
                !same_bytes(outputs[k], fresh[k].bytes, fresh[k].size))
                fail_msg("round %d: %s is neither the old nor the new picture", round, outputs[k]);
    }
    assert_true(killed > KILLS / 3);
    for (int k = 0; k < OUTPUTS; k++) free(old[k].bytes), free(fresh[k].bytes);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(killed_render_leaves_old_or_new_files_complete)};
    return cmocka_run_group_tests(tests, scene_begin, work_end);
}
