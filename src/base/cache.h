/* cache.h - files in the user's cache, named by a hash of what they were made from */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "weft/result.h"

enum { CACHE_PATH_SIZE = 4096 };

/* The hash FNV-1a: Glenn Fowler, Landon Curt Noll, Kiem-Phong Vo, 1991. Start from CACHE_HASH. */
#define CACHE_HASH 0xcbf29ce484222325u
uint64_t cache_hash(uint64_t hash, const void *data, size_t size);

/* Sets path to $XDG_CACHE_HOME/weft/KEY.suffix, or ~/.cache/weft/KEY.suffix, by the XDG Base Directory Specification
 * (freedesktop.org, version 0.8, 2021), which ignores a path that is not absolute. Returns false if the user has no
 * cache folder or the path is too long. */
bool cache_path(char path[CACHE_PATH_SIZE], uint64_t key, const char *suffix);

/* Makes the folder of the cache, unless it exists. Returns false if it cannot be made or written. */
bool cache_folder_make(void);

/* Returns true if a plain file or a folder belongs to the user and nobody else may write to it, so that code in it
 * may be run. Returns false for links, pipes and devices, and for paths that do not exist. */
bool cache_is_private(const char *path);

/* Writes a file of the cache, complete or not at all, and makes its folders. A link, pipe or device of that name is
 * removed. A failure is a warning (WEFT_MESSAGE_CACHE_IGNORED). */
void cache_write(uint64_t key, const char *suffix, const void *data, size_t size, const WeftLog *log);

/* Writes numbers in this machine's byte order (cache_keep), and reads them back (cache_find). cache_find returns false
 * if the cache has no file of that key and size, or a damaged one, which is a warning too. Hash some numbers that are
 * wider than a byte into a key: another byte order then gives another key. */
void cache_keep(uint64_t key, const char *suffix, const void *data, size_t size, const WeftLog *log);
bool cache_find(uint64_t key, const char *suffix, void *data, size_t size, const WeftLog *log);

/* Keeps a file that others read by its path, such as a library, with a seal behind its bytes: a hash of the key and
 * of them. Returns true if it is now in the cache, for the user alone to write. */
bool cache_seal(uint64_t key, const char *suffix, const void *data, size_t size, const WeftLog *log);

/* Returns true if the cache has such a file, whole as it was kept, and private (cache_is_private). A damaged one is a
 * warning. */
bool cache_is_sealed(uint64_t key, const char *suffix, const WeftLog *log);

/* Warns that a file is not used, since its numbers are impossible. */
void cache_distrust(uint64_t key, const char *suffix, const WeftLog *log);

/* The bytes of a file of numbers: "weft-num", the key, the data, and the hash of all that. cache_pack fills `file`, which
 * must be CACHE_EXTRA bytes larger than the data. cache_unpack returns false and leaves the data unchanged if a file
 * is not of that key and size, or its hash is wrong. */
enum { CACHE_EXTRA = 8 + 8 + 8 };
void cache_pack(uint64_t key, const void *data, size_t size, void *file);
bool cache_unpack(const void *file, size_t file_size, uint64_t key, void *data, size_t size);
