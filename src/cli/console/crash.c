#define _GNU_SOURCE /* SA_RESETHAND, SA_ONSTACK */
#include "cli/console/crash.h"

#include <execinfo.h>
#include <signal.h>
#include <string.h>
#include <unistd.h>

enum { CALLS = 64, STACK = 1 << 16 };

/* Calls only what may be called in a handler: backtrace, too, once it has loaded its library. */
static void tell(int number) {
    static const char line[] = "weft: crashed; please report the calls that led to it:\n";
    void *calls[CALLS];
    if (write(STDERR_FILENO, line, sizeof line - 1) > 0)
        backtrace_symbols_fd(calls, backtrace(calls, CALLS), STDERR_FILENO);
    raise(number); /* whose handler is the usual one again */
}

void crash_begin(void) {
    static const int numbers[] = {SIGSEGV, SIGBUS, SIGILL, SIGFPE, SIGABRT};
    static char room[STACK]; /* for a stack that has run over */
    const stack_t stack = {.ss_sp = room, .ss_size = sizeof room};
    struct sigaction before, handler = {.sa_handler = tell, .sa_flags = (int)(SA_RESETHAND | SA_NODEFER | SA_ONSTACK)};
    void *none[1];
    backtrace(none, 1);
    sigaltstack(&stack, NULL);
    for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++)
        if (sigaction(numbers[k], NULL, &before) == 0 && before.sa_handler == SIG_DFL)
            sigaction(numbers[k], &handler, NULL);
}
