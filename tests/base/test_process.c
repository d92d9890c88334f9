/* Other programs end within their bounds, with what they started, and with the program that runs them */
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <cmocka.h>

#include "base/process.h"
#include "base/steady_clock.h"
#include "scratch.h"

static char folder[SCRATCH_SIZE];
static const ProcessBounds wide = {.seconds = 60, .cpu_seconds = 60, .mebibytes = 4096};

static int sh(const char *line, ProcessBounds bounds) {
    return process_run((const char *const[]){"sh", "-c", line, NULL}, bounds, folder, "log");
}

static void assert_file(const char *path, const char *text) {
    char bytes[256] = "";
    FILE *stream = fopen(path, "r");
    assert_non_null(stream);
    assert_true(fread(bytes, 1, sizeof bytes - 1, stream) > 0);
    fclose(stream);
    assert_string_equal(bytes, text);
}

static void rest(double seconds) { nanosleep(&(struct timespec){.tv_nsec = (long)(1e9 * seconds)}, NULL); }

static void exit_codes_and_output_come_back(void **state) {
    (void)state;
    assert_int_equal(sh("exit 7", wide), 7);
    assert_int_equal(sh("kill -9 $$", wide), 128 + SIGKILL);
    assert_int_equal(process_run((const char *const[]){"no-such-program", NULL}, wide, folder, "log"), PROCESS_MISSING);
    assert_int_equal(sh("echo $LC_ALL $TMPDIR; echo bad >&2; ! read x", wide), 0);
    char text[128];
    snprintf(text, sizeof text, "C %s\nbad\n", folder);
    assert_file("log", text);
}

/* Returns true if the process whose number is in the file "number" still runs. */
static int is_running(void) {
    FILE *stream = fopen("number", "r");
    int number = 0;
    assert_non_null(stream);
    assert_int_equal(fscanf(stream, "%d", &number), 1);
    fclose(stream);
    for (int k = 0; k < 100; k++) { /* what was killed may be a moment without anybody who waits for it */
        char path[64], words[256] = "";
        snprintf(path, sizeof path, "/proc/%d/stat", number);
        FILE *status = fopen(path, "r");
        if (!status) return 0;
        size_t size = fread(words, 1, sizeof words - 1, status);
        fclose(status);
        if (!size || strstr(words, ") Z ") || strstr(words, ") X ")) return 0;
        rest(0.02);
    }
    return 1;
}

static void a_program_beyond_its_bounds_is_ended(void **state) {
    (void)state;
    const double start = clock_now();
    ProcessBounds narrow = wide;
    narrow.seconds = 1;
    assert_int_equal(sh("sleep 600 & echo $! >number; wait", narrow), PROCESS_LATE);
    assert_false(is_running());
    narrow = wide;
    narrow.cpu_seconds = 1;
    assert_int_equal(sh("sh -c 'while :; do :; done'", narrow), PROCESS_LATE);
    narrow = wide;
    narrow.mebibytes = 64;
    assert_true(sh("head -c 200M /dev/zero | tail -n 1 >/dev/null", narrow) != 0); /* tail keeps the line */
    assert_int_equal(sh("head -c 200M /dev/zero | tail -n 1 >/dev/null", wide), 0);
    assert_true(clock_now() - start < 60.0);
}

static void program_left_behind_is_ended(void **state) {
    (void)state;
    assert_int_equal(sh("sleep 600 & echo $! >number", wide), 0);
    assert_false(is_running());
}

/* Returns how a program ends that a signal reaches while it runs another. */
static int ended_by(int number) {
    unlink("number");
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        int code = sh("sleep 600 & echo $! >number; wait", wide);
        if (code == PROCESS_STOPPED) process_signal_pass();
        _exit(code == PROCESS_STOPPED ? 2 : 3);
    }
    for (int k = 0; k < 500 && access("number", R_OK) != 0; k++) rest(0.02);
    rest(0.1);
    kill(child, number);
    int status = 0;
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_false(is_running());
    return WIFSIGNALED(status) ? WTERMSIG(status) : -WEXITSTATUS(status);
}

static void a_signal_ends_both_programs(void **state) {
    (void)state;
    assert_int_equal(ended_by(SIGTERM), SIGTERM);
    assert_int_equal(ended_by(SIGINT), SIGINT);
    assert_int_equal(ended_by(SIGHUP), SIGHUP);
}

static int begin(void **state) {
    (void)state;
    return scratch_enter(folder) ? 0 : -1;
}

static int end(void **state) {
    (void)state;
    return chdir("/") == 0 && scratch_remove(folder) ? 0 : -1;
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(exit_codes_and_output_come_back), cmocka_unit_test(a_program_beyond_its_bounds_is_ended),
        cmocka_unit_test(program_left_behind_is_ended), cmocka_unit_test(a_signal_ends_both_programs)};
    return cmocka_run_group_tests(tests, begin, end);
}
