#define _POSIX_C_SOURCE 200809L
#include "view/files/user_files.h"

#include <dirent.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/path.h"
#include "view/files/json_file.h"
#include "view/files/paths.h"

bool user_materials(char folder[USER_PATH], bool make) {
    if (!json_file_place("XDG_DATA_HOME", ".local/share", "materials/", make, folder, USER_PATH)) return false;
    folder[strlen(folder) - 1] = '\0';
    return true;
}

bool user_cache(char path[USER_PATH], const char *name) {
    return json_file_place("XDG_CACHE_HOME", ".cache", name, true, path, USER_PATH);
}

static int by_name(const void *a, const void *b) {
    return strcmp(((const OwnMaterial *)a)->name, ((const OwnMaterial *)b)->name);
}

OwnMaterial *user_materials_list(int *count) {
    char folder[USER_PATH];
    *count = 0;
    DIR *dir = user_materials(folder, false) ? opendir(folder) : NULL;
    OwnMaterial *list = dir ? calloc(OWN_MOST, sizeof *list) : NULL;
    for (const struct dirent *d; list && *count < OWN_MOST && (d = readdir(dir));) {
        OwnMaterial *own = &list[*count];
        if (d->d_name[0] == '.' || !path_ends(d->d_name, ".json")) continue;
        const int used = snprintf(own->path, sizeof own->path, "%s/%s", folder, d->d_name);
        if (used < 0 || used >= USER_PATH) continue;
        path_stem(own->path, own->name, sizeof own->name);
        own->stamp = path_stamp(own->path);
        ++*count;
    }
    if (dir) closedir(dir);
    if (list) qsort(list, (size_t)*count, sizeof *list, by_name);
    if (*count) return list;
    free(list);
    return NULL;
}

char *user_file_read(const char *path, size_t most, size_t *size) {
    struct stat s;
    const int file = open(path, O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC); /* a pipe would block */
    const bool plain = file >= 0 && fstat(file, &s) == 0 && S_ISREG(s.st_mode) && (unsigned long long)s.st_size <= most;
    char *bytes = plain ? malloc((size_t)s.st_size + 1) : NULL;
    const ssize_t got = bytes ? read(file, bytes, (size_t)s.st_size) : -1;
    if (file >= 0) close(file);
    if (got < 0) {
        free(bytes);
        return NULL;
    }
    *size = (size_t)got;
    bytes[got] = '\0';
    return bytes;
}
