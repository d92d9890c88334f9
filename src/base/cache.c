#include "base/cache.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/fail.h"
#include "base/file.h"
#include "base/memory.h"

uint64_t cache_hash(uint64_t hash, const void *data, size_t size) {
    const unsigned char *bytes = data;
    for (size_t k = 0; k < size; k++) hash = (hash ^ bytes[k]) * 0x100000001b3u;
    return hash;
}

static bool cache_folder(char *folder, size_t size) {
    const char *cache = getenv("XDG_CACHE_HOME"), *home = getenv("HOME");
    if (cache && cache[0] == '/') return (size_t)snprintf(folder, size, "%s/weft", cache) < size;
    return home && home[0] == '/' && (size_t)snprintf(folder, size, "%s/.cache/weft", home) < size;
}

bool cache_path(char path[CACHE_PATH_SIZE], uint64_t key, const char *suffix) {
    char folder[CACHE_PATH_SIZE - 64];
    if (!cache_folder(folder, sizeof folder)) return false;
    snprintf(path, CACHE_PATH_SIZE, "%s/%016llx.%s", folder, (unsigned long long)key, suffix);
    return true;
}

/* Makes a folder and its parents. A failure is reported later, when the file in it is opened. */
static void make_folders(char *path) {
    for (char *c = path + 1; *c; c++)
        if (*c == '/') {
            *c = 0;
            mkdir(path, 0700);
            *c = '/';
        }
}

bool cache_folder_make(void) {
    char folder[CACHE_PATH_SIZE];
    if (!cache_path(folder, 0, "")) return false;
    make_folders(folder);
    *strrchr(folder, '/') = 0;
    return access(folder, W_OK | X_OK) == 0;
}

bool cache_is_private(const char *path) {
    struct stat status;
    return lstat(path, &status) == 0 && !S_ISLNK(status.st_mode) && status.st_uid == geteuid() &&
           !(status.st_mode & (S_IWGRP | S_IWOTH));
}

void cache_write(uint64_t key, const char *suffix, const void *data, size_t size, const WeftLog *log) {
    char path[CACHE_PATH_SIZE];
    OutputFile file;
    if (!cache_path(path, key, suffix)) {
        warn(log, WEFT_MESSAGE_CACHE_IGNORED, "$HOME", "it is not an absolute path; set $XDG_CACHE_HOME");
        return;
    }
    make_folders(path);
    bool written = output_open(&file, path, NULL) == WEFT_OK;
    if (written && fwrite(data, 1, size, file.stream) != size) {
        output_discard(&file);
        written = false;
    } else if (written) {
        written = output_commit(&file, NULL) == WEFT_OK;
    }
    if (!written) warn(log, WEFT_MESSAGE_CACHE_IGNORED, path, "it cannot be written; the next start will be slower");
}

/* The beginning of a file; the data and a hash of both follow. */
typedef struct Head {
    char magic[8];
    uint64_t key;
} Head;

static Head head_of(uint64_t key) { return (Head){{'w', 'e', 'f', 't', '-', 'n', 'u', 'm'}, key}; }

void cache_pack(uint64_t key, const void *data, size_t size, void *file) {
    const Head head = head_of(key);
    unsigned char *bytes = file;
    memcpy(bytes, &head, sizeof head);
    memcpy(bytes + sizeof head, data, size);
    uint64_t check = cache_hash(CACHE_HASH, bytes, sizeof head + size);
    memcpy(bytes + sizeof head + size, &check, sizeof check);
}

bool cache_unpack(const void *file, size_t file_size, uint64_t key, void *data, size_t size) {
    const Head head = head_of(key);
    const unsigned char *bytes = file;
    if (file_size < CACHE_EXTRA || file_size - CACHE_EXTRA != size || memcmp(bytes, &head, sizeof head) != 0)
        return false;
    uint64_t check = cache_hash(CACHE_HASH, bytes, sizeof head + size);
    if (memcmp(bytes + sizeof head + size, &check, sizeof check) != 0) return false;
    memcpy(data, bytes + sizeof head, size);
    return true;
}

void cache_keep(uint64_t key, const char *suffix, const void *data, size_t size, const WeftLog *log) {
    unsigned char *file = size < SIZE_MAX / 2 ? alloc_array(size + CACHE_EXTRA, 1) : NULL;
    if (!file) return;
    cache_pack(key, data, size, file);
    cache_write(key, suffix, file, size + CACHE_EXTRA, log);
    free(file);
}

bool cache_find(uint64_t key, const char *suffix, void *data, size_t size, const WeftLog *log) {
    char path[CACHE_PATH_SIZE];
    FileBytes file;
    WeftError error;
    struct stat status;
    if (!cache_path(path, key, suffix) || stat(path, &status) != 0) return false;
    if (file_read(path, size + CACHE_EXTRA, &file, &error) != WEFT_OK) {
        warn(log, WEFT_MESSAGE_CACHE_IGNORED, path, "%s", weft_message_text(error.message));
        return false;
    }
    bool good = cache_unpack(file.data, file.size, key, data, size);
    free(file.data);
    if (!good) cache_distrust(key, suffix, log);
    return good;
}

void cache_distrust(uint64_t key, const char *suffix, const WeftLog *log) {
    char path[CACHE_PATH_SIZE];
    if (cache_path(path, key, suffix)) warn(log, WEFT_MESSAGE_CACHE_IGNORED, path, "it is damaged");
}
