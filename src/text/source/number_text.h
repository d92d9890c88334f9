/* number_text.h - a float as GLSL writes it */
#pragma once

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/equal.h"

typedef struct Number {
    char text[32];
} Number;

/* Prints the shortest digits that read back as the same number, always with a point or an exponent: without
 * one it would be an integer. */
static inline Number number(float value) {
    Number n;
    int size = 0;
    for (int digits = 6; digits <= 9; digits++) {
        size = snprintf(n.text, sizeof n.text - 2, "%.*g", digits, (double)value);
        float read = strtof(n.text, NULL);
        if (is_equal(read, value)) break;
    }
    if (!strpbrk(n.text, ".e")) memcpy(n.text + size, ".0", 3);
    return n;
}
