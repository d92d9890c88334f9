/* report.h - the one line that says what went wrong */
#ifndef WEFT_CLI_REPORT_H
#define WEFT_CLI_REPORT_H

#include <stdbool.h>

#include "weft/result.h"

/* Prints "weft: ..." and a newline on standard error and returns result, the exit code. Control characters
 * become '?', so that a hostile name cannot break the line. */
__attribute__((format(printf, 2, 3))) int report(int result, const char *format, ...);

/* Works as report, for a failure of the library. */
int report_error(const WeftError *error);

/* Returns true if a failure was reported, in any thread. */
bool report_failed(void);

/* Prints a warning in the same form: the fn of a WeftLog. user is not read. */
void report_warning(void *user, WeftMessage message, const char *text);

#endif
