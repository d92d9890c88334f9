#include "cli/console/options.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/console/names.h"
#include "cli/console/report.h"
#include "cli/console/two_columns.h"

static bool is_end(const Option *row) { return !row->name && !row->help; }

/* Returns the row whose name is the first `length` characters of text, or NULL. */
static const Option *row_find(const Verb *verb, const char *text, size_t length) {
    for (const Option *row = verb->options; !is_end(row); row++)
        if (row->name && strlen(row->name) == length && strncmp(row->name, text, length) == 0) return row;
    return NULL;
}

/* Returns the verb's own name for an option that other renderers call so; NULL: it has none. */
static const char *option_elsewhere(const Verb *verb, const char *typed) {
    static const struct {
        const char *elsewhere, *here;
    } words[] = {
        {"--samples", "--spp"}, {"--size", "--width"},      {"--resolution", "--width"}, {"--output", "-o"},
        {"--out", "-o"},        {"--environment", "--env"}, {"--hdri", "--env"},         {"--bounces", "--max-depth"}};
    for (size_t k = 0; k < sizeof words / sizeof *words; k++)
        if (strcmp(typed, words[k].elsewhere) == 0 && row_find(verb, words[k].here, strlen(words[k].here)))
            return words[k].here;
    return NULL;
}

static int unknown_option(const Verb *verb, const char *argument, size_t length) {
    char typed[64], hint[96];
    snprintf(typed, sizeof typed, "%.*s", (int)(length < sizeof typed ? length : sizeof typed - 1), argument);
    Nearest nearest = {.typed = typed, .name = option_elsewhere(verb, typed)}; /* at distance 0: none is nearer */
    nearest_offer(&nearest, "--help");
    for (const Option *row = verb->options; !is_end(row); row++)
        if (row->name) nearest_offer(&nearest, row->name);
    if (!nearest.name)
        return report(WEFT_USAGE, "%s: is not an option of %s; see weft %s --help", typed, verb->name, verb->name);
    return report(WEFT_USAGE, "%s: is not an option of %s%s", typed, verb->name,
                  nearest_hint(&nearest, hint, sizeof hint));
}

bool numbers_parse(const char *text, int count, double *numbers) {
    for (int k = 0; k < count; k++) {
        char *end;
        numbers[k] = strtod(text, &end);
        if (end == text || !isfinite(numbers[k]) || *end != (k + 1 < count ? ',' : '\0')) return false;
        text = end + 1;
    }
    return true;
}

static bool number_read(const Option *row, const char *text, double *number) {
    double value;
    if (numbers_parse(text, 1, &value) && value >= row->low && value <= row->high &&
        !(row->whole && value > floor(value))) {
        *number = value;
        return true;
    }
    report(WEFT_USAGE, "%s: \"%.80s\" is not a %snumber from %.10g to %.10g", row->name, text,
           row->whole ? "whole " : "", row->low, row->high);
    return false;
}

/* Takes the option at arguments[0]; *used is the number of arguments it took. */
static int option_take(Options *options, int count, char **arguments, int *used) {
    const char *argument = arguments[0], *equals = NULL;
    if (strncmp(argument, "--", 2) == 0) equals = strchr(argument, '=');
    size_t length = equals ? (size_t)(equals - argument) : strlen(argument);
    const Option *row = row_find(options->verb, argument, length);
    if (!row) return unknown_option(options->verb, argument, length);
    if (!row->repeats && option_given(options, row->name)) return report(WEFT_USAGE, "%s: is given twice", row->name);
    const char *value = equals ? equals + 1 : "";
    *used = 1;
    if (!row->value && equals) return report(WEFT_USAGE, "%s: takes no value", row->name);
    if (row->value && !equals) {
        /* a value that looks like an option must be written --name=value */
        if (count < 2 || strncmp(arguments[1], "--", 2) == 0)
            return report(WEFT_USAGE, "%s: needs a value: %s %s", row->name, row->name, row->value);
        value = arguments[1];
        *used = 2;
    }
    if (row->value && !value[0])
        return report(WEFT_USAGE, "%s: \"\" is no value: %s %s", row->name, row->name, row->value);
    double number;
    if (row->low < row->high && !number_read(row, value, &number)) return WEFT_USAGE;
    options->given[options->given_count++] = (Given){row, value};
    return 0;
}

int options_parse(const Verb *verb, int count, char **arguments, Options *options) {
    size_t capacity = (size_t)count + 1;
    *options = (Options){.verb = verb, .arguments = arguments, .argument_count = count};
    options->given = calloc(capacity, sizeof *options->given);
    options->operands = calloc(capacity, sizeof *options->operands);
    if (!options->given || !options->operands) return report(WEFT_RESOURCES, "out of memory");
    bool only_operands = false;
    for (int k = 0, used = 1; k < count; k += used, used = 1) {
        const char *argument = arguments[k];
        if (!only_operands && strcmp(argument, "--") == 0) {
            only_operands = true;
        } else if (!only_operands && argument[0] == '-' && argument[1]) {
            int result = option_take(options, count - k, arguments + k, &used);
            if (result != 0) return result;
        } else if (options->operand_count == verb->operands_most) {
            return report(WEFT_USAGE, "%.200s: is one operand too many; weft %s %s", argument, verb->name,
                          verb->operands);
        } else if (!argument[0]) {
            return report(WEFT_USAGE, "\"\": is no operand; weft %s %s", verb->name, verb->operands);
        } else {
            options->operands[options->operand_count++] = argument;
        }
    }
    if (options->operand_count < verb->operands_least)
        return report(WEFT_USAGE, "%s: lacks an operand; weft %s %s", verb->name, verb->name, verb->operands);
    return 0;
}

void options_free(Options *options) {
    free(options->given);
    free(options->operands);
    *options = (Options){0};
}

enum { HELP_COLUMN = 26 };

static void help_row(const Option *row) {
    if (!row->name) {
        printf("\n%s\n", row->help);
        return;
    }
    char left[96], right[512];
    snprintf(left, sizeof left, "%s%s%s", row->name, row->value ? " " : "", row->value ? row->value : "");
    snprintf(right, sizeof right, "%s%s%s%s%s", row->help, row->repeats ? "; may be repeated" : "",
             row->def ? " [" : "", row->def ? row->def : "", row->def ? "]" : "");
    layout_entry(stdout, HELP_COLUMN, left, right);
}

void options_help(const Verb *verb) {
    printf("weft %s - %s\n\nUsage: weft %s %s\n", verb->name, verb->help, verb->name, verb->operands);
    for (const Option *row = verb->options; !is_end(row); row++) help_row(row);
    layout_entry(stdout, HELP_COLUMN, "--help", "print this");
    if (verb->lists) verb->lists();
    printf("\n%s", verb->notes);
}

const char *option_next(const Options *options, const char *name, int *cursor) {
    while (*cursor < options->given_count) {
        const Given *given = &options->given[(*cursor)++];
        if (strcmp(given->option->name, name) == 0) return given->value;
    }
    return NULL;
}

const Option *option_row(const Options *options, const char *name) {
    return row_find(options->verb, name, strlen(name));
}

void option_drop(Options *options, int at) {
    options->given_count--;
    for (int k = at; k < options->given_count; k++) options->given[k] = options->given[k + 1];
}

bool option_given(const Options *options, const char *name) {
    int cursor = 0;
    return option_next(options, name, &cursor) != NULL;
}

const char *option_text(const Options *options, const char *name) {
    int cursor = 0;
    const char *value = option_next(options, name, &cursor);
    return value ? value : option_row(options, name)->def;
}

bool option_number(const Options *options, const char *name, double *number) {
    const char *text = option_text(options, name);
    return !text || number_read(option_row(options, name), text, number);
}

bool option_integer(const Options *options, const char *name, int *number) {
    double value = *number;
    if (!option_number(options, name, &value)) return false;
    *number = (int)value;
    return true;
}

bool option_choice(const Options *options, const char *name, const char *const *names, int *index) {
    const char *text = option_text(options, name);
    char list[256] = "";
    for (int k = 0; names[k]; k++) {
        if (strcmp(names[k], text) == 0) {
            *index = k;
            return true;
        }
        snprintf(list + strlen(list), sizeof list - strlen(list), "%s%s", k ? ", " : "", names[k]);
    }
    report(WEFT_USAGE, "%s: \"%.80s\" is not one of %s", name, text, list);
    return false;
}
