/* Memory that runs out, at one allocation after another: exit 4 and one line that says so, or as if nothing
 * had been; no signal. starve/starve.cpp makes it run out; with WEFT_TEST_LONG=1 every allocation fails once.
 *
 * Labels: slow */
#include "run.h"

#include <limits.h>
#include <sys/stat.h>

enum { COMMANDS = 8 };

/* What is tried, at each step-th allocation: those that take long for more than reading are tried less often.
 */
static const struct {
    int step;
    const char *words[12];
} commands[COMMANDS] = {
    {1, {"render", "../scene.gltf", "--width=8", "--height=8", "--spp=1", "--quiet", "-o", "a.png"}},
    {13, {"doctor", "../scene.gltf"}},
    {7, {"export", "lambert", "--target", "c", "--quiet", "-o", "a.h"}},
    {1, {"check", "lambert", "--quick", "--no-gpu"}},
    {97, {"match", "../scene.gltf", "--from", "khronos", "--to", "three", "-o", "m.gltf"}},
    {1, {"weave", "twill 2/2; both 4k 4w", "-o", "w.wif"}},
    {1, {"weave", "w.wif", "--json"}},
    {1, {"diff", "a.png", "a.png"}}, /* as the first of these has written it */
};

static Ran run_starved(const char *const *command, int at, bool on) {
    char number[16];
    snprintf(number, sizeof number, "%d", at);
    setenv("WEFT_STARVE_AT", number, 1);
    setenv("WEFT_STARVE_ON", on ? "1" : "0", 1);
    setenv("LD_PRELOAD", WEFT_STARVE, 1);
    Ran ran = run_with(NULL, command);
    unsetenv("LD_PRELOAD");
    return ran;
}

/* Returns how many allocations a command asks for that has all it wants. */
static int count_allocations(const char *const *command) {
    setenv("WEFT_STARVE_COUNT", "count", 1);
    Ran ran = run_starved(command, INT_MAX, false);
    unsetenv("WEFT_STARVE_COUNT");
    ran_free(&ran);
    size_t size;
    char *text = file_bytes("count", &size);
    int count = text ? atoi(text) : 0;
    free(text);
    return count;
}

static bool tells_of_memory(const char *text) {
    return one_complaint(text) && (strstr(text, "ut of memory") || strstr(text, "insufficient memory") ||
                                   strstr(text, "Cannot allocate memory")); /* as the system has it */
}

/* All commands in a folder of its own; returns how many ended otherwise than they may. */
static int try_all(bool on) {
    const bool each = getenv("WEFT_TEST_LONG") != NULL;
    int wrong = 0;
    for (int c = 0; c < COMMANDS; c++) {
        const char *const *words = commands[c].words;
        Ran whole = run_with(NULL, words);
        const int count = count_allocations(words);
        fprintf(stderr, "%s%s: %d allocations\n", words[0], on ? " on" : "", count);
        wrong += count < 10; /* then they were not counted */
        for (int at = 1; at <= count; at += each ? 1 : commands[c].step) {
            Ran ran = run_starved(words, at, on);
            bool good = (ran.code == whole.code && strcmp(ran.out, whole.out) == 0) ||
                        (ran.code == 4 && tells_of_memory(ran.err));
            if (!good) fprintf(stderr, "%s, %d%s: exit %d, %s\n", words[0], at, on ? " on" : "", ran.code, ran.err);
            wrong += !good;
            ran_free(&ran);
        }
        ran_free(&whole);
    }
    return wrong;
}

static void command_without_memory_ends_with_one_line(void **state) {
    (void)state;
    pid_t children[2];
    for (int on = 0; on < 2; on++) {
        children[on] = fork();
        if (children[on] == 0) {
            const char *folder = on ? "on" : "once";
            _exit(mkdir(folder, 0700) == 0 && chdir(folder) == 0 && try_all(on) == 0 ? 0 : 1);
        }
    }
    for (int on = 0; on < 2; on++) {
        int status;
        assert_int_equal(waitpid(children[on], &status, 0), children[on]);
        assert_true(WIFEXITED(status));
        assert_int_equal(WEXITSTATUS(status), 0);
    }
    Ran ran = run_shell("rm -r on once");
    ran_free(&ran);
}

int main(void) {
    if (!*WEFT_STARVE) {
        print_message("sanitizers have an allocator of their own\n");
        return 0;
    }
    const struct CMUnitTest tests[] = {cmocka_unit_test(command_without_memory_ends_with_one_line)};
    return cmocka_run_group_tests(tests, scene_begin, work_end);
}
