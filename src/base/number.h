/* number.h - numbers that people type are parsed, and printed as the shortest decimals that are read back the same */
#pragma once

#include <stdbool.h>

/* Reads the number that text starts with, with a point as decimal sign in any locale. Returns the text after it, or
 * NULL if there is no number or it is not finite. */
const char *number_prefix(const char *text, float *value);

enum { NUMBER_TEXT = 32 };

/* Prints the shortest decimal that is read as this float, also by way of a double. Returns text. */
const char *number_shortest(float value, char text[NUMBER_TEXT]);

/* Reads one finite number and nothing else. */
bool parse_number(const char *text, float *value);

/* Reads exactly count finite numbers separated by the character `separator`. */
bool parse_numbers(const char *text, char separator, int count, float *values);

/* Reads "r,g,b", or one number for all three. */
bool parse_color(const char *text, float color[3]);
