/* process.h - running another program to its end */
#pragma once

/* Runs arguments[0], found by $PATH, in the language "C"; arguments end with NULL. It reads nothing, and what
 * it prints goes to the file `log`. Returns its exit code, 128 and more where a signal ended it, and
 * PROCESS_MISSING where there is no such program or it cannot be started; PROCESS_LOST where its end cannot
 * be waited for, as while SIGCHLD is ignored (waitpid, POSIX.1-2017). */
enum { PROCESS_MISSING = 127, PROCESS_LOST = -1 };
int process_run(const char *const *arguments, const char *log);
