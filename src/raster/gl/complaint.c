#include "raster/gl/complaint.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/fail.h"

/* Returns the line of the text that a driver's message names, and sets `words` to what follows; 0 if it names none.
 *
 *   0:11(1): error: WORDS          Mesa: string, line, column
 *   0(11) : error C1008: WORDS     NVIDIA
 *   ERROR: 0:11: WORDS             Apple, AMD, ANGLE and others that stand on glslang's grammar */
static int line_of(const char *c, const char **words) {
    char *end;
    if (strncmp(c, "ERROR: ", 7) == 0) c += 7;
    if (!is_digit(*c)) return 0;
    strtol(c, &end, 10);
    if ((*end != ':' && *end != '(') || !is_digit(end[1])) return 0;
    long line = strtol(end + 1, &end, 10);
    if (*end == '(') end += strcspn(end, ")\n");
    end += strspn(end, ") :");
    *words = strncmp(end, "error: ", 7) == 0 ? end + 7 : end;
    return line < INT_MAX ? (int)line : 0;
}

static bool contains(const char *line, size_t size, const char *word) {
    const char *found = strstr(line, word);
    return found && found < line + size;
}

/* Returns the first line of a log that names an error and its line; else the first that names an error; else the
 * log. */
static const char *find_error(const char *log) {
    const char *best = NULL, *words;
    for (const char *line = log; *line;) {
        size_t size = strcspn(line, "\r\n");
        if (contains(line, size, "error") || contains(line, size, "ERROR")) {
            if (line_of(line, &words)) return line;
            if (!best) best = line;
        }
        line += size;
        line += strspn(line, "\r\n");
    }
    return best ? best : log;
}

void complain(const char *name, const char *log, const Text *text, WeftError *error) {
    char what[400];
    const char *line = find_error(log), *words = line;
    int at = text ? line_of(line, &words) : 0;
    Origin origin = at ? text_origin(text, at) : (Origin){0};
    if (!origin.file) words = line;
    snprintf(what, sizeof what, "%.*s", (int)strcspn(words, "\r\n"), words);
    if (origin.file)
        text_fail_at(origin, WEFT_MESSAGE_GL_COMPILE, what, error);
    else
        fail(error, WEFT_MESSAGE_GL_COMPILE, name, "%s", what);
}
