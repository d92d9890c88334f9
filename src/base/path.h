/* path.h - suffixes of file names */
#pragma once

#include <stdbool.h>
#include <string.h>
#include <strings.h>

/* Returns true if the path ends in that suffix, in any case, and has more before it. */
static inline bool path_ends(const char *path, const char *suffix) {
    size_t length = strlen(path), size = strlen(suffix);
    return length > size && strcasecmp(path + length - size, suffix) == 0;
}
