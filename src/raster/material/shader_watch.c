#define _POSIX_C_SOURCE 200809L
#include "raster/material/shader_watch.h"

#include <dirent.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

typedef struct WatchedFile {
    const char *path;
    struct timespec time; /* of its last change */
    off_t size;
    ino_t number; /* differs if another file has replaced it */
} WatchedFile;

/* A scan in progress. */
typedef struct FolderScan {
    FolderWatch seen;
    int entries; /* of all folders so far */
    bool failed;
} FolderScan;

static bool is_text(const char *name) {
    const char *dot = strrchr(name, '.');
    return dot && (strcmp(dot, ".h") == 0 || strcmp(dot, ".glsl") == 0);
}

static void add(FolderScan *look, const char *path, const struct stat *status) {
    FolderWatch *seen = &look->seen;
    if (seen->count == WATCH_FILES) return;
    const char *copy = arena_text(&seen->arena, path);
    look->failed |= !copy;
    if (copy) seen->files[seen->count++] = (WatchedFile){copy, status->st_mtim, status->st_size, status->st_ino};
}

/* Adds the files of a folder. Links to folders are followed; a circle of them ends by depth or number of entries. */
static void look_into(FolderScan *look, const char *folder, int depth) {
    char path[1024];
    struct stat status;
    DIR *stream = opendir(folder);
    if (!stream) return;
    for (struct dirent *entry; !look->failed && (entry = readdir(stream));) {
        const char *name = entry->d_name;
        if (name[0] == '.' || look->entries == 4 * WATCH_FILES) continue;
        look->entries++;
        if ((size_t)snprintf(path, sizeof path, "%s/%s", folder, name) >= sizeof path) continue;
        if (stat(path, &status) != 0) continue;
        if (S_ISDIR(status.st_mode) && depth < WATCH_DEPTH) look_into(look, path, depth + 1);
        if (S_ISREG(status.st_mode) && is_text(name)) add(look, path, &status);
    }
    closedir(stream);
}

static int by_path(const void *a, const void *b) {
    return strcmp(((const WatchedFile *)a)->path, ((const WatchedFile *)b)->path);
}

static bool is_same(const WatchedFile *a, const WatchedFile *b) {
    return a->time.tv_sec == b->time.tv_sec && a->time.tv_nsec == b->time.tv_nsec && a->size == b->size &&
           a->number == b->number;
}

/* Returns the number of files that are in only one of two sorted lists, or differ. */
static int count_changes(const FolderWatch *a, const FolderWatch *b) {
    int changes = 0;
    for (int i = 0, j = 0; i < a->count || j < b->count;) {
        int order = i == a->count ? 1 : j == b->count ? -1 : by_path(&a->files[i], &b->files[j]);
        changes += order != 0 || !is_same(&a->files[i], &b->files[j]);
        i += order <= 0;
        j += order >= 0;
    }
    return changes;
}

int watch_poll(FolderWatch *watch, const char *folder) {
    FolderScan look = {0};
    look.seen.files = arena_array(&look.seen.arena, WATCH_FILES, sizeof *look.seen.files);
    if (!look.seen.files) return 0;
    look_into(&look, folder, 0);
    if (look.failed) {
        watch_free(&look.seen);
        return 0;
    }
    qsort(look.seen.files, (size_t)look.seen.count, sizeof *look.seen.files, by_path);
    int changes = count_changes(watch, &look.seen);
    watch_free(watch);
    *watch = look.seen;
    return changes;
}

void watch_free(FolderWatch *watch) {
    arena_free(&watch->arena);
    *watch = (FolderWatch){0};
}
