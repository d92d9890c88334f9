/* path.h - suffixes of file names, and numbers before them */
#pragma once

#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

/* Returns true if the path ends in that suffix, in any case, and has more before it. */
static inline bool path_ends(const char *path, const char *suffix) {
    size_t length = strlen(path), size = strlen(suffix);
    return length > size && strcasecmp(path + length - size, suffix) == 0;
}

enum { PATH_NUMBER = 16 };

/* Writes the number of picture `index` of `count`: three digits, of more than a thousand pictures four. Returns number. */
static inline const char *path_number(int index, int count, char number[PATH_NUMBER]) {
    snprintf(number, PATH_NUMBER, "%0*d", count > 1000 ? 4 : 3, index);
    return number;
}

/* Writes "out-007.png" of "out.png" and "007". Returns false if it does not fit. */
static inline bool path_numbered(const char *path, const char *number, char *out, size_t size) {
    const char *slash = strrchr(path, '/'), *dot = strrchr(path, '.');
    const size_t stem = dot && (!slash || dot > slash) ? (size_t)(dot - path) : strlen(path);
    const int used = snprintf(out, size, "%.*s-%s%s", (int)stem, path, number, path + stem);
    return used >= 0 && (size_t)used < size;
}
