#include "base/number.h"

#include <math.h>
#include <stdlib.h>

bool parse_numbers(const char *text, char separator, int count, float *values) {
    for (int k = 0; k < count; k++) {
        char *end;
        values[k] = strtof(text, &end);
        if (end == text || !isfinite(values[k])) return false;
        if (*end != (k + 1 < count ? separator : '\0')) return false;
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
