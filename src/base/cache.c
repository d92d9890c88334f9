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
    return lstat(path, &status) == 0 && (S_ISREG(status.st_mode) || S_ISDIR(status.st_mode)) &&
           status.st_uid == geteuid() && !(status.st_mode & (S_IWGRP | S_IWOTH));
}

/* Removes what stands at a path and is neither a plain file nor a folder. */
static void clear(const char *path) {
    struct stat status;
    if (lstat(path, &status) == 0 && !S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode)) unlink(path);
}

/* Writes a file in two pieces, and sets its path. Returns false after a warning. */
static bool write_pieces(uint64_t key, const char *suffix, const void *const data[2], const size_t size[2],
                         const WeftLog *log, char path[CACHE_PATH_SIZE]) {
    OutputFile file;
    if (!cache_path(path, key, suffix)) {
        warn(log, WEFT_MESSAGE_CACHE_IGNORED, "$HOME", "it is not an absolute path; set $XDG_CACHE_HOME");
        return false;
    }
    make_folders(path);
    clear(path);
    WeftError error;
    WeftResult result = output_open(&file, path, &error);
    if (result == WEFT_OK) {
        for (int k = 0; k < 2; k++)
            if (size[k]) fwrite(data[k], 1, size[k], file.stream);
        result = output_commit(&file, &error);
    }
    if (result == WEFT_OK) return true;
    const char *why = strstr(error.text, weft_message_text(error.message)); /* the path is told once */
    warn(log, WEFT_MESSAGE_CACHE_IGNORED, path, "it %s; the next start will be slower",
         why ? why : "cannot be written");
    return false;
}

void cache_write(uint64_t key, const char *suffix, const void *data, size_t size, const WeftLog *log) {
    char path[CACHE_PATH_SIZE];
    write_pieces(key, suffix, (const void *const[2]){data, NULL}, (const size_t[2]){size, 0}, log, path);
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

/* The seal behind the bytes of a sealed file. Loaders of libraries do not look at it. */
typedef struct Seal {
    char magic[8];
    uint64_t check;
} Seal;

static Seal seal_of(uint64_t key, const void *data, size_t size) {
    const uint64_t start = cache_hash(CACHE_HASH, &key, sizeof key);
    return (Seal){{'w', 'e', 'f', 't', '-', 'e', 'n', 'd'}, cache_hash(start, data, size)};
}

bool cache_seal(uint64_t key, const char *suffix, const void *data, size_t size, const WeftLog *log) {
    char path[CACHE_PATH_SIZE];
    const Seal seal = seal_of(key, data, size);
    return write_pieces(key, suffix, (const void *const[2]){data, &seal}, (const size_t[2]){size, sizeof seal}, log,
                        path) &&
           chmod(path, 0700) == 0;
}

bool cache_is_sealed(uint64_t key, const char *suffix, const WeftLog *log) {
    enum { SIZE_MOST = 1 << 28 };
    char path[CACHE_PATH_SIZE];
    FileBytes file;
    if (!cache_path(path, key, suffix) || !cache_is_private(path)) return false;
    if (file_read(path, SIZE_MOST, &file, NULL) != WEFT_OK) return false;
    bool whole = file.size >= sizeof(Seal);
    if (whole) {
        const Seal seal = seal_of(key, file.data, file.size - sizeof seal);
        whole = memcmp(file.data + file.size - sizeof seal, &seal, sizeof seal) == 0;
    }
    free(file.data);
    if (!whole) cache_distrust(key, suffix, log);
    return whole;
}

void cache_distrust(uint64_t key, const char *suffix, const WeftLog *log) {
    char path[CACHE_PATH_SIZE];
    if (cache_path(path, key, suffix)) warn(log, WEFT_MESSAGE_CACHE_IGNORED, path, "it is damaged");
}
