#define _DEFAULT_SOURCE /* wait4 */
#include "base/process.h"

#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <spawn.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "base/steady_clock.h"

enum { ARGUMENTS_MAX = 64 };

extern char **environ;

/* The signals that end a program and so the one that it runs. */
static const int ending[] = {SIGHUP, SIGINT, SIGQUIT, SIGTERM};
enum { ENDING = sizeof ending / sizeof *ending };

static pthread_mutex_t one_at_a_time = PTHREAD_MUTEX_INITIALIZER;
static volatile sig_atomic_t group, stopped; /* the group that runs, and the signal that came meanwhile; else 0 */
static _Thread_local int to_pass;            /* the signal that this thread's process_run was stopped by; else 0 */

static void stop(int signal_number) {
    int error = errno;
    stopped = signal_number;
    if (group > 0) kill(-(pid_t)group, SIGKILL);
    errno = error;
}

/* Handles the ending signals that are not ignored; keeps how they were handled. */
static void watch_begin(struct sigaction kept[ENDING]) {
    struct sigaction action = {.sa_handler = stop, .sa_flags = SA_RESTART};
    sigemptyset(&action.sa_mask);
    group = stopped = 0;
    for (int k = 0; k < ENDING; k++)
        if (sigaction(ending[k], NULL, &kept[k]) == 0 && kept[k].sa_handler != SIG_IGN)
            sigaction(ending[k], &action, NULL);
}

static void watch_end(const struct sigaction kept[ENDING]) {
    for (int k = 0; k < ENDING; k++)
        if (kept[k].sa_handler != SIG_IGN) sigaction(ending[k], &kept[k], NULL);
}

/* Starts a program in a group of its own. Returns 0, or what went wrong. */
static int start(const char *const *words, const char *log, pid_t *child) {
    posix_spawn_file_actions_t files;
    posix_spawnattr_t attributes;
    if (posix_spawn_file_actions_init(&files) != 0) return ENOMEM;
    int failed = posix_spawnattr_init(&attributes);
    if (failed) {
        posix_spawn_file_actions_destroy(&files);
        return failed;
    }
    failed = posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
    if (!failed) failed = posix_spawnattr_setpgroup(&attributes, 0);
    if (!failed) failed = posix_spawn_file_actions_addopen(&files, 0, "/dev/null", O_RDONLY, 0);
    if (!failed) failed = posix_spawn_file_actions_addopen(&files, 1, log, O_WRONLY | O_CREAT | O_TRUNC, 0600);
    if (!failed) failed = posix_spawn_file_actions_adddup2(&files, 1, 2);
    if (!failed) failed = posix_spawn(child, "/bin/sh", &files, &attributes, (char *const *)(uintptr_t)words, environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&files);
    return failed;
}

static double seconds_of(struct timeval time) { return (double)time.tv_sec + 1e-6 * (double)time.tv_usec; }

/* Waits for a child, as long as it may take. Returns what process_run returns. */
static int await(pid_t child, ProcessBounds bounds) {
    const struct timespec pause = {.tv_nsec = 2000000};
    const double end = clock_now() + (double)bounds.seconds;
    struct rusage used = {0};
    int status = 0;
    bool late = false;
    for (;;) {
        pid_t ended = wait4(child, &status, late ? 0 : WNOHANG, &used);
        if (ended == child) break;
        if (ended < 0 && errno != EINTR) return PROCESS_LOST;
        late = clock_now() > end;
        if (late || stopped) kill(-child, SIGKILL); /* again: it may not have been a group at the first */
        nanosleep(&pause, NULL);
    }
    kill(-child, SIGKILL); /* what it has left behind */
    int code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    /* The kernel counts ticks for the bound, which on a busy machine are more than the time that was taken. */
    bool spent = seconds_of(used.ru_utime) + seconds_of(used.ru_stime) >= 0.7 * (double)bounds.cpu_seconds;
    return late || (code && spent) ? PROCESS_LATE : code;
}

int process_run(const char *const *arguments, ProcessBounds bounds, const char *folder, const char *log) {
    /* A shell sets the bounds, so that no process starts without them; a bound of the user's own may be narrower. */
    char seconds[16], kibibytes[24];
    snprintf(seconds, sizeof seconds, "%d", bounds.cpu_seconds);
    snprintf(kibibytes, sizeof kibibytes, "%lld", 1024 * (long long)bounds.mebibytes);
    const char *words[ARGUMENTS_MAX + 7] = {
        "sh",
        "-c",
        ("(ulimit -t $0) 2>/dev/null && ulimit -t $0; (ulimit -v $1) 2>/dev/null && ulimit -v $1; "
         "LC_ALL=C TMPDIR=$2; export LC_ALL TMPDIR; shift 2; exec \"$@\""),
        seconds,
        kibibytes,
        folder};
    for (int k = 0; k < ARGUMENTS_MAX && arguments[k]; k++) words[6 + k] = arguments[k];
    struct sigaction kept[ENDING];
    pid_t child;
    int result = PROCESS_MISSING;
    pthread_mutex_lock(&one_at_a_time);
    watch_begin(kept);
    if (start(words, log, &child) == 0) {
        group = child;
        result = await(child, bounds);
        group = 0;
    }
    watch_end(kept);
    to_pass = stopped;
    pthread_mutex_unlock(&one_at_a_time);
    return to_pass ? PROCESS_STOPPED : result;
}

void process_signal_pass(void) {
    const int passed = to_pass;
    to_pass = 0;
    if (passed) raise(passed);
}
