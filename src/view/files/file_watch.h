/* file_watch.h - a watch on files that other programs write: reports those that have changed and are complete
 *
 * A file has changed once it differs from its last report and has then stayed the same for a third of a
 * second: so that half-written files are not read. */
#pragma once

typedef struct FileWatch FileWatch;

/* Starts to watch; the list is empty. NULL where memory is short. */
FileWatch *file_watch_start(void);
void file_watch_stop(FileWatch *file_watch); /* may be NULL */

/* Removes all files from the watch. */
void file_watch_clear(FileWatch *file_watch);

/* Watches a file, which need not exist, under a number. A folder has changed if a file in it has that
 * is not watched itself; those that are watched are reported before it. Files beyond the limits of the watch, or of
 * memory, are not watched. */
void file_watch_add(FileWatch *file_watch, const char *path, int id);

/* Returns the number of a file that has changed, or -1. Looks at the disk at most four times a second. seconds: of a
 * steady clock. */
int file_watch_poll(FileWatch *file_watch, double seconds);
