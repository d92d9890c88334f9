/* number_text.h - a float as GLSL writes it */
#pragma once

#include <string.h>

#include "base/number.h"

typedef struct Number {
    char text[NUMBER_TEXT]; /* of which number_shortest needs 16 at most */
} Number;

/* Prints the shortest digits that read back as the same number, always with a point or an exponent: without
 * one it would be an integer. */
static inline Number number(float value) {
    Number n;
    number_shortest(value, n.text);
    if (!strpbrk(n.text, ".e")) memcpy(n.text + strlen(n.text), ".0", 3);
    return n;
}
