/* decimal.h - numbers to and from text, as strtod reads and printf prints them in the C locale, but several times as
 * fast; no hexadecimal numbers */
#pragma once

/* Reads the number that text starts with, as strtod does, but "0x1e" as 0. Returns what follows it; text
 * itself where there is none. */
const char *decimal_read(const char *text, double *value);

enum { DECIMAL_SIZE = 32 };

/* Writes value as printf's %.9g would, without a zero at the end, and returns what follows it. At most
 * DECIMAL_SIZE characters. */
char *decimal_write(char *text, float value);
