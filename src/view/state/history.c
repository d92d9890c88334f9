#include "view/state/history.h"

#include <string.h>

static void forget(History *self, int from) {
    for (int k = from; k < self->count; k++) scene_state_free(&self->steps[k]);
    self->count = from;
}

void history_keep(History *self, const SceneState *before) {
    if (self->open) return;
    self->open = true;
    forget(self, self->now);
    if (self->count == HISTORY_STEPS) {
        scene_state_free(&self->steps[0]);
        memmove(self->steps, self->steps + 1, (HISTORY_STEPS - 1) * sizeof *self->steps);
        self->count = --self->now;
    }
    if (scene_state_copy(&self->steps[self->count], before)) self->now = ++self->count;
}

void history_close(History *self) { self->open = false; }

static void exchange(SceneState *a, SceneState *b) {
    SceneState kept = *a;
    *a = *b;
    *b = kept;
}

bool history_undo(History *self, SceneState *state) {
    self->open = false;
    if (!self->now) return false;
    exchange(&self->steps[--self->now], state);
    return true;
}

bool history_redo(History *self, SceneState *state) {
    self->open = false;
    if (self->now == self->count) return false;
    exchange(&self->steps[self->now++], state);
    return true;
}

void history_free(History *self) {
    forget(self, 0);
    *self = (History){0};
}
