#define _GNU_SOURCE /* strtof_l */
#include "base/number.h"

#include <locale.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/equal.h"

const char *number_prefix(const char *text, float *value) {
    locale_t locale = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    if (!locale) return NULL;
    char *end;
    *value = strtof_l(text, &end, locale);
    freelocale(locale);
    return end != text && isfinite(*value) ? end : NULL;
}

const char *number_shortest(float value, char text[NUMBER_TEXT]) {
    for (int digits = 6; digits <= 9; digits++) {
        snprintf(text, NUMBER_TEXT, "%.*g", digits, (double)value);
        if (is_equal(strtof(text, NULL), value) && is_equal((float)strtod(text, NULL), value)) break;
    }
    return text;
}

bool parse_numbers(const char *text, char separator, int count, float *values) {
    for (int k = 0; k < count; k++) {
        const char *end = number_prefix(text, &values[k]);
        if (!end || *end != (k + 1 < count ? separator : '\0')) return false;
        text = end + 1;
    }
    return true;
}

bool parse_number(const char *text, float *value) { return parse_numbers(text, ',', 1, value); }

bool parse_color(const char *text, float color[3]) {
    if (parse_numbers(text, ',', 3, color)) return true;
    if (!parse_number(text, &color[0])) return false;
    color[1] = color[2] = color[0];
    return true;
}
