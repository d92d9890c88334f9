/* thread.h - a loop over independent items on several cores, and work in a thread of its own */
#ifndef WEFT_BASE_THREAD_H
#define WEFT_BASE_THREAD_H

/* The number of processors this process may use; at least 1. */
int thread_count(void);

/* Calls body(user, item, thread) once for each item in [0, items), on up to `threads` threads (0:
 * thread_count()), the caller's among them; returns when all are done. thread is in [0, threads). Items start
 * in order. More than WEFT_THREADS_MAX threads are not used. */
void parallel_for(int threads, int items, void (*body)(void *user, int item, int thread), void *user);

/* Calls body(user) in a thread of its own and returns when that is done; in the caller's where none can be
 * started. */
void run_in_thread(void (*body)(void *user), void *user);

/* From now on this thread, and those that it starts, take only what others leave of the processors. */
void thread_step_back(void);

#endif
