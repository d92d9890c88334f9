#include "base/process.h"

#include <errno.h>
#include <fcntl.h>
#include <spawn.h>
#include <stddef.h>
#include <stdint.h>
#include <sys/wait.h>
#include <unistd.h>

enum { ARGUMENTS_MAX = 64 };

extern char **environ;

int process_run(const char *const *arguments, const char *log) {
    const char *all[ARGUMENTS_MAX + 3] = {"env", "LC_ALL=C"};
    for (int k = 0; k < ARGUMENTS_MAX && arguments[k]; k++) all[2 + k] = arguments[k];
    posix_spawn_file_actions_t files;
    if (posix_spawn_file_actions_init(&files) != 0) return PROCESS_MISSING;
    pid_t child;
    int status, failed = posix_spawn_file_actions_addopen(&files, 0, "/dev/null", O_RDONLY, 0);
    if (!failed) failed = posix_spawn_file_actions_addopen(&files, 1, log, O_WRONLY | O_CREAT | O_TRUNC, 0600);
    if (!failed) failed = posix_spawn_file_actions_adddup2(&files, 1, 2);
    if (!failed) failed = posix_spawnp(&child, "env", &files, NULL, (char *const *)(uintptr_t)all, environ);
    posix_spawn_file_actions_destroy(&files);
    if (failed) return PROCESS_MISSING;
    while (waitpid(child, &status, 0) < 0)
        if (errno != EINTR) return PROCESS_LOST;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}
