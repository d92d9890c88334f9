#define _GNU_SOURCE /* setpriority of one thread */
#include "view/render/thumbs.h"

#include <pthread.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

#include "view/files/user_files.h"
#include "weft/weft.h"

enum { FILE_MOST = 1 << 20 };

typedef enum ThumbStage { IDLE, WANTED, IN_WORK, MADE, TAKEN } ThumbStage;

typedef struct Entry {
    char *path;
    ThumbStage stage;
    Thumb thumb;
} Entry;

struct Thumbs {
    Window *window;
    Entry *entries;
    int count;
    pthread_t thread;
    pthread_mutex_t lock; /* of the stages and pictures, and of what follows */
    pthread_cond_t change;
    bool stopped;
};

/* Continues the hash FNV-1a over bytes: Glenn Fowler, Landon Curt Noll, Kiem-Phong Vo, 1991. */
static uint64_t hashed(uint64_t hash, const char *bytes, size_t size) {
    for (size_t k = 0; k < size; k++) hash = (hash ^ (unsigned char)bytes[k]) * 0x100000001b3u;
    return hash;
}

/* Returns the text of a preset; NULL if the path is a file's. */
static const char *preset_text(const char *path) {
    if (strncmp(path, "preset:", 7) != 0) return NULL;
    for (int k = 0; weft_preset_name(k); k++)
        if (strcmp(weft_preset_name(k), path + 7) == 0) return weft_preset_text(k);
    return NULL;
}

/* Writes the place of a picture in the cache. Returns false if the material cannot be read, or there is no cache. */
static bool place(const char *path, char out[USER_PATH]) {
    const char *preset = preset_text(path);
    char about[96], name[32], *file = NULL;
    size_t size = preset ? strlen(preset) : 0;
    if (!preset && !(file = user_file_read(path, FILE_MOST, &size))) return false;
    snprintf(about, sizeof about, "thumb %d %d %s", THUMB_SIDE, THUMB_SAMPLES, weft_version());
    uint64_t hash = hashed(0xcbf29ce484222325u, about, strlen(about) + 1);
    hash = hashed(hash, preset ? preset : file, size + 1);
    if (file) hash = hashed(hash, path, strlen(path)); /* a file's textures are found beside it */
    free(file);
    snprintf(name, sizeof name, "%016llx.png", (unsigned long long)hash);
    return user_cache(out, name);
}

/* Reads a picture of the cache. A file that is none is as good as no file. */
static bool find(const char *place_of, WeftImage *out) {
    if (weft_image_read(place_of, out, NULL, NULL) != WEFT_OK) return false;
    if (out->width == THUMB_SIDE && out->height == THUMB_SIDE && out->type == WEFT_PIXEL_U8 && out->channels >= 3)
        return true;
    weft_image_free(out);
    return false;
}

static int note(void *user, double fraction) {
    Thumbs *self = user;
    (void)fraction;
    pthread_mutex_lock(&self->lock);
    const bool stopped = self->stopped;
    pthread_mutex_unlock(&self->lock);
    return stopped;
}

static WeftResult draw(Thumbs *self, const WeftScene *scene, WeftImage *out, WeftError *error) {
    const WeftRenderDesc desc = {.width = THUMB_SIDE, .height = THUMB_SIDE, .threads = 1, .camera = "main"};
    WeftRender *render;
    WeftImage linear = {0};
    WeftResult result = weft_render_create(scene, &desc, &render, error);
    if (result != WEFT_OK) return result;
    result = weft_render_run(render, THUMB_SAMPLES, 0.0, note, self);
    if (result == WEFT_OK) result = weft_render_image(render, &linear, error);
    if (result == WEFT_OK) result = weft_image_tonemap(&linear, WEFT_TONEMAP_PBR_NEUTRAL, 0.0f, out, error);
    weft_image_free(&linear);
    weft_render_free(render);
    return result;
}

/* Makes a picture, from the cache if it is there. */
static void make(Thumbs *self, const char *path, Thumb *out) {
    char kept[USER_PATH];
    WeftScene *scene;
    WeftError error = {0};
    const bool cached = place(path, kept);
    if (cached && find(kept, &out->image)) return;
    WeftResult result = weft_scene_load("builtin:swatch", &scene, NULL, &error);
    if (result == WEFT_OK) {
        result = weft_scene_assign_material(scene, "0", path, NULL, &error);
        if (result == WEFT_OK) result = draw(self, scene, &out->image, &error);
        weft_scene_free(scene);
    }
    if (result == WEFT_OK && cached) weft_image_write(kept, &out->image, NULL);
    if (result != WEFT_OK) snprintf(out->failure, sizeof out->failure, "%s", error.text);
}

/* Waits for a request. Returns its number, or -1 at the end. */
static int next(Thumbs *self) {
    int index = -1;
    pthread_mutex_lock(&self->lock);
    while (!self->stopped && index < 0) {
        for (int k = 0; k < self->count && index < 0; k++)
            if (self->entries[k].stage == WANTED) index = k;
        if (index < 0) pthread_cond_wait(&self->change, &self->lock);
    }
    if (self->stopped) index = -1;
    if (index >= 0) self->entries[index].stage = IN_WORK;
    pthread_mutex_unlock(&self->lock);
    return index;
}

static void *run(void *user) {
    Thumbs *self = user;
    setpriority(PRIO_PROCESS, (id_t)gettid(), 10); /* as the path tracer: a lower one starves where others compile */
    for (int k; (k = next(self)) >= 0;) {
        Thumb made = {.index = k};
        make(self, self->entries[k].path, &made);
        pthread_mutex_lock(&self->lock);
        self->entries[k].thumb = made;
        self->entries[k].stage = MADE;
        pthread_mutex_unlock(&self->lock);
        if (self->window) window_wake(self->window);
    }
    return NULL;
}

static void release(Thumbs *self) {
    for (int k = 0; self->entries && k < self->count; k++) {
        free(self->entries[k].path);
        if (self->entries[k].stage == MADE) weft_image_free(&self->entries[k].thumb.image);
    }
    free(self->entries);
    pthread_cond_destroy(&self->change);
    pthread_mutex_destroy(&self->lock);
    free(self);
}

Thumbs *thumbs_start(Window *window, const char *const *paths, int count) {
    Thumbs *self = calloc(1, sizeof *self);
    if (!self) return NULL;
    self->window = window;
    self->entries = calloc((size_t)count + 1, sizeof *self->entries);
    pthread_mutex_init(&self->lock, NULL);
    pthread_cond_init(&self->change, NULL);
    bool good = self->entries != NULL;
    for (int k = 0; good && k < count; k++) {
        self->entries[k].path = strdup(paths[k]);
        self->count = k + 1;
        good = self->entries[k].path != NULL;
    }
    if (good && pthread_create(&self->thread, NULL, run, self) == 0) return self;
    release(self);
    return NULL;
}

void thumbs_want(Thumbs *self, int index) {
    pthread_mutex_lock(&self->lock);
    if (self->entries[index].stage == IDLE) {
        self->entries[index].stage = WANTED;
        pthread_cond_signal(&self->change);
    }
    pthread_mutex_unlock(&self->lock);
}

void thumbs_forget(Thumbs *self) {
    pthread_mutex_lock(&self->lock);
    for (int k = 0; k < self->count; k++)
        if (self->entries[k].stage == WANTED) self->entries[k].stage = IDLE;
    pthread_mutex_unlock(&self->lock);
}

bool thumbs_take(Thumbs *self, Thumb *out) {
    bool found = false;
    pthread_mutex_lock(&self->lock);
    for (int k = 0; k < self->count && !found; k++) {
        Entry *entry = &self->entries[k];
        if (entry->stage != MADE) continue;
        *out = entry->thumb;
        entry->stage = TAKEN;
        found = true;
    }
    pthread_mutex_unlock(&self->lock);
    return found;
}

bool thumbs_busy(Thumbs *self) {
    bool busy = false;
    pthread_mutex_lock(&self->lock);
    for (int k = 0; k < self->count; k++) busy |= self->entries[k].stage >= WANTED && self->entries[k].stage <= MADE;
    pthread_mutex_unlock(&self->lock);
    return busy;
}

void thumbs_stop(Thumbs *self) {
    if (!self) return;
    pthread_mutex_lock(&self->lock);
    self->stopped = true;
    pthread_cond_signal(&self->change);
    pthread_mutex_unlock(&self->lock);
    pthread_join(self->thread, NULL);
    release(self);
}
