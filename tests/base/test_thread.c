/* parallel_for does every item once, whatever the number of threads; run_in_thread is past when it returns */
#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "base/thread.h"

enum { ITEMS = 5000 };

typedef struct Work {
    atomic_int done[ITEMS];
    atomic_int highest_thread;
} Work;

static void body(void *user, int item, int thread) {
    Work *work = user;
    atomic_fetch_add(&work->done[item], 1);
    int seen = atomic_load(&work->highest_thread);
    while (thread > seen && !atomic_compare_exchange_weak(&work->highest_thread, &seen, thread)) {
    }
}

static void parallel_loop_does_every_item_once(void **state) {
    (void)state;
    static const int threads[] = {1, 2, 7, 64, 1000};
    for (int k = 0; k < 5; k++) {
        static Work work;
        memset(&work, 0, sizeof work);
        parallel_for(threads[k], ITEMS, body, &work);
        for (int n = 0; n < ITEMS; n++) assert_int_equal(atomic_load(&work.done[n]), 1);
        assert_true(atomic_load(&work.highest_thread) < threads[k]);
    }
}

static void parallel_loop_of_no_items_or_threads_ends(void **state) {
    (void)state;
    static Work work;
    memset(&work, 0, sizeof work);
    parallel_for(4, 0, body, &work);
    assert_int_equal(atomic_load(&work.done[0]), 0);
    parallel_for(4, 1, body, &work);
    parallel_for(0, 2, body, &work);
    parallel_for(-3, 2, body, &work);
    assert_int_equal(atomic_load(&work.done[0]), 3);
    assert_int_equal(atomic_load(&work.done[1]), 2);
    assert_int_equal(atomic_load(&work.done[2]), 0);
    assert_true(thread_count() >= 1);
}

static void inner_body(void *user, int item, int thread) {
    (void)thread;
    Work *work = user;
    atomic_fetch_add(&work->done[item], 1);
}

static void outer_body(void *user, int item, int thread) {
    (void)item, (void)thread;
    parallel_for(3, 100, inner_body, user);
}

static void nested_parallel_loops_do_every_item(void **state) {
    (void)state;
    static Work work;
    memset(&work, 0, sizeof work);
    parallel_for(3, 10, outer_body, &work);
    for (int n = 0; n < 100; n++) assert_int_equal(atomic_load(&work.done[n]), 10);
}

static void note_thread(void *user) { *(pthread_t *)user = pthread_self(); }

static void background_work_runs_in_another_thread(void **state) {
    (void)state;
    pthread_t thread = pthread_self();
    run_in_thread(note_thread, &thread);
    assert_false(pthread_equal(thread, pthread_self()));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(parallel_loop_does_every_item_once),
        cmocka_unit_test(parallel_loop_of_no_items_or_threads_ends),
        cmocka_unit_test(nested_parallel_loops_do_every_item),
        cmocka_unit_test(background_work_runs_in_another_thread),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
