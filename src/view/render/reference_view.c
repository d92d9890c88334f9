#define _GNU_SOURCE /* setpriority of one thread */
#include "view/render/reference_view.h"

#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

#include "base/steady_clock.h"

enum { COARSE = 3 }; /* pixels of the window along a side of a coarse pixel */

struct ReferenceView {
    Window *window;
    pthread_t thread;
    pthread_mutex_t lock;
    pthread_cond_t change;
    /* under the lock */
    ReferenceRequest request;
    unsigned number;        /* incremented when the picture becomes outdated */
    unsigned view;          /* of the request, incremented with each new view */
    unsigned state;         /* number of the state that `scene` has, from the renderer; 0: not yet set */
    const WeftScene *scene; /* may be read while `running` */
    unsigned changed;
    bool other; /* the scene is another one */
    bool paused, running, quit, waiting;
    unsigned number_for; /* the renderer's request that pictures replace; 0: none */
    WeftImage reference; /* the newest picture to compare with; taken by the thread */
    bool outdated;       /* `compared` is of another view or state */
    bool fresh;          /* `picture` was not taken yet */
    ReferenceFrame picture;
    WeftImage linear; /* the radiance of the picture */
    /* written by the thread alone; others read it while the thread does not run */
    WeftRender *render;
    ReferenceRequest requested, drawn; /* the latest as requested, and as drawn at its resolution */
    unsigned drawn_number, drawn_view, drawn_state;
    bool current; /* `render` is of the scene and of `drawn` */
    bool finer;   /* the render has full resolution */
    bool spare;   /* the render replaced a picture that may exist by now */
    double samples;
    WeftImage denoised; /* the render at denoised_samples */
    double denoised_samples;
    WeftImage compared;
};

static bool is_wanted(const ReferenceView *self) { return self->request.wanted || self->number_for; }

static int should_stop(void *user, double fraction) {
    ReferenceView *self = user;
    pthread_mutex_lock(&self->lock);
    bool stop = self->waiting || self->quit || self->number != self->drawn_number || !is_wanted(self);
    pthread_mutex_unlock(&self->lock);
    return stop;
}

static bool same_view(const ReferenceRequest *a, const ReferenceRequest *b) {
    WeftRenderDesc x = a->desc, y = b->desc;
    x.camera = y.camera = NULL;
    return memcmp((const char *)&x, (const char *)&y, sizeof x) == 0 && strcmp(a->camera, b->camera) == 0;
}

static void fail_with(ReferenceView *self, const char *failure) {
    pthread_mutex_lock(&self->lock);
    snprintf(self->picture.failure, sizeof self->picture.failure, "%.255s", failure);
    self->fresh = true;
    pthread_mutex_unlock(&self->lock);
}

/* Makes or changes the render, so that it fits this request and the current scene. */
static bool begin(ReferenceView *self, const ReferenceRequest *request, const WeftScene *scene, unsigned changed,
                  bool other) {
    WeftError error = {0};
    WeftRenderDesc desc = request->desc;
    WeftResult result;
    desc.camera = request->camera;
    pthread_mutex_lock(&self->lock);
    weft_image_free(&self->linear); /* of another view, or scene */
    pthread_mutex_unlock(&self->lock);
    weft_image_free(&self->denoised);
    self->denoised_samples = 0.0;
    if (other || !self->render) {
        weft_render_free(self->render);
        self->render = NULL;
        result = weft_render_create(scene, &desc, &self->render, &error);
    } else {
        result = weft_render_restart(self->render, &desc, changed, &error);
        if (result != WEFT_OK) {
            weft_render_free(self->render);
            self->render = NULL;
        }
    }
    self->samples = 0.0;
    self->current = result == WEFT_OK;
    if (!self->current) fail_with(self, error.text);
    return self->current;
}

static WeftResult compare(ReferenceView *self, const ReferenceRequest *request, const WeftImage *linear,
                          ReferenceFrame *picture) {
    const WeftImage *b = &self->compared;
    if (!b->pixels || b->width != linear->width || b->height != linear->height) return WEFT_INPUT;
    WeftResult result = weft_difference(b, linear, &picture->difference, NULL);
    picture->scale = request->scale > 0.0f ? request->scale : fmaxf(picture->difference.high, 0.01f);
    picture->compared = result == WEFT_OK;
    return result == WEFT_OK ? weft_difference_image(b, linear, picture->scale, &picture->image, NULL) : result;
}

/* Denoises the picture whenever the samples have doubled, so that most of the time goes to samples. */
static void clean(ReferenceView *self) {
    WeftImage image;
    if (self->samples < 2.0 || self->samples < 2.0 * self->denoised_samples) return;
    if (should_stop(self, 0.0)) return;
    if (weft_render_denoised(self->render, WEFT_DENOISER_REGRESSION, &image, NULL) == WEFT_OK) {
        weft_image_free(&self->denoised);
        self->denoised = image;
        self->denoised_samples = self->samples;
    }
}

/* Blends the denoised picture with the sampled one, whose weight is the fraction of samples taken. So its noise never
 * exceeds that of the last picture, which is the sampled one alone. */
static WeftResult mix(ReferenceView *self, const ReferenceRequest *request, const WeftImage *linear, WeftImage *out) {
    const WeftImage *denoised = &self->denoised;
    float share = fminf((float)(self->samples / request->samples), 1.0f);
    WeftResult result = weft_image_create(linear->width, linear->height, 4, WEFT_PIXEL_F32, out, NULL);
    if (result != WEFT_OK) return result;
    const float *a = denoised->pixels ? denoised->pixels : linear->pixels, *b = linear->pixels;
    float *to = out->pixels;
    for (size_t k = 0; k < 4 * (size_t)linear->width * (size_t)linear->height; k++)
        to[k] = a[k] + share * (b[k] - a[k]);
    return WEFT_OK;
}

static WeftResult show(ReferenceView *self, const ReferenceRequest *request, const WeftImage *linear, WeftImage *out) {
    WeftImage mixed;
    WeftResult result = mix(self, request, linear, &mixed);
    if (result != WEFT_OK) return result;
    const WeftTone tone = {request->tonemap, request->exposure, {request->white[0], request->white[1]}};
    result = weft_image_show(&mixed, &tone, request->behind, out, NULL);
    weft_image_free(&mixed);
    return result;
}

/* Publishes the picture. The samples of a coarse one are counted per pixel of the whole resolution, and its radiance is
 * not kept. */
static void publish(ReferenceView *self, const ReferenceRequest *request, unsigned number_for) {
    ReferenceFrame picture = {
        .wanted_samples = request->samples, .number = number_for, .view = self->drawn_view, .state = self->drawn_state};
    bool kept = !number_for && self->finer;
    WeftImage linear;
    if (weft_render_image(self->render, &linear, NULL) != WEFT_OK) return;
    WeftRenderInfo info = weft_render_info(self->render);
    picture.samples = info.samples_per_pixel;
    if (!number_for && !self->finer) picture.samples /= COARSE * COARSE;
    picture.seconds = info.render_seconds;
    picture.exposure = weft_image_meter(&linear);
    weft_image_find_white(&linear, picture.white);
    picture.denoised = !request->difference && self->denoised.pixels && self->samples < (double)request->samples;
    bool made = request->difference ? compare(self, request, &linear, &picture) == WEFT_OK
                                    : show(self, request, &linear, &picture.image) == WEFT_OK;
    pthread_mutex_lock(&self->lock);
    weft_image_free(&self->linear);
    if (kept && same_view(request, &self->request))
        self->linear = linear;
    else
        weft_image_free(&linear);
    if (made) {
        weft_image_free(&self->picture.image);
        self->picture = picture;
        self->fresh = true;
        pthread_cond_broadcast(&self->change);
    }
    pthread_mutex_unlock(&self->lock);
    if (self->window) window_wake(self->window);
}

/* Publishes new samples: noisy while nothing of the view is denoised, since denoising takes longer than the first
 * samples; then denoised. */
static void publish_samples(ReferenceView *self, const ReferenceRequest *request, unsigned number_for) {
    bool noisy = !self->denoised.pixels;
    if (noisy) publish(self, request, number_for);
    if (!request->difference) clean(self);
    if (!noisy || self->denoised.pixels) publish(self, request, number_for);
}

/* Adds samples for up to half a second. The first are one of each half; with coarse pixels first of one half, then of
 * the other. */
static void refine(ReferenceView *self, const ReferenceRequest *request) {
    double start = clock_now(), most = self->samples < 2.0 ? 0.0 : 0.4;
    int left = request->samples - (int)self->samples;
    int first = self->finer ? 2 : 1;
    int count = self->samples < 2.0 ? first : self->samples < 8.0 ? (int)self->samples : 8;
    if (count > left) count = left;
    while (count > 0) {
        WeftResult result = weft_render_run(self->render, count, 0.0, should_stop, self);
        self->samples = weft_render_info(self->render).samples_per_pixel;
        left = request->samples - (int)self->samples;
        if (count > left) count = left;
        if (result != WEFT_OK || clock_now() - start > most) break;
    }
}

static bool has_work(const ReferenceView *self) {
    if (!is_wanted(self) || !self->scene || self->paused || self->waiting) return false;
    if (self->picture.failure[0] && self->number == self->drawn_number && !self->changed) return false;
    return !self->current || self->other || self->changed || self->number != self->drawn_number ||
           self->reference.pixels || self->samples < (double)self->request.samples;
}

/* Returns true if the samples are no longer needed. */
static bool is_spare(const ReferenceView *self) {
    return self->spare && !is_wanted(self) && self->scene && !self->paused && !self->waiting;
}

/* Releases the samples of all pixels, about fifty bytes per pixel, and keeps the tree of the scene unless that has
 * changed. The lock is held before and after, but not during it. */
static void let_go(ReferenceView *self) {
    ReferenceRequest least = self->requested;
    const WeftScene *scene = self->scene;
    const bool other = self->other;
    least.desc.width = least.desc.height = 1;
    self->running = true;
    self->spare = false;
    pthread_mutex_unlock(&self->lock);
    if (other) {
        weft_render_free(self->render);
        self->render = NULL;
    } else if (self->render)
        begin(self, &least, scene, 0, false);
    pthread_mutex_lock(&self->lock);
    self->current = false;
    self->running = false;
    pthread_cond_broadcast(&self->change);
}

/* Reduces the resolution at first, so that a new view has a picture immediately. The next picture is whole. While
 * shaders compile, few processors are free: the resolution stays low until there are as many samples as such a pixel
 * stands for. */
static void coarsen(ReferenceView *self, ReferenceRequest *request, bool anew, bool stands_in) {
    double enough = stands_in ? COARSE * COARSE : 2.0;
    self->finer = !anew && (self->finer || self->samples >= enough);
    if (request->difference && !stands_in) self->finer = true;
    if (stands_in) request->difference = false;
    if (self->finer) return;
    request->desc.width = request->desc.width > COARSE ? request->desc.width / COARSE : 1;
    request->desc.height = request->desc.height > COARSE ? request->desc.height / COARSE : 1;
}

/* Does one round of work. The lock is held before and after, but not during it. */
static void round_of_work(ReferenceView *self) {
    ReferenceRequest request = self->request;
    unsigned number_for = request.wanted ? 0 : self->number_for;
    const WeftScene *scene = self->scene;
    unsigned changed = self->changed;
    bool other = self->other, redraw = self->number != self->drawn_number;
    self->running = true;
    self->changed = 0;
    self->other = false;
    self->drawn_number = self->number;
    self->drawn_view = self->view;
    self->drawn_state = self->state;
    self->spare = number_for != 0;
    if (self->outdated) weft_image_free(&self->compared);
    self->outdated = false;
    if (self->reference.pixels) {
        weft_image_free(&self->compared);
        self->compared = self->reference;
        self->reference = (WeftImage){0};
        redraw = true;
    }
    pthread_mutex_unlock(&self->lock);
    bool moved = other || changed || !self->current || !same_view(&request, &self->requested);
    self->requested = request;
    coarsen(self, &request, moved || (number_for && redraw), number_for != 0);
    bool begun = self->current || other || changed || !same_view(&request, &self->drawn) || !self->render;
    bool anew = other || changed || !self->current || !same_view(&request, &self->drawn);
    if (anew) begun = begin(self, &request, scene, changed, other);
    self->drawn = request;
    if (begun) {
        bool more = self->samples < (double)request.samples;
        if (redraw && !anew && self->samples >= 1.0)
            publish(self, &request, number_for); /* the same samples, shown otherwise */
        if (more) refine(self, &request);
        if (more && self->samples >= 1.0) publish_samples(self, &request, number_for);
    }
    pthread_mutex_lock(&self->lock);
    self->running = false;
    pthread_cond_broadcast(&self->change);
}

static void *work(void *user) {
    ReferenceView *self = user;
    setpriority(PRIO_PROCESS, (id_t)gettid(), 10); /* the window comes first; threads made here inherit it */
    pthread_mutex_lock(&self->lock);
    while (!self->quit)
        if (has_work(self))
            round_of_work(self);
        else if (is_spare(self))
            let_go(self);
        else
            pthread_cond_wait(&self->change, &self->lock);
    pthread_mutex_unlock(&self->lock);
    return NULL;
}

ReferenceView *reference_start(Window *window) {
    ReferenceView *self = calloc(1, sizeof *self);
    if (!self) return NULL;
    self->window = window;
    pthread_mutex_init(&self->lock, NULL);
    clock_condition(&self->change);
    if (pthread_create(&self->thread, NULL, work, self) == 0) return self;
    pthread_cond_destroy(&self->change);
    pthread_mutex_destroy(&self->lock);
    free(self);
    return NULL;
}

void reference_stop(ReferenceView *self) {
    if (!self) return;
    pthread_mutex_lock(&self->lock);
    self->quit = true;
    pthread_cond_broadcast(&self->change);
    pthread_mutex_unlock(&self->lock);
    pthread_join(self->thread, NULL);
    weft_render_free(self->render);
    weft_image_free(&self->reference);
    weft_image_free(&self->compared);
    weft_image_free(&self->picture.image);
    weft_image_free(&self->linear);
    weft_image_free(&self->denoised);
    pthread_mutex_destroy(&self->lock);
    pthread_cond_destroy(&self->change);
    free(self);
}

void reference_pause(ReferenceView *self) {
    pthread_mutex_lock(&self->lock);
    self->waiting = true;
    while (self->running) pthread_cond_wait(&self->change, &self->lock);
    self->paused = true;
    pthread_mutex_unlock(&self->lock);
}

/* Forgets the picture to compare with; the lock is held. */
static void outdate(ReferenceView *self) {
    weft_image_free(&self->reference);
    self->outdated = true;
}

void reference_resume(ReferenceView *self, const WeftScene *scene, unsigned changed) {
    pthread_mutex_lock(&self->lock);
    self->paused = self->waiting = false;
    if (scene != self->scene) self->other = true;
    if (scene != self->scene || changed) {
        self->picture.failure[0] = '\0';
        self->state = 0;
        outdate(self);
    }
    self->scene = scene;
    self->changed |= changed;
    pthread_cond_broadcast(&self->change);
    pthread_mutex_unlock(&self->lock);
}

void reference_set_state(ReferenceView *self, unsigned state) {
    pthread_mutex_lock(&self->lock);
    if (state != self->state) {
        self->state = state;
        if (!self->picture.failure[0]) self->number++; /* the picture is published once more with this number */
        pthread_cond_broadcast(&self->change);
    }
    pthread_mutex_unlock(&self->lock);
}

unsigned reference_request(ReferenceView *self, const ReferenceRequest *request) {
    pthread_mutex_lock(&self->lock);
    if (memcmp((const char *)&self->request, (const char *)request, sizeof *request) != 0) {
        bool same = self->request.wanted == request->wanted && self->request.difference == request->difference;
        bool moved = !same_view(&self->request, request);
        if (moved) weft_image_free(&self->linear);
        if (moved || !same) {
            self->view++;
            outdate(self);
        }
        self->request = *request;
        self->number++;
        self->picture.failure[0] = '\0';
        pthread_cond_broadcast(&self->change);
    }
    unsigned view = self->view;
    pthread_mutex_unlock(&self->lock);
    return view;
}

void reference_stand_in(ReferenceView *self, unsigned number) {
    pthread_mutex_lock(&self->lock);
    self->number_for = number;
    pthread_cond_broadcast(&self->change);
    pthread_mutex_unlock(&self->lock);
}

void reference_wait(ReferenceView *self, unsigned number, double seconds) {
    struct timespec until = clock_after(seconds);
    int late = 0;
    pthread_mutex_lock(&self->lock);
    while (self->number_for == number && self->picture.number != number && !self->picture.failure[0] && !late)
        late = pthread_cond_timedwait(&self->change, &self->lock, &until);
    pthread_mutex_unlock(&self->lock);
}

void reference_set_comparison(ReferenceView *self, unsigned view, WeftImage *linear) {
    pthread_mutex_lock(&self->lock);
    if (view == self->view) {
        weft_image_free(&self->reference);
        self->reference = *linear;
        *linear = (WeftImage){0};
        pthread_cond_broadcast(&self->change);
    } else {
        weft_image_free(linear);
    }
    pthread_mutex_unlock(&self->lock);
}

bool reference_take_frame(ReferenceView *self, ReferenceFrame *picture) {
    pthread_mutex_lock(&self->lock);
    bool fresh = self->fresh;
    if (fresh) {
        *picture = self->picture;
        self->picture.image = (WeftImage){0};
        self->fresh = false;
    }
    pthread_mutex_unlock(&self->lock);
    return fresh;
}

bool reference_has_frame(ReferenceView *self) {
    pthread_mutex_lock(&self->lock);
    bool fresh = self->fresh;
    pthread_mutex_unlock(&self->lock);
    return fresh;
}

bool reference_image(ReferenceView *self, WeftImage *out) {
    pthread_mutex_lock(&self->lock);
    const WeftImage *from = &self->linear;
    bool there = from->pixels && weft_image_create(from->width, from->height, 4, WEFT_PIXEL_F32, out, NULL) == WEFT_OK;
    if (there) memcpy(out->pixels, from->pixels, (size_t)from->width * (size_t)from->height * 4 * sizeof(float));
    pthread_mutex_unlock(&self->lock);
    return there;
}

bool reference_is_idle(ReferenceView *self) {
    pthread_mutex_lock(&self->lock);
    bool resting = !self->running && !has_work(self) && !is_spare(self);
    pthread_mutex_unlock(&self->lock);
    return resting;
}
