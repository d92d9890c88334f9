/* The progress line, seen through a pseudo-terminal.
 *
 * Labels: unsanitized */
#define _XOPEN_SOURCE 700 /* posix_openpt */

#include "run.h"

#include <sys/ioctl.h>

/* Runs with standard error on a terminal of that many columns; returns all that came out of it. */
static char *on_terminal(unsigned short columns, const char *const *arguments, int *code) {
    int terminal = posix_openpt(O_RDWR | O_NOCTTY);
    if (terminal < 0 || grantpt(terminal) != 0 || unlockpt(terminal) != 0) {
        print_message("no pseudo-terminals on this system\n");
        skip();
    }
    int line = open(ptsname(terminal), O_RDWR | O_NOCTTY);
    struct winsize size = {.ws_row = 24, .ws_col = columns};
    assert_true(line >= 0 && ioctl(line, TIOCSWINSZ, &size) == 0);
    char *vector[32] = {(char *)(uintptr_t)WEFT_PROGRAM};
    for (int k = 0; arguments[k]; k++) vector[k + 1] = (char *)(uintptr_t)arguments[k];
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_adddup2(&files, line, 2);
    pid_t child;
    assert_int_equal(posix_spawn(&child, WEFT_PROGRAM, &files, NULL, vector, environ), 0);
    posix_spawn_file_actions_destroy(&files);
    close(line);

    size_t used = 0, room = 1 << 20;
    char *text = calloc(room + 1, 1);
    assert_non_null(text);
    for (ssize_t got; used < room && (got = read(terminal, text + used, room - used)) > 0;) used += (size_t)got;
    close(terminal);
    int status;
    waitpid(child, &status, 0);
    *code = WEXITSTATUS(status);
    return text;
}

static void progress_line_is_drawn_and_erased(void **state) {
    (void)state;
    const double limit = 1.5;
    int code, drawn = 0;
    char *text = on_terminal(60, LIST("render", "scene.gltf", "-o", "a.png", "--time-limit=1.5"), &code);
    assert_int_equal(code, 0);
    char *at = text;
    for (char *next; (next = strstr(at, "\r\033[K")); drawn++) {
        size_t shown = strcspn(next + 4, "\r\n");
        bool last = !strstr(next + 4, "\r\033[K"); /* erased, and the summary in its place */
        if (last)
            assert_memory_equal(next + 4, "weft: ", 6);
        else
            assert_true(shown < 60);
        if (!last) assert_true(strstr(next, " spp ") && strstr(next, " elapsed, ") && strchr(next, '%'));
        at = next + 4;
    }
    assert_true(drawn >= 5);
    assert_true(drawn <= (int)(10.0 * limit) + 15); /* ten a second, and some for a late end */
    free(text);
}

/* Other long work counts other things, in the same line. */
static void progress_of_bake_counts_texels(void **state) {
    (void)state;
    int code;
    char *text = on_terminal(100, LIST("bake", "albedo", "ggx", "--size=128x128", "-o", "a.npy"), &code);
    assert_int_equal(code, 0);
    assert_non_null(strstr(text, "/16384 texels  0:0"));
    assert_true(strstr(text, " elapsed, ") && strstr(text, " left  ") && strstr(text, " texels/s"));
    assert_null(strstr(text, " spp "));
    free(text);
}

/* Of work whose amount only the file says. */
static void progress_of_unknown_length_is_drawn_in_per_cent(void **state) {
    (void)state;
    int code;
    char *text =
        on_terminal(100, LIST("match", "scene.gltf", "--from", "khronos", "--to", "three", "-o", "a.gltf"), &code);
    assert_int_equal(code, 0);
    assert_non_null(strstr(text, " of the searches  0:0"));
    free(text);
    text = on_terminal(100, LIST("doctor", "scene.gltf", "--no-notes"), &code);
    assert_non_null(strstr(text, " of the materials and meshes  0:0"));
    assert_string_equal(strrchr(text, '\r'), "\r\033[K");
    free(text);
}

static void quiet_option_draws_no_progress(void **state) {
    (void)state;
    int code;
    char *text = on_terminal(80, LIST("render", "scene.gltf", "-o", "a.png", "--time-limit=0.5", "--quiet"), &code);
    assert_int_equal(code, 0);
    assert_string_equal(text, "");
    free(text);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(progress_line_is_drawn_and_erased),
                                       cmocka_unit_test(progress_of_bake_counts_texels),
                                       cmocka_unit_test(progress_of_unknown_length_is_drawn_in_per_cent),
                                       cmocka_unit_test(quiet_option_draws_no_progress)};
    return cmocka_run_group_tests(tests, scene_begin, work_end);
}
