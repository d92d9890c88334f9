/* cache.h - files in the user's cache, named by what they were made from */
#ifndef WEFT_BASE_CACHE_H
#define WEFT_BASE_CACHE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "weft/result.h"

enum { CACHE_PATH_SIZE = 4096 };

/* FNV-1a: Glenn Fowler, Landon Curt Noll, Kiem-Phong Vo, 1991. Start from CACHE_HASH. */
#define CACHE_HASH 0xcbf29ce484222325u
uint64_t cache_hash(uint64_t hash, const void *data, size_t size);

/* $XDG_CACHE_HOME/weft/KEY.suffix, or ~/.cache/weft/KEY.suffix, as the XDG Base Directory Specification has
 * it (freedesktop.org, version 0.8, 2021): a path that is not absolute does not count. False where the user
 * has none, or it is too long. */
bool cache_path(char path[CACHE_PATH_SIZE], uint64_t key, const char *suffix);

/* Makes the folder of the cache, where it is not there; false where there can be none. */
bool cache_folder_make(void);

/* Returns true if a file or folder belongs to the user and nobody else may write to it, so that code in it
 * may be run. Returns false for links and for paths that do not exist. */
bool cache_is_private(const char *path);

/* Writes a file of the cache, complete or not at all, and the folders it is in. What fails is a warning
 * (WEFT_MESSAGE_CACHE_IGNORED). */
void cache_write(uint64_t key, const char *suffix, const void *data, size_t size, const WeftLog *log);

/* Numbers as this machine has them: cache_keep writes them, cache_find reads them back. Returns false if the cache
 * has no file of that key and size, or a damaged one, which is a warning too. Hash the size of some numbers, not only
 * bytes, into a key: another machine's order of bytes is then another key. */
void cache_keep(uint64_t key, const char *suffix, const void *data, size_t size, const WeftLog *log);
bool cache_find(uint64_t key, const char *suffix, void *data, size_t size, const WeftLog *log);

/* Warns that a file is not used, for its numbers cannot be what they should be. */
void cache_distrust(uint64_t key, const char *suffix, const WeftLog *log);

/* The bytes of such a file: "weft-num", the key, the data, and the hash of all that. cache_pack fills `file`, which
 * has room for CACHE_EXTRA bytes more than the data; cache_unpack leaves the data alone and returns false if a file
 * is not of that key and size, or its hash is wrong. */
enum { CACHE_EXTRA = 8 + 8 + 8 };
void cache_pack(uint64_t key, const void *data, size_t size, void *file);
bool cache_unpack(const void *file, size_t file_size, uint64_t key, void *data, size_t size);

#endif
