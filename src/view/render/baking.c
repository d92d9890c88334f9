#define _XOPEN_SOURCE 700 /* folder.h */
#include "view/render/baking.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/folder.h"
#include "view/files/paths.h"
#include "view/render/still.h"
#include "weft/match.h"
#include "weft/save.h"
#include "weft/weave.h"

struct Baking {
    char scene[STATE_PATH], path[STATE_PATH];
    Window *window;
    pthread_t thread;
    atomic_bool stopped, done;
    int materials; /* baked */
    double off;    /* the largest WeftBaked.fitted */
    WeftLosses losses;
    WeftResult result;
    WeftError error;
};

/* Stops a search, as a WeftProgress. */
static int heed(void *user, double fraction) {
    (void)fraction;
    return atomic_load(&((Baking *)user)->stopped);
}

/* Bakes one material beside the copy of the scene. */
static WeftResult bake_one(Baking *self, WeftScene *scene, int index) {
    char folder[STATE_PATH + 16];
    WeftBaked found = {0};
    snprintf(folder, sizeof folder, "%s.bake", self->scene);
    const WeftBaking baking = {.losses = &self->losses, .progress = heed, .user = self};
    WeftResult result = weft_scene_bake(scene, index, &baking, folder, &found, &self->error);
    (void)folder_remove_all(folder);
    self->materials += result == WEFT_OK;
    if (found.fitted > self->off) self->off = found.fitted;
    return result;
}

static WeftResult bake_all(Baking *self, WeftScene *scene) {
    WeftMaterial material;
    WeftResult result = WEFT_OK;
    for (int k = 0; k < weft_scene_info(scene).material_count && result == WEFT_OK; k++) {
        if (atomic_load(&self->stopped)) return WEFT_INTERRUPTED;
        result = weft_scene_material(scene, k, &material, &self->error);
        if (result == WEFT_OK && material.cloth) result = bake_one(self, scene, k);
    }
    return result;
}

static void *work(void *user) {
    Baking *self = user;
    WeftScene *scene;
    self->result = weft_scene_load(self->scene, &scene, NULL, &self->error);
    if (self->result == WEFT_OK) {
        self->result = bake_all(self, scene);
        if (self->result == WEFT_OK) self->result = weft_scene_save(scene, self->path, &self->error);
        weft_scene_free(scene);
    }
    still_discard(self->scene);
    atomic_store(&self->done, true);
    if (self->window) window_wake(self->window);
    return NULL;
}

Baking *baking_start(const char *scene, const char *path, Window *window) {
    Baking *self = calloc(1, sizeof *self);
    if (self) {
        snprintf(self->scene, sizeof self->scene, "%s", scene);
        snprintf(self->path, sizeof self->path, "%s", path);
        self->window = window;
        atomic_init(&self->stopped, false);
        atomic_init(&self->done, false);
        if (pthread_create(&self->thread, NULL, work, self) == 0) return self;
    }
    free(self);
    still_discard(scene);
    return NULL;
}

bool baking_done(Baking *self) { return atomic_load(&self->done); }

/* Writes what was made, and the first thing that it lacks. */
static void say_made(const Baking *self, char line[512]) {
    const WeftLoss *first = self->losses.items;
    int used = snprintf(line, 512, "wrote %.200s, %d woven material%s baked, %.1f %% off the threads from afar",
                        path_name(self->path), self->materials, self->materials == 1 ? "" : "s", 100.0 * self->off);
    if (!self->losses.count || used < 0 || used >= 512) return;
    used += snprintf(line + used, 512 - (size_t)used, "; %s: %.100s", first->what, first->why);
    if (self->losses.count > 1 && used < 512)
        snprintf(line + used, 512 - (size_t)used, "; and %d more losses", self->losses.count - 1);
}

bool baking_end(Baking *self, char line[512]) {
    atomic_store(&self->stopped, true);
    pthread_join(self->thread, NULL);
    const bool made = self->result == WEFT_OK;
    if (made)
        say_made(self, line);
    else if (self->result == WEFT_INTERRUPTED)
        snprintf(line, 512, "cancelled: %.400s was not written", self->path);
    else
        snprintf(line, 512, "%s", self->error.text[0] ? self->error.text : "out of memory");
    weft_losses_free(&self->losses);
    free(self);
    return made;
}
