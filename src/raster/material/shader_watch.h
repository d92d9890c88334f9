/* shader_watch.h - finds changed shader files in a folder
 *
 * DOES NOT: notice the second of two changes of a file, with a scan between them, within one tick of the file system's
 * clock and without a change of size. */
#pragma once

#include "base/memory.h"

/* The files that the last scan found. Zero-initialise: none; release with watch_free. */
typedef struct FolderWatch {
    Arena arena;
    struct WatchedFile *files; /* sorted by path */
    int count;
} FolderWatch;

/* Scans the files .h and .glsl in the folder and in those below it, down to WATCH_DEPTH and at most WATCH_FILES,
 * without names that start with a dot. Returns the number of files that were made, changed or removed since the last
 * scan; 0 if memory is short, and this scan is then dropped. A missing folder counts as empty. */
int watch_poll(FolderWatch *watch, const char *folder);

enum { WATCH_DEPTH = 8, WATCH_FILES = 1024 };

void watch_free(FolderWatch *watch);
