/* watchman.h - files that somebody else writes: which of them is another one, and written to its end
 *
 * A file has changed once it is different from when it was last told of and has then stood still for a third
 * of a second: what is half written is waited for. */
#ifndef WEFT_VIEW_WATCHMAN_H
#define WEFT_VIEW_WATCHMAN_H

typedef struct Watchman Watchman;

/* NULL where memory is short. */
Watchman *watchman_start(void);
void watchman_stop(Watchman *watchman); /* may be NULL */

/* Watches no file any more. */
void watchman_forget(Watchman *watchman);

/* Watches a file, which need not be there, under a number. A folder has changed where a file in it has that
 * is not watched by itself; those that are, are named before it. Too many, or a lack of memory, goes
 * unnoticed. */
void watchman_watch(Watchman *watchman, const char *path, int id);

/* The number of a file that has changed; -1: none has. Looks at the disk at most four times a second.
 * seconds: of a steady clock. */
int watchman_look(Watchman *watchman, double seconds);

#endif
