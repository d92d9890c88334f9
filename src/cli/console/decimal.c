#include "cli/console/decimal.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Powers of ten that are exact. */
enum { EXACT = 22 };
static const double tens[EXACT + 1] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                       1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};

static const char *digits_read(const char *text, uint64_t *whole, int *count) {
    for (; *text >= '0' && *text <= '9'; text++) {
        *whole = 10 * *whole + (uint64_t)(*text - '0');
        *count += *whole > 0;
    }
    return text;
}

/* Reads a decimal number. A whole number below 2^53, divided by an exact power of ten, is rounded only once and so
 * correctly: William D. Clinger, "How to Read Floating Point Numbers Accurately", 1990. strtod reads all other numbers. */
const char *decimal_read(const char *text, double *value) {
    uint64_t whole = 0;
    int count = 0, shift = 0;
    const char *at = text + (*text == '-' || *text == '+'), *first = at;
    at = digits_read(at, &whole, &count);
    long length = at - first;
    if (*at == '.') {
        const char *point = at + 1;
        at = digits_read(point, &whole, &count);
        shift = at - point < 1000 ? (int)(at - point) : 1000;
        length += at - point;
    }
    bool is_decimal = length > 0 && *at != 'e' && *at != 'E'; /* a hexadecimal number ends behind its first 0 */
    if (is_decimal && count <= 18 && whole < (uint64_t)1 << 53 && shift <= EXACT) {
        double number = (double)whole / tens[shift];
        *value = *text == '-' ? -number : number;
        return at;
    }
    char *end;
    *value = strtod(text, &end);
    return end;
}

/* Writes the `count` digits of `whole`, nine at most. Returns where they end. */
static char *digits_write(char *text, uint32_t whole, int count) {
    for (int k = count - 1; k >= 0; k--, whole /= 10) text[k] = (char)('0' + whole % 10);
    return text + count;
}

static char *fraction_end(char *first, char *end) {
    while (end > first && end[-1] == '0') end--;
    return end > first && end[-1] == '.' ? end - 1 : end;
}

/* Returns the first nine digits of value > 0, rounded; the first counts 10^exponent. Returns 0 where double precision
 * leaves the rounding open. */
static uint32_t nine_digits(double value, int *exponent) {
    int power = (int)floor(0.30102999566398 * ilogb(value)); /* the decimal exponent of value, or one less */
    if (power < -2 * EXACT + 9 || power > 2 * EXACT + 8) return 0;
    int shift = 8 - power, far = abs(shift) > EXACT ? EXACT : abs(shift), rest = abs(shift) - far;
    double scaled = shift < 0 ? value / tens[far] / tens[rest] : value * tens[far] * tens[rest]; /* in [1e8, 2e9) */
    if (scaled >= 999999999.75) {
        power++;
        scaled /= 10.0;
    }
    /* the three roundings together err by less than 4e-7 */
    double whole = floor(scaled), left = scaled - whole;
    if (fabs(left - 0.5) < 1e-6) return 0;
    *exponent = power;
    return (uint32_t)whole + (left > 0.5);
}

char *decimal_write(char *text, float value) {
    char digits[9];
    int exponent = 0;
    if (!(value < 0.0f || value > 0.0f)) {
        if (isnan(value)) return text + snprintf(text, DECIMAL_SIZE, "%.9g", (double)value);
        if (signbit(value)) *text++ = '-';
        *text++ = '0';
        return text;
    }
    uint32_t whole = isfinite(value) ? nine_digits(fabs((double)value), &exponent) : 0;
    if (whole < 100000000 || whole > 999999999) return text + snprintf(text, DECIMAL_SIZE, "%.9g", (double)value);
    digits_write(digits, whole, 9);
    if (value < 0.0f) *text++ = '-';
    char *first = text;
    if (exponent >= 0 && exponent < 9) { /* 123.456789 */
        memcpy(text, digits, (size_t)exponent + 1);
        text += exponent + 1;
        *text++ = '.';
        memcpy(text, digits + exponent + 1, (size_t)(8 - exponent));
        return fraction_end(first, text + 8 - exponent);
    }
    if (exponent < 0 && exponent >= -4) { /* 0.000123456789 */
        memset(text, '0', 5);
        text[1] = '.';
        text += 1 - exponent;
        memcpy(text, digits, 9);
        return fraction_end(first, text + 9);
    }
    *text++ = digits[0]; /* 1.23456789e-05 */
    *text++ = '.';
    memcpy(text, digits + 1, 8);
    text = fraction_end(first, text + 8);
    *text++ = 'e';
    *text++ = exponent < 0 ? '-' : '+';
    return digits_write(text, (uint32_t)abs(exponent), 2);
}
