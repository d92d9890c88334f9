#define _GNU_SOURCE
#include "base/thread.h"

#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>
#include <sys/resource.h>
#include <unistd.h>

#include "weft/progress.h"

int thread_count(void) {
    cpu_set_t set;
    if (sched_getaffinity(0, sizeof set, &set) != 0) return 1;
    int count = CPU_COUNT(&set);
    return count < 1 ? 1 : count > WEFT_THREADS_MAX ? WEFT_THREADS_MAX : count;
}

typedef struct ThreadLoop {
    void (*body)(void *, int, int);
    void *user;
    atomic_int next;
    int items;
} ThreadLoop;

typedef struct Worker {
    ThreadLoop *loop;
    int thread;
    pthread_t handle;
} Worker;

static void *work(void *argument) {
    Worker *worker = argument;
    ThreadLoop *loop = worker->loop;
    for (int item; (item = atomic_fetch_add(&loop->next, 1)) < loop->items;)
        loop->body(loop->user, item, worker->thread);
    return NULL;
}

void parallel_for(int threads, int items, void (*body)(void *user, int item, int thread), void *user) {
    if (threads <= 0) threads = thread_count();
    if (threads > WEFT_THREADS_MAX) threads = WEFT_THREADS_MAX;
    if (threads > items) threads = items;
    ThreadLoop loop = {.body = body, .user = user, .items = items};
    Worker workers[WEFT_THREADS_MAX];
    int started = 0; /* if a thread cannot start, the others take its items */
    for (int t = 1; t < threads; t++) {
        workers[t] = (Worker){.loop = &loop, .thread = t};
        if (pthread_create(&workers[t].handle, NULL, work, &workers[t]) != 0) break;
        started = t;
    }
    workers[0] = (Worker){.loop = &loop};
    work(&workers[0]);
    for (int t = 1; t <= started; t++) pthread_join(workers[t].handle, NULL);
}

typedef struct ThreadCall {
    void (*body)(void *);
    void *user;
} ThreadCall;

static void *run_call(void *argument) {
    const ThreadCall *call = argument;
    call->body(call->user);
    return NULL;
}

void thread_step_back(void) { setpriority(PRIO_PROCESS, (id_t)gettid(), 10); } /* of the thread, in Linux */

void run_in_thread(void (*body)(void *user), void *user) {
    ThreadCall call = {body, user};
    pthread_t thread;
    if (pthread_create(&thread, NULL, run_call, &call) == 0)
        pthread_join(thread, NULL);
    else
        body(user);
}
