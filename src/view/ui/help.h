/* help.h - help on a choice from the catalogue's own files: appearance, formula, source */
#pragma once

/* Returns the comment at the head of the file of that value, as lines of text; for value -1 (auto) what the choice is
 * about. "" if there is none. Valid until the next call. */
const char *help_choice(int choice, int value);

/* Returns the help of an input: meaning, range and how to reset it. Valid until the next call. */
const char *help_input(int input);
