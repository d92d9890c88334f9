/* number.h - numbers as people type them */
#ifndef WEFT_BASE_NUMBER_H
#define WEFT_BASE_NUMBER_H

#include <stdbool.h>

/* One finite number and nothing else, point as decimal sign in any locale's "C" form. */
bool parse_number(const char *text, float *value);

/* Exactly count finite numbers separated by commas (or any one character of `separator`). */
bool parse_numbers(const char *text, char separator, int count, float *values);

/* "r,g,b", or one number for all three. */
bool parse_color(const char *text, float color[3]);

#endif
