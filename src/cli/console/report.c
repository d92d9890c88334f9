#include "cli/console/report.h"

#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/printable.h"

static atomic_bool failed;

int report(int result, const char *format, ...) {
    char line[1024];
    if (result != WEFT_OK) atomic_store(&failed, true);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(line, sizeof line, format, arguments);
    va_end(arguments);
    make_printable(line);
    fprintf(stderr, "weft: %s\n", line);
    return result;
}

void print_name(const char *name) {
    char line[1024];
    fputs(printable(name, line, sizeof line), stdout);
}

bool report_failed(void) { return atomic_load(&failed); }

int report_error(const WeftError *error) { return report((int)error->result, "%s", error->text); }

void report_warning(void *user, WeftMessage message, const char *text) {
    (void)user, (void)message;
    report(0, "warning: %s", text);
}

void warnings_add(Warnings *warnings, bool grave, const char *text) {
    for (int k = 0; k < warnings->count; k++)
        if (strcmp(warnings->lines[k], text) == 0) return;
    if (!warnings->quiet) report(0, "%s%s", grave ? "warning: " : "", text);
    char **grown = realloc(warnings->lines, (size_t)(warnings->count + 1) * sizeof *grown);
    if (!grown) return;
    warnings->lines = grown;
    if ((grown[warnings->count] = strdup(text))) warnings->count++;
}

void warnings_free(Warnings *warnings) {
    for (int k = 0; k < warnings->count; k++) free(warnings->lines[k]);
    free(warnings->lines);
    *warnings = (Warnings){0};
}

void warnings_log(void *user, WeftMessage message, const char *text) {
    warnings_add(user, message != WEFT_MESSAGE_NONE, text);
}

WeftResult failure(WeftError *error, WeftResult result, const char *text) {
    error->result = result;
    snprintf(error->text, sizeof error->text, "%s", text);
    return result;
}
