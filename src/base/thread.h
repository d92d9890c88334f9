/* thread.h - a loop over independent items on several cores, and work in a thread of its own */
#pragma once

/* Returns the number of processors that this process may use; at least 1. */
int thread_count(void);

/* Calls body(user, item, thread) for each item in [0, items), on up to `threads` threads (0: thread_count(); at most
 * WEFT_THREADS_MAX), including the caller's; returns when all are done. thread is in [0, threads). Items start in
 * order. */
void parallel_for(int threads, int items, void (*body)(void *user, int item, int thread), void *user);

/* Calls body(user) in a thread of its own, or in the caller's if none can be started; returns when it is done. */
void run_in_thread(void (*body)(void *user), void *user);

/* Lowers the priority of this thread, and of those that it starts, for the rest of their lives. */
void thread_step_back(void);
