/* path.h - suffixes of file names, what they stand for, and numbers before them */
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

/* Returns true for a material of the textile industry, .u3m or .u3ma. */
static inline bool path_is_u3m(const char *path) { return path_ends(path, ".u3m") || path_ends(path, ".u3ma"); }

/* Returns NAME of builtin:NAME, a scene that the program brings, or NULL where the path is a file's. */
static inline const char *path_builtin(const char *path) {
    static const char prefix[] = "builtin:";
    return strncmp(path, prefix, sizeof prefix - 1) == 0 ? path + sizeof prefix - 1 : NULL;
}

/* Returns true for a file that is a material and may be named as a scene, which is the built-in cloth in it. */
static inline bool path_is_cloth(const char *path) { return path_is_u3m(path) || path_ends(path, ".mtlx"); }

/* Returns true for a file that is a draft by its name. */
static inline bool path_is_draft(const char *path) {
    return path_ends(path, ".wif") || path_ends(path, ".dtx") || path_ends(path, ".wpo");
}

/* Returns true if the path is shown on a scene that the program brings: builtin:NAME, or a material. */
static inline bool path_is_on_builtin(const char *path) { return path_builtin(path) || path_is_cloth(path); }

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
