#define _XOPEN_SOURCE 700 /* mkdtemp */
#include "view/render/still.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

struct Still {
    StillDesc desc;
    Window *window;
    pthread_t thread;
    pthread_mutex_t lock; /* of what follows */
    double share;
    bool ended, stopped;
    WeftResult result;
    WeftError error;
};

bool still_folder(char path[STATE_PATH]) {
    const char *folder = getenv("TMPDIR");
    char made[STATE_PATH - 16];
    int n = snprintf(made, sizeof made, "%s/weft-XXXXXX", folder && folder[0] ? folder : "/tmp");
    if (n < 0 || (size_t)n >= sizeof made || !mkdtemp(made)) return false;
    snprintf(path, STATE_PATH, "%s/scene.glb", made);
    return true;
}

void still_discard(const char path[STATE_PATH]) {
    char folder[STATE_PATH];
    unlink(path);
    snprintf(folder, sizeof folder, "%.*s", (int)(strrchr(path, '/') - path), path);
    rmdir(folder);
}

/* Notes the progress. Returns true if the picture was stopped. */
static int note(void *user, double fraction) {
    Still *self = user;
    pthread_mutex_lock(&self->lock);
    const bool seen = fraction - self->share >= 0.01 || fraction >= 1.0, stopped = self->stopped;
    if (seen) self->share = fraction;
    pthread_mutex_unlock(&self->lock);
    if (seen && self->window) window_wake(self->window);
    return stopped;
}

static WeftResult write_picture(const StillDesc *desc, const WeftImage *linear, WeftError *error) {
    if (weft_image_suffix_linear(desc->path)) return weft_image_write(desc->path, linear, error);
    WeftImage display;
    WeftResult result = weft_image_tonemap(linear, desc->tonemap, desc->exposure, &display, error);
    if (result != WEFT_OK) return result;
    result = weft_image_write(desc->path, &display, error);
    weft_image_free(&display);
    return result;
}

/* Renders the scene and writes the picture. */
static WeftResult render(Still *self, const WeftScene *scene) {
    const StillDesc *desc = &self->desc;
    WeftRenderDesc traced = desc->desc;
    WeftRender *render;
    traced.camera = desc->camera;
    traced.first_hits = desc->denoised;
    traced.halves = desc->denoised ? WEFT_HALVES_SHARED : 0;
    WeftResult result = weft_render_create(scene, &traced, &render, &self->error);
    if (result != WEFT_OK) return result;
    result = weft_render_run(render, desc->samples, 0.0, note, self);
    WeftImage linear = {0};
    if (result == WEFT_OK)
        result = desc->denoised ? weft_render_denoised(render, WEFT_DENOISER_REGRESSION, &linear, &self->error)
                                : weft_render_image(render, &linear, &self->error);
    if (result == WEFT_OK) result = write_picture(desc, &linear, &self->error);
    weft_image_free(&linear);
    weft_render_free(render);
    return result;
}

static void *run(void *user) {
    Still *self = user;
    WeftScene *scene;
    const EnvironmentState studio = environment_state_studio();
    unsigned changed = 0;
    WeftResult result = weft_scene_load(self->desc.scene, &scene, NULL, &self->error);
    if (result == WEFT_OK) {
        result = environment_state_apply(&self->desc.environment, &studio, scene, &changed, NULL, &self->error);
        if (result == WEFT_OK) result = render(self, scene);
        weft_scene_free(scene);
    }
    still_discard(self->desc.scene);
    pthread_mutex_lock(&self->lock);
    self->result = result;
    self->ended = true;
    pthread_mutex_unlock(&self->lock);
    if (self->window) window_wake(self->window);
    return NULL;
}

Still *still_start(const StillDesc *desc, Window *window) {
    Still *self = calloc(1, sizeof *self);
    if (!self) return NULL;
    self->desc = *desc;
    self->window = window;
    pthread_mutex_init(&self->lock, NULL);
    if (pthread_create(&self->thread, NULL, run, self) == 0) return self;
    still_discard(self->desc.scene);
    pthread_mutex_destroy(&self->lock);
    free(self);
    return NULL;
}

double still_progress(Still *self, bool *ended) {
    pthread_mutex_lock(&self->lock);
    const double share = self->share;
    *ended = self->ended;
    pthread_mutex_unlock(&self->lock);
    return share;
}

bool still_end(Still *self, char line[512]) {
    pthread_mutex_lock(&self->lock);
    self->stopped = true;
    pthread_mutex_unlock(&self->lock);
    pthread_join(self->thread, NULL);
    const bool made = self->result == WEFT_OK;
    if (made)
        snprintf(line, 512, "wrote %.400s, %d x %d, %d samples", self->desc.path, self->desc.desc.width,
                 self->desc.desc.height, self->desc.samples);
    else if (self->result == WEFT_INTERRUPTED)
        snprintf(line, 512, "cancelled: %.400s was not written", self->desc.path);
    else
        snprintf(line, 512, "%s", self->error.text);
    pthread_mutex_destroy(&self->lock);
    free(self);
    return made;
}
