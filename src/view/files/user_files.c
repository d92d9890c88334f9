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
#include "view/files/paths.h"

/* Writes VARIABLE/weft, or ~/otherwise/weft. Returns false if there is no such place. */
static bool folder_of(char folder[USER_PATH], const char *variable, const char *otherwise) {
    const char *set = getenv(variable), *home = getenv("HOME");
    int used = -1;
    if (set && set[0] == '/')
        used = snprintf(folder, USER_PATH, "%s/weft", set);
    else if (home && home[0] == '/')
        used = snprintf(folder, USER_PATH, "%s/%s/weft", home, otherwise);
    return used > 0 && used < USER_PATH - 300;
}

/* Makes a folder and its parents. */
static void make_folders(const char *folder) {
    char path[USER_PATH];
    snprintf(path, sizeof path, "%s", folder);
    for (char *p = path + 1; *p; p++) {
        if (*p != '/') continue;
        *p = '\0';
        mkdir(path, 0755);
        *p = '/';
    }
    mkdir(path, 0755);
}

bool user_materials(char folder[USER_PATH], bool make) {
    if (!folder_of(folder, "XDG_DATA_HOME", ".local/share")) return false;
    strcat(folder, "/materials");
    if (make) make_folders(folder);
    return true;
}

bool user_cache(char path[USER_PATH], const char *name) {
    if (!folder_of(path, "XDG_CACHE_HOME", ".cache")) return false;
    make_folders(path);
    const size_t used = strlen(path);
    snprintf(path + used, USER_PATH - used, "/%s", name);
    return true;
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
