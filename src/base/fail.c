#include "base/fail.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/printable.h"
#include "weft/version.h"

static const struct {
    WeftResult result;
    const char *text;
} messages[WEFT_MESSAGE_COUNT] = {
#define MESSAGE_ENTRY(id, result, text) {WEFT_##result, text},
    WEFT_MESSAGES(MESSAGE_ENTRY)
#undef MESSAGE_ENTRY
};

const char *weft_message_text(WeftMessage message) {
    return (unsigned)message < WEFT_MESSAGE_COUNT ? messages[message].text : "";
}

WeftResult message_result(WeftMessage message) { return messages[message].result; }

const char *weft_version(void) { return WEFT_VERSION; }

static void compose(char *line, size_t size, WeftMessage message, const char *subject, const char *detail,
                    va_list arguments) {
    int used = snprintf(line, size, "%.200s: %s", subject[0] ? subject : "\"\"", messages[message].text);
    if (detail && used > 0 && (size_t)used + 2 < size) {
        memcpy(line + used, ": ", 3);
        vsnprintf(line + used + 2, size - (size_t)used - 2, detail, arguments);
    }
    make_printable(line);
}

WeftResult fail(WeftError *error, WeftMessage message, const char *subject, const char *detail, ...) {
    if (error) {
        va_list arguments;
        va_start(arguments, detail);
        error->result = messages[message].result;
        error->message = message;
        compose(error->text, sizeof error->text, message, subject, detail, arguments);
        va_end(arguments);
    }
    return messages[message].result;
}

void warn(const WeftLog *log, WeftMessage message, const char *subject, const char *detail, ...) {
    if (!log || !log->fn) return;
    char line[512];
    va_list arguments;
    va_start(arguments, detail);
    compose(line, sizeof line, message, subject, detail, arguments);
    va_end(arguments);
    log->fn(log->user, message, line);
}
