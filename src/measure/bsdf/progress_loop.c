#include "measure/bsdf/progress_loop.h"

#include <errno.h>
#include <math.h>
#include <pthread.h>

#include "base/steady_clock.h"
#include "base/thread.h"

enum { WHOLE = 1000000 };
static const double pause = 0.05;

void progress_part(ItemProgress *item_progress, double low, double high) {
    if (!item_progress) return;
    item_progress->low = low;
    item_progress->high = high;
}

bool progress_report(ItemProgress *item_progress, double fraction) {
    if (!item_progress || !item_progress->watch) return true;
    const double within = fmin(fmax(fraction, 0.0), 1.0), high = item_progress->high > 0.0 ? item_progress->high : 1.0;
    const long long now = (long long)((item_progress->low + (high - item_progress->low) * within) * WHOLE);
    if (now > item_progress->reported) {
        atomic_fetch_add(&item_progress->watch->done, now - item_progress->reported);
        item_progress->reported = now;
    }
    return !atomic_load(&item_progress->watch->stopped);
}

/* The loop, on threads of its own. */
typedef struct LoopRun {
    LoopWatch *watch;
    int threads, items;
    void (*body)(void *, int, int);
    void *user;
    WeftProgress progress;
    void *progress_user;
    pthread_mutex_t lock;
    pthread_cond_t ended;
    bool over;
} LoopRun;

static void report(LoopRun *run) {
    double fraction = (double)atomic_load(&run->watch->done) / ((double)WHOLE * run->items);
    if (run->progress(run->progress_user, fmin(fraction, 1.0)) != 0) atomic_store(&run->watch->stopped, true);
}

static void *run_loop(void *argument) {
    LoopRun *run = argument;
    parallel_for(run->threads, run->items, run->body, run->user);
    pthread_mutex_lock(&run->lock);
    run->over = true;
    pthread_cond_signal(&run->ended);
    pthread_mutex_unlock(&run->lock);
    return NULL;
}

static bool wait_for_end(LoopRun *run) {
    struct timespec until = clock_after(pause);
    pthread_mutex_lock(&run->lock);
    for (int code = 0; !run->over && code != ETIMEDOUT;) code = pthread_cond_timedwait(&run->ended, &run->lock, &until);
    bool over = run->over;
    pthread_mutex_unlock(&run->lock);
    return over;
}

static void watched(LoopRun *run) {
    pthread_t thread;
    pthread_mutex_init(&run->lock, NULL);
    clock_condition(&run->ended);
    if (pthread_create(&thread, NULL, run_loop, run) == 0) {
        while (!wait_for_end(run)) report(run);
        pthread_join(thread, NULL);
    } else {
        for (int item = 0; item < run->items; item++) {
            run->body(run->user, item, 0);
            report(run);
        }
    }
    pthread_cond_destroy(&run->ended);
    pthread_mutex_destroy(&run->lock);
}

bool watch_loop(LoopWatch *watch, int threads, int items, void (*body)(void *user, int item, int thread), void *user,
                WeftProgress progress, void *progress_user) {
    LoopRun run = {.watch = watch,
                   .threads = threads,
                   .items = items,
                   .body = body,
                   .user = user,
                   .progress = progress,
                   .progress_user = progress_user};
    atomic_store(&watch->stopped, false);
    atomic_store(&watch->done, 0);
    if (progress)
        watched(&run);
    else
        parallel_for(threads, items, body, user);
    return !atomic_load(&watch->stopped);
}
