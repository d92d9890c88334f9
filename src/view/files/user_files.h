/* user_files.h - files that belong to the user: materials of their own, and pictures in the cache */
#pragma once

#include <stdbool.h>
#include <stddef.h>

enum { USER_PATH = 1024 };

/* Writes the path of $XDG_DATA_HOME/weft/materials, or ~/.local/share/weft/materials. Returns false if the user has no
 * such place. make: makes the folder, unless it exists. */
bool user_materials(char folder[USER_PATH], bool make);

/* Writes the path of a file of $XDG_CACHE_HOME/weft, or ~/.cache/weft, and makes the folder. Returns false if the user
 * has no such place. */
bool user_cache(char path[USER_PATH], const char *name);

/* A material of the user's own, or what has its name. */
typedef struct OwnMaterial {
    char name[64]; /* of the file, without .json */
    char path[USER_PATH];
    unsigned long long stamp; /* path_stamp */
} OwnMaterial;

enum { OWN_MOST = 1000 };

/* Reads the materials of the user's folder, in alphabetical order. Returns a list of *count, NULL for none; release
 * with free. */
OwnMaterial *user_materials_list(int *count);

/* Reads a plain file of at most `most` bytes, and appends a zero. Returns NULL if it is none; release with free. */
char *user_file_read(const char *path, size_t most, size_t *size);
