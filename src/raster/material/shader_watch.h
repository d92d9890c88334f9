/* shader_watch.h - a watch on the shader text in a folder
 *
 * DOES NOT: notice a file that changed twice within one tick of the file system's clock, between which it was
 * looked at, and kept its size. */
#ifndef WEFT_RASTER_SHADER_WATCH_H
#define WEFT_RASTER_SHADER_WATCH_H

#include "base/memory.h"

/* The files that the last scan found. Zero-initialise: none; release with watch_free. */
typedef struct FolderWatch {
    Arena arena;
    struct WatchedFile *files; /* sorted by path */
    int count;
} FolderWatch;

/* Looks at the files .h and .glsl in the folder and in those below it, down to WATCH_DEPTH and as many as
 * WATCH_FILES, but not where a name starts with a dot. Returns how many were made, changed or removed since
 * the last look; 0 where memory is short, and then this look counts for nothing. A folder that is not there
 * is empty. */
int watch_poll(FolderWatch *watch, const char *folder);

enum { WATCH_DEPTH = 8, WATCH_FILES = 1024 };

void watch_free(FolderWatch *watch);

#endif
