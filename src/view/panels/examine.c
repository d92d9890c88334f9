#define _POSIX_C_SOURCE 200809L
#include "view/panels/examine.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

struct Examination {
    Window *window;
    char *path;
    pthread_t thread;
    atomic_bool done, stop;
    WeftDoctor *doctor;
    WeftError error;
};

static int on_progress(void *user, double fraction) {
    Examination *self = user;
    return atomic_load(&self->stop);
}

static void *work(void *user) {
    Examination *self = user;
    weft_doctor_open_watched(self->path, on_progress, self, &self->doctor, NULL, &self->error);
    atomic_store(&self->done, true);
    window_wake(self->window);
    return NULL;
}

static void drop(Examination *self) {
    weft_doctor_close(self->doctor);
    free(self->path);
    free(self);
}

Examination *examination_start(Window *window, const char *path) {
    Examination *self = calloc(1, sizeof *self);
    if (!self) return NULL;
    self->window = window;
    self->path = strdup(path);
    atomic_init(&self->done, false);
    atomic_init(&self->stop, false);
    if (self->path && pthread_create(&self->thread, NULL, work, self) == 0) return self;
    drop(self);
    return NULL;
}

bool examination_done(Examination *self) { return atomic_load(&self->done); }

const WeftDoctor *examination_doctor(const Examination *self) { return self->doctor; }

const char *examination_failure(const Examination *self) { return self->error.text; }

void examination_free(Examination *self) {
    if (!self) return;
    atomic_store(&self->stop, true);
    pthread_join(self->thread, NULL);
    drop(self);
}
