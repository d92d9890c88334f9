#define _POSIX_C_SOURCE 200809L
#include "view/files/file_watch.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "view/files/paths.h"

enum { FILES = 1024 };

typedef struct File {
    char *path;
    int id;
    unsigned long long reported, seen; /* stamps: as last reported, and as last seen */
    double since;                      /* when the stamp was last seen to change */
} File;

struct FileWatch {
    File files[FILES];
    int count;
    double looked;
};

FileWatch *file_watch_start(void) { return calloc(1, sizeof(FileWatch)); }

void file_watch_clear(FileWatch *self) {
    for (int k = 0; k < self->count; k++) free(self->files[k].path);
    self->count = 0;
}

void file_watch_stop(FileWatch *self) {
    if (self) file_watch_clear(self);
    free(self);
}

static bool is_watched(const FileWatch *self, const char *path) {
    for (int k = 0; k < self->count; k++)
        if (strcmp(self->files[k].path, path) == 0) return true;
    return false;
}

/* Returns the stamp of a file; of a folder the sum over its files that are not watched themselves, in any
 * order. */
static unsigned long long stamp_of(const FileWatch *self, const char *path) {
    size_t length = strlen(path);
    const char *slash = length && path[length - 1] == '/' ? "" : "/";
    DIR *folder = path_kind(path) == PATH_FOLDER ? opendir(path) : NULL;
    if (!folder) return path_stamp(path);
    unsigned long long sum = 1;
    for (const struct dirent *entry; (entry = readdir(folder));) {
        char file[2048];
        if (entry->d_name[0] == '.') continue;
        int size = snprintf(file, sizeof file, "%s%s%s", path, slash, entry->d_name);
        if (size < (int)sizeof file && !is_watched(self, file)) sum += path_stamp(file);
    }
    closedir(folder);
    return sum;
}

void file_watch_add(FileWatch *self, const char *path, int id) {
    if (self->count == FILES) return;
    unsigned long long stamp = stamp_of(self, path);
    char *copy = strdup(path);
    if (copy) self->files[self->count++] = (File){copy, id, stamp, stamp, 0.0};
}

int file_watch_poll(FileWatch *self, double seconds) {
    if (seconds - self->looked < 0.25) return -1;
    self->looked = seconds;
    for (int k = 0; k < self->count; k++) {
        File *file = &self->files[k];
        unsigned long long stamp = stamp_of(self, file->path);
        if (stamp != file->seen) {
            file->seen = stamp;
            file->since = seconds;
        }
        /* A missing file may return soon: editors write another file and rename it. */
        if (!stamp || stamp == file->reported || seconds - file->since < 0.3) continue;
        file->reported = stamp;
        self->looked = 0.0; /* others may have changed as well */
        return file->id;
    }
    return -1;
}
