/* folder.h - a folder with all in it, removed
 *
 * A file that includes it defines _XOPEN_SOURCE as 700 before its first include, for nftw. */
#pragma once

#include <ftw.h>
#include <stdbool.h>
#include <stdio.h>
#include <sys/stat.h>
#include <unistd.h>

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
