#define _GNU_SOURCE /* pthread_setattr_default_np */
#include "cli/console/call_stack.h"

#include <pthread.h>
#include <stddef.h>
#include <sys/resource.h>

enum { LEAST = 1 << 20, USUAL = 8 << 20 };

typedef struct StackCall {
    int (*run)(int count, char **arguments);
    int count, result;
    char **arguments;
} StackCall;

static void *call_run(void *user) {
    StackCall *call = user;
    call->result = call->run(call->count, call->arguments);
    return NULL;
}

int stack_run(int (*run)(int count, char **arguments), int count, char **arguments) {
    StackCall call = {.run = run, .count = count, .arguments = arguments};
    struct rlimit limit;
    pthread_attr_t attributes;
    pthread_t thread;
    if (getrlimit(RLIMIT_STACK, &limit) != 0 || limit.rlim_cur >= LEAST) return run(count, arguments);
    if (pthread_attr_init(&attributes) != 0) return run(count, arguments);
    pthread_attr_setstacksize(&attributes, USUAL);
    pthread_setattr_default_np(&attributes);
    pthread_attr_destroy(&attributes);
    if (pthread_create(&thread, NULL, call_run, &call) != 0) return run(count, arguments);
    pthread_join(thread, NULL);
    return call.result;
}
