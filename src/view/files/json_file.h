/* json_file.h - small files of JSON in the user's folders: settings and sessions */
#pragma once

#include <stdbool.h>
#include <stddef.h>

#include <jansson.h>

/* Writes the path of `name` in the folder weft/ of $VARIABLE, or else of `fallback` in the home folder; make: the folders
 * are created. Returns false where there is no such place, or it is longer than size. */
bool json_file_place(const char *variable, const char *fallback, const char *name, bool make, char *path, size_t size);

/* Returns the JSON in a regular file of at most `most` bytes, owned; NULL where there is none. */
json_t *json_file_read(const char *path, long most);

/* Writes a file, complete or not at all: the earlier one stays on failure, which false reports. */
bool json_file_write(const char *path, const json_t *root);
