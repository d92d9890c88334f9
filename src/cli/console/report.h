/* report.h - the line on standard error that reports a failure or a warning */
#pragma once

#include <stdbool.h>

#include "weft/result.h"

/* Prints "weft: ..." and a newline on standard error and returns result, the exit code. Control characters
 * become '?', so that a hostile name cannot break the line. */
__attribute__((format(printf, 2, 3))) int report(int result, const char *format, ...);

/* Works as report, for a failure of the library. */
int report_error(const WeftError *error);

/* Prints a name that may come from a file on standard output, without what a terminal would obey. */
void print_name(const char *name);

/* Returns true if a failure was reported, in any thread. */
bool report_failed(void);

/* Prints a warning in the same form: the fn of a WeftLog. user is not read. */
void report_warning(void *user, WeftMessage message, const char *text);

/* Warnings so far, each line once. */
typedef struct Warnings {
    bool quiet;
    char **lines; /* owned, see warnings_free */
    int count;
} Warnings;

/* Keeps a line for --json and prints it unless quiet; short of memory it is only printed. One that is not grave is not
 * called a warning. */
void warnings_add(Warnings *warnings, bool grave, const char *text);

/* Adds a message of the library: the fn of a WeftLog whose user is Warnings. */
void warnings_log(void *user, WeftMessage message, const char *text);

void warnings_free(Warnings *warnings);

/* Fills error with a failure of the program itself, and returns result. */
WeftResult failure(WeftError *error, WeftResult result, const char *text);
