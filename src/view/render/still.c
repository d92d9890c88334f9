#define _XOPEN_SOURCE 700 /* mkdtemp */
#include "view/render/still.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

#include "base/path.h"
#include "weft/isa.h"

struct Still {
    StillDesc desc;
    Window *window;
    pthread_t thread;
    pthread_mutex_t lock; /* of what follows */
    double share;
    int written;    /* pictures */
    double samples; /* a pixel, of the last picture */
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

static int count_of(const Still *self) { return self->desc.choice.around > 0 ? self->desc.choice.around : 1; }

/* Notes the progress of a picture. Returns true if it was stopped. */
static int note(void *user, double fraction) {
    Still *self = user;
    pthread_mutex_lock(&self->lock);
    const double share = (self->written + fraction) / count_of(self);
    const bool seen = share - self->share >= 0.01 || share >= 1.0, stopped = self->stopped;
    if (seen) self->share = share;
    pthread_mutex_unlock(&self->lock);
    if (seen && self->window) window_wake(self->window);
    return stopped;
}

/* Lays the background's colour behind a linear picture, as `weft render --background` does. */
static void lay_behind(const StillDesc *desc, WeftImage *linear) {
    float *p = linear->pixels;
    for (size_t k = 0; k < (size_t)linear->width * (size_t)linear->height; k++, p += 4) {
        for (int c = 0; c < 3; c++) p[c] = p[c] * p[3] + desc->desc.background_color[c] * (1.0f - p[3]);
        p[3] = 1.0f;
    }
}

/* Returns the AOVs of a picture. The light of slots cannot be told where these reflect different environments. */
static unsigned aovs_of(const StillDesc *desc) {
    const unsigned slots = (2u << WEFT_AOV_OTHER) - (1u << WEFT_AOV_DIFFUSE), variance = 1u << WEFT_AOV_VARIANCE;
    const EnvironmentState *sky = &desc->environment;
    const bool one = !(sky->ambient < sky->reflection) && !(sky->ambient > sky->reflection);
    const size_t length = strlen(desc->path);
    if (!desc->choice.layered || length < 4 || strcasecmp(desc->path + length - 4, ".exr") != 0) return 0;
    return ((1u << WEFT_AOV_COUNT) - 1u) & ~variance & (one ? ~0u : ~slots);
}

static WeftResult write_picture(const StillDesc *desc, WeftImage *linear, const WeftRenderLayers *layers,
                                const char *path, WeftError *error) {
    const WeftImageWriting how = {.denoised =
                                      desc->choice.denoised ? weft_denoiser_name((int)WEFT_DENOISER_REGRESSION) : NULL,
                                  .isa = weft_isa(),
                                  .layers = layers->layers,
                                  .layer_count = layers->layer_count,
                                  .texts = layers->texts,
                                  .text_count = layers->text_count};
    if (weft_image_suffix_linear(path)) {
        if (desc->laid_behind) lay_behind(desc, linear);
        return weft_image_write_as(path, linear, &how, error);
    }
    WeftImage display;
    const WeftTone tone = {desc->tonemap, desc->exposure, {desc->white[0], desc->white[1]}};
    const float *behind = desc->laid_behind ? desc->desc.background_color : NULL;
    WeftResult result = weft_image_show(linear, &tone, behind, &display, error);
    if (result != WEFT_OK) return result;
    result = weft_image_write_as(path, &display, &how, error);
    weft_image_free(&display);
    return result;
}

/* Renders the scene through a camera and writes the picture. *info receives the camera in numbers. */
static WeftResult render(Still *self, const WeftScene *scene, const char *camera, const char *path,
                         WeftRenderInfo *info) {
    const StillDesc *desc = &self->desc;
    WeftRenderDesc traced = desc->desc;
    WeftRender *render;
    traced.camera = camera;
    traced.noise = desc->choice.noise;
    traced.first_hits = desc->choice.denoised;
    traced.halves = traced.noise > 0.0f ? WEFT_HALVES_INDEPENDENT : desc->choice.denoised ? WEFT_HALVES_SHARED : 0;
    weft_render_record(&traced, aovs_of(desc));
    WeftResult result = weft_render_create(scene, &traced, &render, &self->error);
    if (result != WEFT_OK) return result;
    result = weft_render_run(render, desc->choice.samples, 0.0, note, self);
    *info = weft_render_info(render);
    WeftImage linear = {0};
    if (result == WEFT_OK)
        result = desc->choice.denoised ? weft_render_denoised(render, WEFT_DENOISER_REGRESSION, &linear, &self->error)
                                       : weft_render_image(render, &linear, &self->error);
    WeftRenderLayers layers = {0};
    if (result == WEFT_OK) result = weft_render_layers(render, aovs_of(desc), &layers, &self->error);
    if (result == WEFT_OK) result = write_picture(desc, &linear, &layers, path, &self->error);
    weft_render_layers_free(&layers);
    weft_image_free(&linear);
    weft_render_free(render);
    return result;
}

/* Makes all pictures. The cameras of a turntable are that of the first one, turned. */
static WeftResult render_all(Still *self, const WeftScene *scene) {
    const int around = self->desc.choice.around;
    WeftRenderInfo first = {0}, info = {0};
    WeftResult result = WEFT_OK;
    for (int k = 0; k < count_of(self) && result == WEFT_OK; k++) {
        char camera[WEFT_CAMERA_TEXT], number[PATH_NUMBER], path[STATE_PATH + PATH_NUMBER];
        if (k) weft_camera_rotated(first.camera_eye, first.camera_target, first.camera_fov, k, around, camera);
        snprintf(path, sizeof path, "%s", self->desc.path);
        if (around) path_numbered(self->desc.path, path_number(k, around, number), path, sizeof path);
        result = render(self, scene, k ? camera : self->desc.camera, path, &info);
        if (!k) first = info;
        pthread_mutex_lock(&self->lock);
        self->written += result == WEFT_OK;
        self->samples = info.samples_per_pixel;
        pthread_mutex_unlock(&self->lock);
    }
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
        if (result == WEFT_OK) result = render_all(self, scene);
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
    const StillChoice *choice = &self->desc.choice;
    char several[48] = "";
    if (choice->around) snprintf(several, sizeof several, "%d of %d pictures, ", self->written, choice->around);
    if (made)
        snprintf(line, 512, "wrote %.380s, %s%d x %d, %.4g samples", self->desc.path, several, choice->width,
                 choice->height, self->samples);
    else if (self->result == WEFT_INTERRUPTED && choice->around)
        snprintf(line, 512, "cancelled: %swere written, %.380s", several, self->desc.path);
    else if (self->result == WEFT_INTERRUPTED)
        snprintf(line, 512, "cancelled: %.400s was not written", self->desc.path);
    else
        snprintf(line, 512, "%s", self->error.text);
    pthread_mutex_destroy(&self->lock);
    free(self);
    return made;
}
