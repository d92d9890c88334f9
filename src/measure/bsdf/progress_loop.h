/* progress_loop.h - a long parallel loop with progress, which its caller can stop */
#pragma once

#include <stdatomic.h>
#include <stdbool.h>

#include "weft/progress.h"

typedef struct LoopWatch {
    atomic_bool stopped; /* items that have not begun are skipped, and those that have end soon */
    atomic_llong done;   /* sum over the items, in millionths of one */
} LoopWatch;

/* The progress of one item. */
typedef struct ItemProgress {
    LoopWatch *watch; /* may be NULL */
    long long reported;
    double low, high; /* the part of the item whose fractions are reported; high 0: the whole */
} ItemProgress;

/* Goes on to the part `low` to `high` of the item. item_progress may be NULL. */
void progress_part(ItemProgress *item_progress, double low, double high);

/* Records that this fraction of the item's part is done, if that is more than was reported before. Returns false if
 * the item should end. item_progress may be NULL. */
bool progress_report(ItemProgress *item_progress, double fraction);

/* Runs parallel_for while the caller's thread calls progress (may be NULL) twenty times a second. Without a
 * second thread it is called between items. Returns false if it was stopped. */
bool watch_loop(LoopWatch *watch, int threads, int items, void (*body)(void *user, int item, int thread), void *user,
                WeftProgress progress, void *progress_user);
