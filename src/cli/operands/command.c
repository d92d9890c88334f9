#include "cli/operands/command.h"

#include <stdlib.h>
#include <string.h>

#include "base/printable.h"

static const char safe[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_./,=:+@%";

static char *append(char *to, const char *text) {
    while (*text) *to++ = *text++;
    return to;
}

/* Appends a blank and an argument, in single quotes unless all its characters are safe. Returns where it ends. */
static char *argument_write(char *to, const char *argument) {
    const char *quote = argument[strspn(argument, safe)] || !argument[0] ? "'" : "";
    to = append(append(to, " "), quote);
    for (; *argument; argument++) {
        if (*argument == '\'') to = append(to, "'\\'");
        *to++ = *argument;
    }
    return append(to, quote);
}

char *command_text(const Options *options) {
    size_t capacity = sizeof "weft " + strlen(options->verb->name);
    for (int k = 0; k < options->argument_count; k++) capacity += 3 + 4 * strlen(options->arguments[k]);
    char *text = malloc(capacity), *to = text;
    if (!text) return NULL;
    to = argument_write(append(to, "weft"), options->verb->name);
    for (int k = 0; k < options->argument_count; k++) to = argument_write(to, options->arguments[k]);
    *to = '\0';
    make_printable(text);
    return text;
}

char *command_word(const char *word) {
    char *text = malloc(4 + 4 * strlen(word));
    if (!text) return NULL;
    *argument_write(text, word) = '\0';
    memmove(text, text + 1, strlen(text)); /* the blank before it */
    return text;
}

char *command_assign_text(const Options *options) {
    static const char *const names[] = {
        "--time",    "--animation", "--variant", "--preset", "--material", "--materials", "--weave",   "--workflow",
        "--profile", "--diffuse",   "--sheen",   "--layer",  "--texture",  "--set",       "--convert", "--light"};
    size_t capacity = 1;
    for (int k = 0; k < options->argument_count; k++) capacity += 16 + 4 * strlen(options->arguments[k]);
    char *text = malloc(capacity), *to = text;
    if (!text) return NULL;
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        int cursor = 0;
        for (const char *value; (value = option_next(options, names[k], &cursor));)
            to = argument_write(argument_write(to, names[k]), value);
    }
    *to = '\0';
    if (text[0]) memmove(text, text + 1, strlen(text)); /* the blank before the first */
    make_printable(text);
    return text;
}
