/* thread.h - a loop over independent items on several cores */
#ifndef WEFT_BASE_THREAD_H
#define WEFT_BASE_THREAD_H

/* The number of processors this process may use; at least 1. */
int thread_count(void);

/* Calls body(user, item, thread) once for each item in [0, items), on up to `threads` threads (0:
 * thread_count()), the caller's among them; returns when all are done. thread is in [0, threads). Items start
 * in order. More than WEFT_THREADS_MAX threads are not used. */
void parallel_for(int threads, int items, void (*body)(void *user, int item, int thread), void *user);

#endif
