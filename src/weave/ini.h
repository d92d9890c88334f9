/* ini.h - text of "[section]" and "key=value" lines, the syntax of WIF
 *
 * Lines end in LF, CR LF or CR. Blanks around names and values do not count, nor does the case of names.
 * Lines that begin with ; are comments. There is no limit on the length of a line. */
#pragma once

#include <stdbool.h>
#include <stddef.h>

#include "weft/result.h"

/* A line of a file. value is NULL for a line without "=", and for one in brackets that has "=" in them and so is no section:
 * key is then the whole line. section is "" before the first section. */
typedef struct IniLine {
    const char *section, *key, *value;
    int number; /* of the line in the file, from 1 */
} IniLine;

typedef struct Ini {
    const char *name; /* the subject of errors; borrowed */
    char *text;       /* the file, cut into strings */
    IniLine *lines;
    int count;
    int unclosed; /* number of the first line with a section without its closing bracket; 0: none */
} Ini;

/* Reads size bytes. Fails with WEFT_MESSAGE_DRAFT for bytes that are not text, or _MEMORY. Release with
 * ini_free in either case. */
WeftResult ini_read(const void *data, size_t size, const char *name, Ini *out, WeftError *error);
void ini_free(Ini *ini);

/* Adds a line. Returns false if memory is short. */
bool ini_add(Ini *ini, IniLine line);

/* Returns the last line of that section and key, or of that section if key is NULL; NULL without one. */
const IniLine *ini_find(const Ini *ini, const char *section, const char *key);

/* Returns the key as a number, 1 and above; 0 if it is none. */
long ini_index(const IniLine *line);
