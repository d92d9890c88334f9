#define _POSIX_C_SOURCE 200809L
#include "view/painter.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <epoxy/gl.h>

#include "view/clock.h"
#include "view/painting.h"

static void on_said(void *user, WeftMessage message, const char *text) {
    Painter *self = user;
    pthread_mutex_lock(&self->lock);
    size_t used = strlen(self->said);
    if (!strstr(self->said, text)) snprintf(self->said + used, SAID - used, "%s\n", text);
    pthread_mutex_unlock(&self->lock);
}

WeftLog painter_log(Painter *self) { return (WeftLog){on_said, self}; }

void painter_tell(Painter *self, News *news) {
    pthread_mutex_lock(&self->lock);
    if (self->news_count < NEWS)
        self->news[self->news_count++] = *news;
    else
        news_free(news);
    pthread_mutex_unlock(&self->lock);
    window_wake(self->window);
}

/* ---- scenes ---- */

enum { FOLDERS = 1 << 24 }; /* what the watchman calls the first folder; below it are textures */

void painter_watch(Painter *self) {
    watchman_forget(self->watchman);
    for (int k = 1; weft_scene_texture(self->scene, k).pixels; k++) {
        const char *path = weft_scene_texture_path(self->scene, k);
        if (path) watchman_watch(self->watchman, path, k);
    }
    for (int k = 0; k < self->folders.count; k++)
        watchman_watch(self->watchman, self->folders.paths[k], FOLDERS + k);
}

static void drop_scene(Painter *self) {
    weft_pick_free(self->pick);
    weft_raster_free(self->raster);
    weft_scene_free(self->scene);
    look_free(&self->is);
    self->pick = NULL;
    self->raster = NULL;
    self->scene = NULL;
}

/* The scene before stays where this one cannot be drawn. */
static void take_scene(Painter *self, WeftScene *scene, Look *look, const Folders *folders, unsigned number) {
    const WeftRasterDesc desc = {.adopt = 1, .shader_dir = self->shader_dir, .occlusion = self->occlusion};
    const WeftLog log = painter_log(self);
    WeftError error = {0};
    WeftRaster *raster = NULL;
    WeftResult result = weft_raster_create(scene, &desc, &raster, &log, &error);
    News news = {.kind = TASK_SCENE, .scene = number, .failed = result != WEFT_OK, .result = result};
    if (result == WEFT_OK) {
        study_stop(&self->study);
        truth_hold(self->truth);
        truth_release(self->truth, scene, ~0u);
        drop_scene(self);
        self->scene = scene;
        self->raster = raster;
        pthread_mutex_lock(&self->lock);
        self->scene_number = number;
        pthread_mutex_unlock(&self->lock);
        self->is = *look;
        self->folders = *folders;
        self->surveyed = look->variant;
        self->worn = (LookWorn){0};
        self->refusal[0] = '\0';
        self->started = false;
        self->smooth_seconds = 8.0;
        self->smooth_known = false;
        self->coarse = 4; /* these until they are known */
        self->coarse_seconds = 1.0;
        self->whole_seconds = 2.0;
        self->smooth_seconds = 8.0;
        self->smooth_known = false;
        painter_watch(self);
    } else {
        weft_scene_free(scene);
        look_free(look);
        snprintf(news.text, sizeof news.text, "%s", error.text);
    }
    painter_tell(self, &news);
}

/* ---- the thread ---- */

static bool reload_changed(Painter *self) {
    int texture = self->started ? watchman_look(self->watchman, now()) : -1;
    if (texture < 0) return false;
    if (texture >= FOLDERS) {
        Task wear = {.kind = TASK_WEAR, .scene = self->scene_number};
        wear.index = self->folders.materials[texture - FOLDERS];
        snprintf(wear.path, sizeof wear.path, "%s", self->folders.paths[texture - FOLDERS]);
        tasks_do(self, &wear, &self->done);
        return true;
    }
    WeftError error = {0};
    News news = {.kind = TASK_DRESS, .scene = self->scene_number};
    news.failed = tasks_reload(self, texture, &error) != WEFT_OK;
    if (news.failed)
        snprintf(news.text, sizeof news.text, "%s", error.text);
    else
        snprintf(news.text, sizeof news.text, "read again: %.400s",
                 weft_scene_texture_path(self->scene, texture));
    if (!news.failed) facts_read_maps(&news.maps, self->scene);
    painter_tell(self, &news);
    return true;
}

/* Whether what was made in the background, or a file on disk, makes for another picture. */
static bool has_changed(Painter *self) {
    if (!self->raster) return false;
    if (reload_changed(self)) return true;
    if (self->shader_dir && weft_raster_refresh(self->raster) > 0) return true;
    return weft_raster_info(self->raster).made != 0;
}

static void wait_a_little(Painter *self) {
    bool making = self->raster && weft_raster_info(self->raster).making != 0;
    struct timespec until = clock_after(making ? 0.04 : 0.25);
    self->working = making;
    pthread_cond_timedwait(&self->change, &self->lock, &until);
    self->working = true;
}

bool order_copy(Order *copy, const Order *order) {
    Look look, other = {0};
    if (!look_copy(&look, &order->look)) return false;
    if (order->split != SPLIT_NONE && !look_copy(&other, &order->other)) {
        look_free(&look);
        return false;
    }
    *copy = *order;
    copy->look = look;
    copy->other = other;
    return true;
}

void order_free(Order *order) {
    look_free(&order->look);
    look_free(&order->other);
}

/* The first of these that is due: a scene, a picture, a task, a sheet. False where there is nothing to do.
 * The lock is held before and after. */
static bool step(Painter *self) {
    bool ordered = self->ordered && self->raster && self->order.scene == self->scene_number;
    if (self->gift) {
        WeftScene *scene = self->gift;
        Look look = self->gift_look;
        const Folders folders = self->gift_folders;
        unsigned number = self->gift_number;
        self->gift = NULL;
        pthread_mutex_unlock(&self->lock);
        take_scene(self, scene, &look, &folders, number);
    } else if (ordered && (self->number != self->done_number || self->stale || !self->started)) {
        unsigned number = self->number;
        if (number != self->done_number) {
            Order copy;
            if (!order_copy(&copy, &self->order)) return false;
            order_free(&self->done);
            self->done = copy;
        }
        self->done_number = number;
        self->stale = false;
        self->started = true;
        pthread_mutex_unlock(&self->lock);
        painting_draw(self, &self->done, number);
    } else if (ordered && self->task_count) {
        Task task = self->tasks[0];
        memmove(self->tasks, self->tasks + 1, (size_t)--self->task_count * sizeof task);
        bool stale = task.scene != self->scene_number;
        pthread_mutex_unlock(&self->lock);
        if (!stale) tasks_do(self, &task, &self->done);
    } else if (ordered && self->study.under_way) {
        pthread_mutex_unlock(&self->lock);
        tasks_study(self);
    } else {
        return false;
    }
    pthread_mutex_lock(&self->lock);
    return true;
}

static void *work(void *user) {
    Painter *self = user;
    bool good = window_worker_begin(self->window);
    pthread_mutex_lock(&self->lock);
    if (!good)
        snprintf(self->painted.failure, sizeof self->painted.failure,
                 "a second OpenGL context cannot be had");
    while (!self->quit && good) {
        if (step(self)) continue;
        wait_a_little(self);
        pthread_mutex_unlock(&self->lock);
        bool changed = has_changed(self);
        pthread_mutex_lock(&self->lock);
        self->stale |= changed;
    }
    pthread_mutex_unlock(&self->lock);
    truth_hold(self->truth);
    truth_release(self->truth, NULL, ~0u);
    study_stop(&self->study);
    drop_scene(self);
    glDeleteTextures(RING, self->textures);
    glDeleteFramebuffers(RING, self->targets);
    window_worker_end(self->window);
    return NULL;
}

Painter *painter_start(Window *window, Truth *truth, const char *shader_dir, int occlusion) {
    Painter *self = calloc(1, sizeof *self);
    if (!self) return NULL;
    self->window = window;
    self->truth = truth;
    self->occlusion = occlusion;
    self->shader_dir = shader_dir ? strdup(shader_dir) : NULL;
    self->newest = self->shown = -1;
    pthread_mutex_init(&self->lock, NULL);
    clock_condition(&self->change);
    self->watchman = watchman_start();
    if (self->watchman && pthread_create(&self->thread, NULL, work, self) == 0) return self;
    watchman_stop(self->watchman);
    free(self->shader_dir);
    free(self);
    return NULL;
}

void painter_stop(Painter *self) {
    if (!self) return;
    pthread_mutex_lock(&self->lock);
    self->quit = true;
    pthread_cond_broadcast(&self->change);
    pthread_mutex_unlock(&self->lock);
    pthread_join(self->thread, NULL);
    order_free(&self->order);
    order_free(&self->done);
    weft_scene_free(self->gift);
    if (self->gift) look_free(&self->gift_look);
    for (int k = 0; k < self->news_count; k++) news_free(&self->news[k]);
    pthread_mutex_destroy(&self->lock);
    pthread_cond_destroy(&self->change);
    watchman_stop(self->watchman);
    free(self->shader_dir);
    free(self);
}

void painter_give(Painter *self, WeftScene *scene, const Look *look, const Folders *folders,
                  unsigned number) {
    pthread_mutex_lock(&self->lock);
    if (self->gift) {
        weft_scene_free(self->gift);
        look_free(&self->gift_look);
    }
    self->gift = scene;
    if (!look_copy(&self->gift_look, look)) self->gift_look = (Look){0};
    self->gift_folders = *folders;
    self->gift_number = number;
    pthread_cond_broadcast(&self->change);
    pthread_mutex_unlock(&self->lock);
}

unsigned painter_order(Painter *self, const Order *order) {
    Order copy;
    if (!order_copy(&copy, order)) return self->number;
    pthread_mutex_lock(&self->lock);
    order_free(&self->order);
    self->order = copy;
    self->ordered = true;
    unsigned number = ++self->number;
    pthread_cond_broadcast(&self->change);
    pthread_mutex_unlock(&self->lock);
    return number;
}

void painter_task(Painter *self, const Task *task) {
    pthread_mutex_lock(&self->lock);
    bool picking =
        task->kind == TASK_PICK && self->task_count && self->tasks[self->task_count - 1].kind == TASK_PICK;
    if (picking) self->task_count--; /* only the latest counts */
    if (self->task_count < TASKS) self->tasks[self->task_count++] = *task;
    pthread_cond_broadcast(&self->change);
    pthread_mutex_unlock(&self->lock);
}

bool painter_look(Painter *self, Painted *painted) {
    pthread_mutex_lock(&self->lock);
    bool fresh = self->fresh;
    self->fresh = false;
    if (fresh) self->shown = self->newest;
    *painted = self->painted;
    pthread_mutex_unlock(&self->lock);
    return fresh;
}

bool painter_fresh(Painter *self) {
    pthread_mutex_lock(&self->lock);
    bool fresh = self->fresh || self->news_count;
    pthread_mutex_unlock(&self->lock);
    return fresh;
}

bool painter_news(Painter *self, News *news) {
    pthread_mutex_lock(&self->lock);
    bool some = self->news_count > 0;
    if (some) {
        *news = self->news[0];
        memmove(self->news, self->news + 1, (size_t)--self->news_count * sizeof *news);
    }
    pthread_mutex_unlock(&self->lock);
    return some;
}

void news_free(News *news) {
    weft_image_free(&news->image);
    free(news->shares);
    facts_free(&news->maps);
    if (news->look_changed) look_free(&news->look);
}

bool painter_idle(Painter *self) {
    pthread_mutex_lock(&self->lock);
    bool idle =
        !self->working && !self->gift && !self->task_count && !self->news_count && !self->study.under_way &&
        (!self->ordered || self->order.scene != self->scene_number || self->number == self->done_number) &&
        !self->stale;
    pthread_mutex_unlock(&self->lock);
    return idle;
}

char *painter_said(Painter *self) {
    pthread_mutex_lock(&self->lock);
    char *said = self->said[0] ? strdup(self->said) : NULL;
    self->said[0] = '\0';
    pthread_mutex_unlock(&self->lock);
    return said;
}
