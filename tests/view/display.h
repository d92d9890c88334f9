/* display.h - a display of its own, without a person: windows are real there, and so are the events of a hand
 *
 * Between display_begin and display_end; what needs it skips where no_display says that it cannot be had. */
#ifndef WEFT_TESTS_VIEW_DISPLAY_H
#define WEFT_TESTS_VIEW_DISPLAY_H

#include "drive.h"

static pid_t server;
static char display[32];
static bool no_display;

static inline bool has_program(const char *program) {
    char line[96];
    snprintf(line, sizeof line, "command -v %s >/dev/null 2>&1", program);
    return system(line) == 0;
}

/* An X server on a display that is free. */
static inline void start_server(void) {
    int ends[2];
    char number[16] = "";
    assert_int_equal(pipe(ends), 0);
    char word[16];
    snprintf(word, sizeof word, "%d", ends[1]);
    char *const vector[] = {"Xvfb",        "-displayfd", word,  "-screen",  "0",
                            "1000x700x24", "-nolisten",  "tcp", "-noreset", NULL};
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addopen(&files, 2, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addclose(&files, ends[0]);
    assert_int_equal(posix_spawnp(&server, "Xvfb", &files, NULL, vector, environ), 0);
    posix_spawn_file_actions_destroy(&files);
    close(ends[1]);
    FILE *stream = fdopen(ends[0], "rb");
    no_display = !fgets(number, sizeof number, stream);
    fclose(stream);
    snprintf(display, sizeof display, ":%d", atoi(number));
    setenv("DISPLAY", display, 1);
    unsetenv("WAYLAND_DISPLAY");
}

static inline int display_begin(void **state) {
    if (drive_begin(state) != 0) return -1;
    static const char *const needed[] = {"Xvfb", "xdotool", "setxkbmap"};
    for (int k = 0; k < 3; k++)
        if (!has_program(needed[k])) {
            print_message("there is no %s\n", needed[k]);
            no_display = true;
        }
    if (!no_display) start_server();
    return 0;
}

static inline int display_end(void **state) {
    if (server) kill(server, SIGTERM), waitpid(server, NULL, 0);
    return drive_end(state);
}

/* What xdotool does. */
static inline void hand(const char *format, ...) {
    char line[512] = "xdotool ";
    va_list list;
    va_start(list, format);
    vsnprintf(line + 8, sizeof line - 8, format, list);
    va_end(list);
    if (system(line) != 0) fail_msg("%s", line);
}

#endif
