/* number.h - a float as GLSL writes it */
#ifndef WEFT_TEXT_NUMBER_H
#define WEFT_TEXT_NUMBER_H

#include <stdio.h>
#include <string.h>

typedef struct Number {
    char text[32];
} Number;

/* All of its digits, and a point or an exponent in any case: without one it would be an integer. */
static inline Number number(float value) {
    Number n;
    int size = snprintf(n.text, sizeof n.text - 2, "%.9g", (double)value);
    if (!strpbrk(n.text, ".e")) memcpy(n.text + size, ".0", 3);
    return n;
}

#endif
