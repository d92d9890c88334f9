/* folder.h - a folder that is made, or removed with all in it
 *
 * A file that includes it defines _XOPEN_SOURCE as 700 before its first include, for nftw. */
#pragma once

#include <errno.h>
#include <ftw.h>
#include <stdbool.h>
#include <stdio.h>
#include <sys/stat.h>
#include <unistd.h>

/* Makes a folder unless it is there. Returns 1 if it was made, 0 if it was there, and -1, with the reason in errno, if there is
 * none: EEXIST where a file has the name. */
static inline int folder_create(const char *path) {
    struct stat status;
    if (mkdir(path, 0777) == 0) return 1;
    if (errno != EEXIST || stat(path, &status) != 0) return -1;
    if (S_ISDIR(status.st_mode)) return 0;
    errno = EEXIST;
    return -1;
}

static inline int folder_entry_remove(const char *path, const struct stat *status, int kind, struct FTW *at) {
    (void)status, (void)kind, (void)at;
    (void)remove(path);
    return 0;
}

/* Removes a folder and all in it, and follows no link. Returns false if something of it is left. */
static inline bool folder_remove_all(const char *path) {
    enum { OPEN_MOST = 8 };
    (void)nftw(path, folder_entry_remove, OPEN_MOST, FTW_DEPTH | FTW_PHYS);
    return access(path, F_OK) != 0;
}
