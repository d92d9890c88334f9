/* number.h - numbers as people type them */
#ifndef WEFT_BASE_NUMBER_H
#define WEFT_BASE_NUMBER_H

#include <stdbool.h>

/* Reads the number that text starts with, with a point as decimal sign whatever the program's locale. Returns
 * what follows it, NULL where there is none or it is not finite. */
const char *number_prefix(const char *text, float *value);

/* One finite number and nothing else. */
bool parse_number(const char *text, float *value);

/* Exactly count finite numbers separated by commas (or any one character of `separator`). */
bool parse_numbers(const char *text, char separator, int count, float *values);

/* "r,g,b", or one number for all three. */
bool parse_color(const char *text, float color[3]);

#endif
