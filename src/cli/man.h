/* man.h - `weft help --man [VERB]`: the help texts as pages for man(1), from the same tables */
#pragma once

#include "cli/console/options.h"

typedef struct ExitCode {
    const char *code, *words;
} ExitCode;

/* Prints a page on standard output: man_program that of the program, whose verbs and codes end with NULL; man_verb that
 * of a verb. */
void man_program(const Verb *const *verbs, const ExitCode *codes);
void man_verb(const Verb *verb);
