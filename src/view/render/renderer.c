#define _POSIX_C_SOURCE 200809L
#include "view/render/renderer.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <epoxy/gl.h>

#include "base/steady_clock.h"
#include "view/render/renderer_state.h"

static void on_warning(void *user, WeftMessage message, const char *text) {
    Renderer *self = user;
    pthread_mutex_lock(&self->lock);
    size_t used = strlen(self->warnings);
    if (!strstr(self->warnings, text)) snprintf(self->warnings + used, WARNINGS_SIZE - used, "%s\n", text);
    pthread_mutex_unlock(&self->lock);
}

WeftLog renderer_log(Renderer *self) { return (WeftLog){on_warning, self}; }

void renderer_post(Renderer *self, RenderEvent *event) {
    pthread_mutex_lock(&self->lock);
    if (self->event_count < EVENTS)
        self->events[self->event_count++] = *event;
    else
        render_event_free(event);
    pthread_mutex_unlock(&self->lock);
    window_wake(self->window);
}

static const double rest_seconds = 0.3; /* without a change before frames are summed, which may compile first */

enum { FIRST_FOLDER = 1 << 24 }; /* id of the first folder in the file watch; smaller ids are textures */

void renderer_watch_files(Renderer *self) {
    file_watch_clear(self->file_watch);
    for (int k = 1; weft_scene_texture(self->scene, k).pixels; k++) {
        const char *path = weft_scene_texture_path(self->scene, k);
        if (path) file_watch_add(self->file_watch, path, k);
    }
    for (int k = 0; k < self->folders.count; k++)
        file_watch_add(self->file_watch, self->folders.paths[k], FIRST_FOLDER + k);
}

static void drop_scene(Renderer *self) {
    weft_pick_free(self->pick);
    weft_raster_free(self->raster);
    weft_scene_free(self->scene);
    scene_state_free(&self->is);
    self->pick = NULL;
    self->raster = NULL;
    self->scene = NULL;
}

/* Replaces the scene. If the new one cannot be drawn, the old one stays; an event reports either. */
static void replace_scene(Renderer *self, WeftScene *scene, SceneState *state, const Folders *folders,
                          unsigned number) {
    const WeftRasterDesc desc = {.adopt = 1, .shader_dir = self->shader_dir, .occlusion = self->occlusion};
    const WeftLog log = renderer_log(self);
    WeftError error = {0};
    WeftRaster *raster = NULL;
    WeftResult result = weft_raster_create(scene, &desc, &raster, &log, &error);
    RenderEvent event = {.kind = TASK_SCENE, .scene = number, .failed = result != WEFT_OK, .result = result};
    if (result == WEFT_OK) {
        study_stop(&self->study);
        reference_pause(self->reference);
        reference_resume(self->reference, scene, ~0u);
        drop_scene(self);
        self->scene = scene;
        self->raster = raster;
        pthread_mutex_lock(&self->lock);
        self->scene_number = number;
        pthread_mutex_unlock(&self->lock);
        self->is = *state;
        self->folders = *folders;
        self->surveyed = state->variant;
        self->naps = (BoundNaps){0};
        self->refusal[0] = '\0';
        self->started = false;
        self->coarse = 4; /* these are guesses until pictures have been timed */
        self->coarse_seconds = 1.0;
        self->whole_seconds = 2.0;
        self->smooth_seconds = 8.0;
        self->smooth_timed = false;
        self->sums = false;
        renderer_watch_files(self);
    } else {
        weft_scene_free(scene);
        scene_state_free(state);
        snprintf(event.text, sizeof event.text, "%s", error.text);
    }
    renderer_post(self, &event);
}

/* Rereads one file that has changed: a texture, or a folder of maps. Returns true if there was one. */
static bool reload_file(Renderer *self) {
    int id = self->started ? file_watch_poll(self->file_watch, clock_now()) : -1;
    if (id < 0) return false;
    if (id >= FIRST_FOLDER) {
        Task bind = {.kind = TASK_BIND_MAPS, .scene = self->scene_number};
        bind.index = self->folders.materials[id - FIRST_FOLDER];
        snprintf(bind.path, sizeof bind.path, "%s", self->folders.paths[id - FIRST_FOLDER]);
        tasks_do(self, &bind, &self->drawn);
        return true;
    }
    WeftError error = {0};
    RenderEvent event = {.kind = TASK_ASSIGN, .scene = self->scene_number};
    event.failed = tasks_reload(self, id, &error) != WEFT_OK;
    if (event.failed)
        snprintf(event.text, sizeof event.text, "%s", error.text);
    else
        snprintf(event.text, sizeof event.text, "reloaded: %.400s", weft_scene_texture_path(self->scene, id));
    if (!event.failed) facts_read_maps(&event.maps, self->scene);
    renderer_post(self, &event);
    return true;
}

/* Takes over changed files, changed shaders and finished background work. Returns true if the picture is now old. */
static bool reload_changes(Renderer *self) {
    if (!self->raster) return false;
    if (reload_file(self)) return true;
    if (self->shader_dir && weft_raster_refresh(self->raster) > 0) return true;
    return weft_raster_info(self->raster).made != 0;
}

/* Waits for a change. Returns true if there was none for a quarter of a second, and nothing is being made. */
static bool wait_a_little(Renderer *self) {
    bool making = self->raster && weft_raster_info(self->raster).making != 0;
    struct timespec until = clock_after(making ? 0.04 : 0.25);
    self->working = making;
    const bool waited = pthread_cond_timedwait(&self->change, &self->lock, &until) == ETIMEDOUT;
    self->working = true;
    return waited && !making;
}

bool frame_request_copy(FrameRequest *copy, const FrameRequest *request) {
    SceneState state, other = {0};
    if (!scene_state_copy(&state, &request->state)) return false;
    if (request->split != SPLIT_NONE && !scene_state_copy(&other, &request->other)) {
        scene_state_free(&state);
        return false;
    }
    *copy = *request;
    copy->state = state;
    copy->other = other;
    return true;
}

void frame_request_free(FrameRequest *request) {
    scene_state_free(&request->state);
    scene_state_free(&request->other);
}

/* Does the most urgent pending work: a new scene, then a frame, then a task, then one more picture of a profile sheet,
 * then a part of a sum of frames.
 * Returns false if nothing is pending or memory is short. The lock is held on entry and on return, not in between. */
static bool render_next(Renderer *self) {
    bool requested = self->requested && self->raster && self->request.scene == self->scene_number;
    self->working = true;
    if (self->pending_scene) {
        WeftScene *scene = self->pending_scene;
        SceneState state = self->pending_state;
        const Folders folders = self->pending_folders;
        unsigned number = self->pending_number;
        self->pending_scene = NULL;
        pthread_mutex_unlock(&self->lock);
        replace_scene(self, scene, &state, &folders, number);
    } else if (requested && (self->number != self->drawn_number || self->stale || !self->started)) {
        unsigned number = self->number;
        if (number != self->drawn_number) {
            FrameRequest copy;
            if (!frame_request_copy(&copy, &self->request)) return false;
            frame_request_free(&self->drawn);
            self->drawn = copy;
        }
        self->drawn_number = number;
        self->stale = false;
        self->started = true;
        pthread_mutex_unlock(&self->lock);
        frame_draw(self, &self->drawn, number);
    } else if (requested && self->task_count) {
        Task task = self->tasks[0];
        memmove(self->tasks, self->tasks + 1, (size_t)--self->task_count * sizeof task);
        bool stale = task.scene != self->scene_number;
        pthread_mutex_unlock(&self->lock);
        if (!stale) tasks_do(self, &task, &self->drawn);
    } else if (requested && self->study.under_way) {
        pthread_mutex_unlock(&self->lock);
        tasks_study(self);
    } else if (requested && self->sums && clock_now() > self->drawn_at + rest_seconds) {
        self->working = false; /* whoever waits for the picture has it already */
        pthread_mutex_unlock(&self->lock);
        frame_sum(self);
    } else {
        return false;
    }
    pthread_mutex_lock(&self->lock);
    return true;
}

static void *work(void *user) {
    Renderer *self = user;
    bool good = window_worker_begin(self->window);
    pthread_mutex_lock(&self->lock);
    if (!good) snprintf(self->rendered.failure, sizeof self->rendered.failure, "cannot create a second OpenGL context");
    while (!self->quit && good) {
        if (render_next(self)) {
            self->spare = true;
            continue;
        }
        const bool waited = wait_a_little(self);
        pthread_mutex_unlock(&self->lock);
        bool changed = reload_changes(self);
        if (waited && !changed && self->spare) {
            weft_raster_rest(self->raster);
            self->spare = false;
        }
        pthread_mutex_lock(&self->lock);
        self->stale |= changed;
    }
    pthread_mutex_unlock(&self->lock);
    reference_pause(self->reference);
    reference_resume(self->reference, NULL, ~0u);
    study_stop(&self->study);
    drop_scene(self);
    glDeleteTextures(RING, self->textures);
    glDeleteFramebuffers(RING, self->targets);
    window_worker_end(self->window);
    return NULL;
}

Renderer *renderer_start(Window *window, ReferenceView *reference, const char *shader_dir, int occlusion) {
    Renderer *self = calloc(1, sizeof *self);
    if (!self) return NULL;
    self->window = window;
    self->reference = reference;
    self->occlusion = occlusion;
    self->shader_dir = shader_dir ? strdup(shader_dir) : NULL;
    self->newest = self->shown = self->before = -1;
    pthread_mutex_init(&self->lock, NULL);
    clock_condition(&self->change);
    self->file_watch = file_watch_start();
    if (self->file_watch && pthread_create(&self->thread, NULL, work, self) == 0) return self;
    file_watch_stop(self->file_watch);
    free(self->shader_dir);
    free(self);
    return NULL;
}

void renderer_stop(Renderer *self) {
    if (!self) return;
    pthread_mutex_lock(&self->lock);
    self->quit = true;
    pthread_cond_broadcast(&self->change);
    pthread_mutex_unlock(&self->lock);
    pthread_join(self->thread, NULL);
    frame_request_free(&self->request);
    frame_request_free(&self->drawn);
    weft_scene_free(self->pending_scene);
    if (self->pending_scene) scene_state_free(&self->pending_state);
    for (int k = 0; k < self->event_count; k++) render_event_free(&self->events[k]);
    pthread_mutex_destroy(&self->lock);
    pthread_cond_destroy(&self->change);
    file_watch_stop(self->file_watch);
    free(self->shader_dir);
    free(self);
}

void renderer_set_scene(Renderer *self, WeftScene *scene, const SceneState *state, const Folders *folders,
                        unsigned number) {
    pthread_mutex_lock(&self->lock);
    if (self->pending_scene) {
        weft_scene_free(self->pending_scene);
        scene_state_free(&self->pending_state);
    }
    self->pending_scene = scene;
    if (!scene_state_copy(&self->pending_state, state)) self->pending_state = (SceneState){0};
    self->pending_folders = *folders;
    self->pending_number = number;
    pthread_cond_broadcast(&self->change);
    pthread_mutex_unlock(&self->lock);
}

unsigned renderer_request(Renderer *self, const FrameRequest *request) {
    FrameRequest copy;
    if (!frame_request_copy(&copy, request)) return self->number;
    pthread_mutex_lock(&self->lock);
    frame_request_free(&self->request);
    self->request = copy;
    self->requested = true;
    unsigned number = ++self->number;
    pthread_cond_broadcast(&self->change);
    pthread_mutex_unlock(&self->lock);
    return number;
}

bool renderer_add_task(Renderer *self, const Task *task) {
    pthread_mutex_lock(&self->lock);
    bool picking = task->kind == TASK_PICK && self->task_count && self->tasks[self->task_count - 1].kind == TASK_PICK;
    if (picking) self->task_count--; /* the newer pick replaces the one that waits */
    const bool taken = self->task_count < TASKS;
    if (taken) self->tasks[self->task_count++] = *task;
    pthread_cond_broadcast(&self->change);
    pthread_mutex_unlock(&self->lock);
    return taken;
}

/* Returns true if two pictures have one size and show one scene through one camera. */
static bool same_view(const RenderedFrame *a, const RenderedFrame *b) {
    const bool same =
        a->texture && b->texture && a->scene == b->scene && a->width == b->width && a->height == b->height;
    float off = fabsf(a->fov - b->fov);
    for (int k = 0; k < 3; k++) off += fabsf(a->eye[k] - b->eye[k]) + fabsf(a->target[k] - b->target[k]);
    return same && off <= 0.0f;
}

bool renderer_take_frame(Renderer *self, RenderedFrame *rendered) {
    pthread_mutex_lock(&self->lock);
    const bool fresh = self->fresh,
               rests = self->rendered.effort > EFFORT_COARSE && same_view(rendered, &self->rendered);
    const bool sharpens = rests && rendered->effort == EFFORT_COARSE;
    const unsigned before = sharpens ? rendered->texture : rests ? rendered->before : 0;
    if (sharpens) self->before = self->shown;
    self->fresh = false;
    if (fresh) self->shown = self->newest;
    *rendered = self->rendered;
    rendered->before = before;
    pthread_mutex_unlock(&self->lock);
    return fresh;
}

bool renderer_has_output(Renderer *self) {
    pthread_mutex_lock(&self->lock);
    bool fresh = self->fresh || self->event_count;
    pthread_mutex_unlock(&self->lock);
    return fresh;
}

bool renderer_take_event(Renderer *self, RenderEvent *event) {
    pthread_mutex_lock(&self->lock);
    bool some = self->event_count > 0;
    if (some) {
        *event = self->events[0];
        memmove(self->events, self->events + 1, (size_t)--self->event_count * sizeof *event);
    }
    pthread_mutex_unlock(&self->lock);
    return some;
}

void render_event_free(RenderEvent *event) {
    weft_image_free(&event->image);
    free(event->coverage);
    facts_free(&event->maps);
    if (event->state_changed) scene_state_free(&event->state);
}

bool renderer_is_idle(Renderer *self) {
    pthread_mutex_lock(&self->lock);
    bool idle = !self->working && !self->pending_scene && !self->task_count && !self->event_count &&
                !self->study.under_way &&
                (!self->requested || self->request.scene != self->scene_number || self->number == self->drawn_number) &&
                !self->stale;
    pthread_mutex_unlock(&self->lock);
    return idle;
}

char *renderer_take_warnings(Renderer *self) {
    pthread_mutex_lock(&self->lock);
    char *warnings = self->warnings[0] ? strdup(self->warnings) : NULL;
    self->warnings[0] = '\0';
    pthread_mutex_unlock(&self->lock);
    return warnings;
}
