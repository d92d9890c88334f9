/* steady_clock.h - monotonic time, and waiting by it; includes nothing of weft, so that programs may include it */
#pragma once

#include <pthread.h>
#include <time.h>

/* Returns the seconds since some moment in the past; the value never decreases. */
static inline double clock_now(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Returns the time in so many seconds, for pthread_cond_timedwait. */
static inline struct timespec clock_after(double seconds) {
    double until = clock_now() + seconds;
    time_t whole = (time_t)until;
    return (struct timespec){whole, (long)(1e9 * (until - (double)whole))};
}

/* Initialises a condition that is waited for by this clock. */
static inline void clock_condition(pthread_cond_t *condition) {
    pthread_condattr_t steady;
    pthread_condattr_init(&steady);
    pthread_condattr_setclock(&steady, CLOCK_MONOTONIC);
    pthread_cond_init(condition, &steady);
    pthread_condattr_destroy(&steady);
}
