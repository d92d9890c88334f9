/* options.h - the arguments of a verb: one table per verb, which generates parsing, checks, help and docs/cli.md
 *
 * "--name value" and "--name=value" are the same; "--" ends the options; "-" alone is an operand. */
#pragma once

#include <stdbool.h>
#include <stddef.h>

typedef struct Option {
    const char *name;  /* "--spp" or "-o"; NULL: a heading */
    const char *value; /* stands for the value in help texts; NULL: a switch */
    const char *help;  /* NULL, with name NULL: the table's end */
    const char *def;   /* the default as one would type it; NULL: none */
    double low, high;  /* numbers: the range, both ends included; else equal */
    bool repeats;      /* may be given more than once */
    bool whole;        /* numbers: without a fraction */
} Option;

/* Rows of a table. OPTION_HEADING is a heading for the rows that follow. */
#define OPTION_HEADING(text)                                                                                           \
    { .help = (text) }
#define OPTION_SWITCH(name_, help_)                                                                                    \
    { .name = (name_), .help = (help_) }
#define OPTION_TEXT(name_, value_, def_, help_)                                                                        \
    { name_, value_, help_, def_, 0, 0, false, false }
#define OPTION_LIST(name_, value_, help_)                                                                              \
    { name_, value_, help_, NULL, 0, 0, true, false }
#define OPTION_NUMBER(name_, value_, def_, low_, high_, help_)                                                         \
    { name_, value_, help_, def_, low_, high_, false, false }
#define OPTION_WHOLE(name_, value_, def_, low_, high_, help_)                                                          \
    { name_, value_, help_, def_, low_, high_, false, true }
#define OPTION_END                                                                                                     \
    { .name = NULL }

typedef struct Options Options;

typedef struct Verb {
    const char *name, *operands, *help; /* operands as in a usage line */
    int operands_least, operands_most;
    const Option *options;
    void (*lists)(void); /* prints lists between options and notes; NULL: there are none */
    const char *notes;   /* the end of the help, printed unchanged, with examples */
    int (*run)(const Options *options);
} Verb;

/* An option that was given. */
typedef struct Given {
    const Option *option;
    const char *value; /* "" for a switch */
} Given;

/* The command line, parsed. Strings are those of argv. */
struct Options {
    const Verb *verb;
    Given *given;
    const char **operands;
    char **arguments; /* all that follow the verb */
    int given_count, operand_count, argument_count;
};

/* Reads the arguments after the verb, and checks each number by its range. Returns 0, or an exit code after one line on
 * standard error. Release with options_free in either case. */
int options_parse(const Verb *verb, int count, char **arguments, Options *options);
void options_free(Options *options);

/* Prints `weft VERB --help` on standard output. */
void options_help(const Verb *verb);

/* Returns true if the option was given. */
bool option_given(const Options *options, const char *name);

/* Returns the value typed, else the default, else NULL. */
const char *option_text(const Options *options, const char *name);

/* Returns the next value of an option that repeats, in the order typed. Start with *cursor = 0; NULL after the last. */
const char *option_next(const Options *options, const char *name, int *cursor);

/* Returns the row of an option that the verb has. */
const Option *option_row(const Options *options, const char *name);

/* Forgets what option_next has returned before it set its cursor to at + 1. */
void option_drop(Options *options, int at);

/* Reads the value of an OPTION_WHOLE or an OPTION_NUMBER, which options_parse has checked. An option with neither value
 * nor default leaves *number as it is. Returns false after one line on standard error if it is no such number. */
bool option_integer(const Options *options, const char *name, int *number);
bool option_number(const Options *options, const char *name, double *number);

/* Finds the value's index in names, which ends with NULL. Returns false after one line on standard error. */
bool option_choice(const Options *options, const char *name, const char *const *names, int *index);

/* Reads exactly `count` finite numbers separated by commas. Returns false without a message. */
bool numbers_parse(const char *text, int count, double *numbers);
