/* process.h - running another program to its end, within bounds */
#pragma once

#include <stddef.h>

/* The bounds of a program: seconds of the clock; seconds of processor time, which a busy machine stretches; MiB of
 * address space, for each process. */
typedef struct ProcessBounds {
    int seconds, cpu_seconds, mebibytes;
} ProcessBounds;

/* The results of process_run beside an exit code. */
enum {
    PROCESS_MISSING = 127, /* there is no such program, or it cannot be started */
    PROCESS_LOST = -1, /* the program's end cannot be waited for, as while SIGCHLD is ignored (waitpid, POSIX.1-2017) */
    PROCESS_LATE = -2, /* the program took too long, and was ended */
    PROCESS_STOPPED = -3 /* a signal came that ends programs, which ended it: see process_signal_pass */
};

/* Runs arguments[0], found by $PATH, in the language "C"; arguments end with NULL. It reads nothing, and what
 * it prints goes to the file `log`; $TMPDIR is `folder` for it. It and the processes that it starts are a group of their
 * own. Returns its exit code, 128 and more where a signal ended it, or one of the above. Two threads run programs one
 * after the other. */
int process_run(const char *const *arguments, ProcessBounds bounds, const char *folder, const char *log);

/* Hands on the signal that made process_run return PROCESS_STOPPED: SIGHUP, SIGINT, SIGQUIT or SIGTERM. Ends the
 * program unless it handles the signal. Call it when what the ended program left is cleared away. */
void process_signal_pass(void);
