/* Memory that runs out, at one allocation after another: exit 4 and one line, or as if nothing had been; no
 * signal. starve/starve.cpp makes it run out; with WEFT_TEST_LONG=1 every command is tried for longer. */
#include "run.h"

#include <sys/stat.h>

enum { TRIED = 60, TRIED_LONG = 2000, COMMANDS = 7 };

static const char *const commands[COMMANDS][12] = {
    {"render", "../scene.gltf", "--width=8", "--height=8", "--spp=1", "--quiet", "-o", "a.png"},
    {"doctor", "../scene.gltf"},
    {"export", "lambert", "--target", "c", "--quiet", "-o", "a.h"},
    {"check", "lambert", "--quick", "--no-gpu"},
    {"match", "../scene.gltf", "--from", "khronos", "--to", "three", "-o", "m.gltf"},
    {"weave", "twill 2/2; both 4k 4w", "-o", "w.wif"},
    {"weave", "w.wif", "--json"},
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

/* All commands in a folder of its own; returns how many ended otherwise than they may. */
static int try_all(bool on) {
    const int most = getenv("WEFT_TEST_LONG") ? TRIED_LONG : TRIED;
    int wrong = 0;
    for (int c = 0; c < COMMANDS; c++) {
        Ran whole = run_with(NULL, commands[c]);
        bool harmed = true;
        for (int at = 1; at <= most && harmed; at++) {
            Ran ran = run_starved(commands[c], at, on);
            bool good = (ran.code == whole.code && strcmp(ran.out, whole.out) == 0) ||
                        (ran.code == 4 && one_complaint(ran.err));
            if (!good)
                fprintf(stderr, "%s, %d%s: exit %d, %s\n", commands[c][0], at, on ? " on" : "", ran.code,
                        ran.err);
            wrong += !good;
            /* a program that takes no harm from then on has asked for less */
            if (on) harmed = ran.code == 4 || !good || at < 8;
            ran_free(&ran);
        }
        ran_free(&whole);
    }
    return wrong;
}

static void any_allocation_may_fail(void **state) {
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
    const struct CMUnitTest tests[] = {cmocka_unit_test(any_allocation_may_fail)};
    return cmocka_run_group_tests(tests, scene_begin, work_end);
}
