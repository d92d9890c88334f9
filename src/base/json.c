#include "base/json.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/number.h"

/* The functions that jansson allocated with before: those of the C library or of the program. */
static json_malloc_t allocate;
static json_free_t release;

static _Thread_local bool was_refused;

static void *allocate_watched(size_t size) {
    void *memory = allocate(size);
    was_refused |= !memory;
    return memory;
}

static void watch(void) {
    json_get_alloc_funcs(&allocate, &release);
    json_set_alloc_funcs(allocate_watched, release);
}

json_t *json_parse(const char *text, size_t size, size_t flags, json_error_t *where, bool *starved) {
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, watch);
    was_refused = false;
    json_t *root = json_loadb(text, size, flags, where);
    *starved = was_refused;
    if (!was_refused) return root;
    json_decref(root);
    return NULL;
}

const char *json_but(const json_t *value, char text[JSON_SHOWN]) {
    char *words = value ? json_dumps(value, JSON_ENCODE_ANY | JSON_COMPACT) : NULL;
    text[0] = 0;
    if (words) snprintf(text, JSON_SHOWN, ", not %.36s%s", words, strlen(words) > 36 ? " ..." : "");
    free(words);
    return text;
}

json_t *json_of_float(float value) {
    char text[NUMBER_TEXT];
    return json_real(strtod(number_shortest(value, text), NULL));
}
