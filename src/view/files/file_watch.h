/* file_watch.h - a watch on files that other programs write: which have changed and are complete
 *
 * A file has changed once it differs from its last report and has then stayed the same for a third of a
 * second: what is half written is waited for. */
#ifndef WEFT_VIEW_FILE_WATCH_H
#define WEFT_VIEW_FILE_WATCH_H

typedef struct FileWatch FileWatch;

/* Starts to watch; the list is empty. NULL where memory is short. */
FileWatch *file_watch_start(void);
void file_watch_stop(FileWatch *file_watch); /* may be NULL */

/* Watches no file any more. */
void file_watch_clear(FileWatch *file_watch);

/* Watches a file, which need not be there, under a number. A folder has changed where a file in it has that
 * is not watched by itself; those that are, are named before it. Too many, or a lack of memory, goes
 * unnoticed. */
void file_watch_add(FileWatch *file_watch, const char *path, int id);

/* Returns the number of a file that has changed, or -1. Looks at the disk at most four times a second. seconds: of a
 * steady clock. */
int file_watch_poll(FileWatch *file_watch, double seconds);

#endif
