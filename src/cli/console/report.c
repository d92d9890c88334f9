#include "cli/console/report.h"

#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>

static atomic_bool failed;

int report(int result, const char *format, ...) {
    char line[1024];
    if (result != WEFT_OK) atomic_store(&failed, true);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(line, sizeof line, format, arguments);
    va_end(arguments);
    for (char *c = line; *c; c++)
        if ((unsigned char)*c < 0x20 || *c == 0x7f) *c = '?';
    fprintf(stderr, "weft: %s\n", line);
    return result;
}

bool report_failed(void) { return atomic_load(&failed); }

int report_error(const WeftError *error) { return report((int)error->result, "%s", error->text); }

void report_warning(void *user, WeftMessage message, const char *text) {
    (void)user, (void)message;
    report(0, "warning: %s", text);
}
