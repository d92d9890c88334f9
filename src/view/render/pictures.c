/* Pictures: applies the state of a request, chooses the quality, and draws into the textures of the ring. */
#define _POSIX_C_SOURCE 200809L
#include "view/render/renderer_state.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include <epoxy/gl.h>

#include "base/steady_clock.h"

enum { COARSE_MOST = 8 }; /* greatest `coarse` */

static const double frame_seconds = 0.036; /* s, for a picture while the mouse moves */

/* Returns the index of a texture that is neither shown nor newest, and gives it this size. */
static int take_target(Renderer *self, int width, int height) {
    int k = 0;
    pthread_mutex_lock(&self->lock);
    while (k == self->newest || k == self->shown || k == self->before) k++;
    pthread_mutex_unlock(&self->lock);
    if (!self->textures[k]) {
        glGenTextures(1, &self->textures[k]);
        glGenFramebuffers(1, &self->targets[k]);
    }
    if (self->widths[k] != width || self->heights[k] != height) {
        glBindTexture(GL_TEXTURE_2D, self->textures[k]);
        glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, NULL);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
        glBindFramebuffer(GL_FRAMEBUFFER, self->targets[k]);
        glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, self->textures[k], 0);
        glBindTexture(GL_TEXTURE_2D, 0);
        glBindFramebuffer(GL_FRAMEBUFFER, 0);
        self->widths[k] = width, self->heights[k] = height;
    }
    return k;
}

/* Reads the state back from the scene after `wanted` could not be applied. */
static bool read_again(Renderer *self, const SceneState *wanted, SceneState *is) {
    if (!scene_state_read(is, self->scene)) return false;
    is->environment = self->is.environment;
    scene_state_take_naps(is, wanted);
    return true;
}

const char *frame_refusal(const Renderer *self, const SceneState *state) {
    return self->refusal[0] && environment_state_same_source(&state->environment, &self->refused) ? self->refusal
                                                                                                  : NULL;
}

/* Applies an environment. If its source cannot be read, the source before stays, and the reason is kept. */
static WeftResult apply_environment(Renderer *self, EnvironmentState *environment, unsigned *changed,
                                    WeftError *error) {
    const WeftLog log = renderer_log(self);
    WeftError refusal = {0};
    WeftResult result =
        environment_state_apply(environment, &self->is.environment, self->scene, changed, &log, &refusal);
    if (result == WEFT_OK) return WEFT_OK;
    self->refused = *environment;
    snprintf(self->refusal, sizeof self->refusal, "%s", refusal.text);
    environment_state_take_source(environment, &self->is.environment);
    return environment_state_apply(environment, &self->is.environment, self->scene, changed, &log, error);
}

WeftResult frame_apply_state(Renderer *self, const SceneState *wanted, WeftError *error) {
    const WeftLog log = renderer_log(self);
    unsigned changed = 0;
    SceneState is, parts = *wanted, *state = &parts;                         /* a shallow copy */
    if (state->material_count != self->is.material_count) return WEFT_INPUT; /* of another scene */
    if (frame_refusal(self, state)) environment_state_take_source(&state->environment, &self->is.environment);
    if (scene_state_same(state, &self->is)) return WEFT_OK;
    reference_pause(self->reference);
    WeftResult result = scene_state_apply(state, &self->is, &self->naps, self->scene, &changed, error);
    if (result == WEFT_OK) result = apply_environment(self, &state->environment, &changed, error);
    bool copied = result == WEFT_OK ? scene_state_copy(&is, state) : read_again(self, state, &is);
    if (changed & WEFT_CHANGED_SHAPES) {
        weft_pick_free(self->pick);
        self->pick = NULL;
    }
    reference_resume(self->reference, self->scene, changed);
    if (!copied) return WEFT_RESOURCES;
    scene_state_free(&self->is);
    self->is = is;
    WeftResult updated = weft_raster_update(self->raster, &log, result == WEFT_OK ? error : NULL);
    return result == WEFT_OK ? updated : result;
}

/* Draws one state into the rectangle `part` of a picture: x, y, width, height. */
static WeftResult draw_one(Renderer *self, const FrameRequest *request, const SceneState *state, const int part[4],
                           int target, WeftError *error) {
    WeftRasterView view = request->view;
    view.camera = request->camera;
    bool sides = request->split == SPLIT_SIDES, numeric = request->view.part >= WEFT_PART_BASE_COLOR;
    int height = request->view.height;
    WeftResult result = frame_apply_state(self, state, error);
    if (sides) view.width = request->view.width / 2;
    const int crop[4] = {sides ? 0 : part[0], part[1], sides && part[2] > view.width ? view.width : part[2], part[3]};
    memcpy(view.crop, crop, sizeof view.crop);
    if (result == WEFT_OK) result = weft_raster_draw(self->raster, &view, error);
    const WeftRasterShow show = {.framebuffer = self->targets[target],
                                 .x = sides ? part[0] : 0,
                                 .clip = {part[0], height - part[1] - part[3], part[2], part[3]},
                                 .background = {request->behind[0], request->behind[1], request->behind[2]},
                                 .tonemap = numeric ? WEFT_TONEMAP_NONE : request->tonemap,
                                 .exposure = numeric ? 0.0f : request->exposure,
                                 .white = {numeric ? 0.0f : request->white[0], numeric ? 0.0f : request->white[1]}};
    return result == WEFT_OK ? weft_raster_show(self->raster, &show, error) : result;
}

static bool is_outdated(Renderer *self, unsigned number) {
    pthread_mutex_lock(&self->lock);
    bool outdated = self->quit || self->pending_scene || self->number != number;
    pthread_mutex_unlock(&self->lock);
    return outdated;
}

/* Draws part of a picture in strips of rows. A strip takes about `piece` seconds, so that another request does not wait
 * long, nor does the window if the driver draws for one context at a time. Time grows less than in proportion to the
 * rows; their number is therefore found by doubling and halving. *whole becomes false if newer work stops it. */
static WeftResult draw_part(Renderer *self, const FrameRequest *request, const SceneState *state, const int part[4],
                            unsigned number, int target, double expected, bool *whole, WeftError *error) {
    const double piece = 0.05;
    int height = part[3], y = 0;
    int rows = expected < 3.0 * piece ? height : (int)(height * piece / expected);
    WeftResult result = WEFT_OK;
    while (y < height && result == WEFT_OK && *whole) {
        double start = clock_now();
        int left = height - y;
        if (rows < 8) rows = 8;
        if (request->compare || request->metered || rows > left || left - rows < rows / 4) rows = left;
        const int strip[4] = {part[0], part[1] + y, part[2], rows};
        result = draw_one(self, request, state, strip, target, error);
        glFinish();
        y += rows;
        double took = clock_now() - start;
        if (took < 1.5 * piece) rows *= 2;
        if (took > 2.0 * piece) rows /= 2;
        if (y < height) *whole = !is_outdated(self, number);
    }
    return result;
}

/* Draws the states of a request, each in all its strips before the next, since to change the state may take long. */
static WeftResult draw_picture(Renderer *self, const FrameRequest *request, unsigned number, int target,
                               double expected, bool *whole, WeftError *error) {
    int width = request->view.width, height = request->view.height, middle = width / 2;
    *whole = true;
    const int all[4] = {0, 0, width, height};
    if (request->split == SPLIT_NONE)
        return draw_part(self, request, &request->state, all, number, target, expected, whole, error);
    if (request->split == SPLIT_LINE) middle = (int)(request->at * (float)width);
    middle = middle < 1 ? 1 : middle > width - 1 ? width - 1 : middle;
    const int left[4] = {0, 0, middle, height}, right[4] = {middle, 0, width - middle, height};
    bool last = request->edited == 1; /* the edited state is drawn last, so that tasks find it applied */
    WeftResult result = draw_part(self, request, last ? &request->state : &request->other, last ? left : right, number,
                                  target, 0.5 * expected, whole, error);
    if (result != WEFT_OK || !*whole) return result;
    return draw_part(self, request, last ? &request->other : &request->state, last ? right : left, number, target,
                     0.5 * expected, whole, error);
}

/* Returns true if frames are summed for a request: of one state, where OpenGL shows it. */
static bool is_summed(const FrameRequest *request) {
    return request->accumulate && request->split == SPLIT_NONE && !request->reference && !request->compare;
}

/* Returns the effort that fits the time: smooth edges to compare with, if they take no longer than a frame may, or
 * if they are requested and no sum of frames will have them; else all pixels if they are requested or quick enough. */
static Effort effort_of(const Renderer *self, const FrameRequest *request) {
    if (request->compare || self->smooth_seconds < frame_seconds) return EFFORT_SMOOTH;
    if (request->effort == EFFORT_SMOOTH && !is_summed(request)) return EFFORT_SMOOTH;
    return request->effort > EFFORT_COARSE || self->coarse == 1 ? EFFORT_WHOLE : EFFORT_COARSE;
}

static FrameRequest with_effort(const Renderer *self, const FrameRequest *request, Effort effort) {
    FrameRequest drawn = *request; /* a shallow copy */
    if (effort < EFFORT_SMOOTH) drawn.view.samples = 1;
    if (effort == EFFORT_COARSE) drawn.view.shading_rate = self->coarse;
    return drawn;
}

static double *seconds_of(Renderer *self, Effort effort) {
    return effort == EFFORT_SMOOTH  ? &self->smooth_seconds
           : effort == EFFORT_WHOLE ? &self->whole_seconds
                                    : &self->coarse_seconds;
}

/* Updates the estimates by the time that a picture took: the time of its effort, and how coarse pictures have to be
 * while the mouse moves. A time far above the last does not count unless the next is too, since drivers compile as they
 * draw. */
static void learn(Renderer *self, const FrameRequest *request, Effort effort, double seconds) {
    double *measured = seconds_of(self, effort);
    self->surprised = !self->surprised && seconds > 3.0 * *measured;
    if (self->surprised) return;
    *measured = seconds;
    if (effort == EFFORT_WHOLE && !self->smooth_timed) self->smooth_seconds = 4.0 * seconds;
    self->smooth_timed |= effort == EFFORT_SMOOTH;
    if (request->effort != EFFORT_COARSE || effort == EFFORT_SMOOTH) return;
    double finer = self->coarse > 1 ? (double)self->coarse / (self->coarse - 1) : 1.0;
    if (seconds > frame_seconds && self->coarse < COARSE_MOST)
        self->coarse++;
    else if (self->coarse > 1 && seconds * finer * finer < frame_seconds)
        self->coarse--;
}

/* Moves the target of a camera of the scene to the surface in the middle of the picture, for orbits about it. A camera
 * given as numbers, with ';' between them, has a target already. */
static void focus(Renderer *self, const FrameRequest *request) {
    WeftPicked at;
    RenderedFrame seen = self->rendered; /* this thread alone writes it */
    RenderedFrame *p = &seen;
    float d[3], n = 0.0f;
    if (strchr(request->camera, ';')) return;
    if (!self->pick && weft_pick_create(self->scene, &self->pick, NULL) != WEFT_OK) return;
    int width = request->view.width, height = request->view.height;
    bool hit =
        weft_pick_at(self->pick, request->camera, width, height, 0.5f * (float)width, 0.5f * (float)height, &at) != 0;
    for (int k = 0; k < 3; k++) {
        d[k] = p->target[k] - p->eye[k];
        n += d[k] * d[k];
    }
    pthread_mutex_lock(&self->lock);
    for (int k = 0; k < 3 && hit && n > 0.0f; k++) self->rendered.target[k] = p->eye[k] + at.distance / sqrtf(n) * d[k];
    self->rendered.focused = true;
    self->fresh = true;
    pthread_mutex_unlock(&self->lock);
    window_wake(self->window);
}

static void publish(Renderer *self, const FrameRequest *request, Effort effort, unsigned number, int target,
                    double seconds, const WeftError *error) {
    WeftRasterInfo info = weft_raster_info(self->raster);
    pthread_mutex_lock(&self->lock);
    RenderedFrame *p = &self->rendered;
    if (target >= 0) {
        p->texture = self->textures[target];
        p->scene = request->scene;
        p->width = request->view.width, p->height = request->view.height;
        p->seconds = (float)seconds;
        p->whole_seconds = (float)self->whole_seconds;
        self->newest = target;
    }
    p->summed = self->summed;
    p->sum_frames = self->sums ? request->accumulate : 0;
    p->number = number;
    p->effort = target >= 0 ? effort : EFFORT_SMOOTH; /* the window need not request a finer one */
    memcpy(p->eye, info.camera_eye, sizeof p->eye);
    memcpy(p->target, info.camera_target, sizeof p->target);
    p->fov = info.camera_fov;
    p->focused = strchr(request->camera, ';') != NULL;
    p->programs = info.programs, p->compiled = info.compiled;
    p->busy = info.making != 0;
    snprintf(p->complaint, sizeof p->complaint, "%s", info.complaint);
    snprintf(p->failure, sizeof p->failure, "%s", error->text);
    snprintf(p->driver, sizeof p->driver, "%s", info.driver);
    self->fresh = true;
    pthread_mutex_unlock(&self->lock);
    window_wake(self->window);
}

/* Publishes a mean of frames in place of the picture of the same request. */
static void publish_sum(Renderer *self, const FrameRequest *request, int target) {
    pthread_mutex_lock(&self->lock);
    RenderedFrame *p = &self->rendered;
    p->texture = self->textures[target];
    p->width = request->view.width, p->height = request->view.height;
    p->summed = self->summed;
    p->sum_frames = request->accumulate;
    self->newest = target;
    self->fresh = true;
    pthread_mutex_unlock(&self->lock);
    window_wake(self->window);
}

/* Hands a linear copy of the picture to the path tracer, to compare with. */
static void hand_linear(Renderer *self, const FrameRequest *request) {
    WeftImage linear;
    if (weft_raster_image(self->raster, &linear, NULL) == WEFT_OK)
        reference_set_comparison(self->reference, request->view_number, &linear);
}

/* Returns true if no finer picture of a request follows. Only such a one is metered: a coarser one has another exposure,
 * and the two would follow each other without end. */
static bool is_best(const FrameRequest *request, Effort effort) {
    return effort == EFFORT_SMOOTH || (effort == EFFORT_WHOLE && is_summed(request));
}

/* Meters the picture that was drawn last, with all of its rows. */
static void meter(Renderer *self) {
    WeftImage linear;
    if (weft_raster_image(self->raster, &linear, NULL) != WEFT_OK) return;
    float white[2];
    const float stops = weft_image_meter(&linear);
    weft_image_find_white(&linear, white);
    weft_image_free(&linear);
    pthread_mutex_lock(&self->lock);
    self->rendered.metered = true;
    self->rendered.exposure = stops;
    memcpy(self->rendered.white, white, sizeof white);
    pthread_mutex_unlock(&self->lock);
}

/* Returns true if the path tracer is to stand in for a whole picture whose shaders are not compiled yet. */
static bool needs_stand_in(Renderer *self, const FrameRequest *request) {
    WeftRasterView view = request->view;
    view.camera = request->camera;
    bool whole = request->split == SPLIT_NONE && view.part == WEFT_PART_ALL && !request->reference;
    return whole && !weft_raster_ready(self->raster, &view);
}

const SceneState *frame_edited_state(const FrameRequest *request) {
    return request->edited && request->split != SPLIT_NONE ? &request->other : &request->state;
}

/* Sends the coverage by each material if the edited state is applied and its variant is new. */
static void survey(Renderer *self, const FrameRequest *request) {
    int variant = self->is.variant;
    if (self->surveyed == variant || frame_edited_state(request)->variant != variant) return;
    self->surveyed = variant;
    tasks_survey(self, request);
}

static void draw(Renderer *self, const FrameRequest *request, unsigned number) {
    WeftError error = {0};
    int target = -1, compiled = weft_raster_info(self->raster).compiled;
    bool whole = true;
    Effort effort = effort_of(self, request);
    FrameRequest drawn = with_effort(self, request, effort);
    double expected = *seconds_of(self, effort);
    self->sums = self->sum_begun = false;
    self->summed = 0;
    WeftResult result = frame_apply_state(self, &request->state, &error);
    bool edited = frame_edited_state(request) == &request->state;
    reference_set_state(self->reference, edited ? request->state_number : 0);
    survey(self, request);
    double start = clock_now();
    if (needs_stand_in(self, &drawn)) {
        reference_stand_in(self->reference, number);
        reference_wait(self->reference, number, 1.0); /* before the compiler takes most of the processors */
    }
    if (!request->reference || request->compare) {
        target = take_target(self, drawn.view.width, drawn.view.height);
        WeftResult done =
            draw_picture(self, &drawn, number, target, expected, &whole, result == WEFT_OK ? &error : NULL);
        if (result == WEFT_OK) result = done;
        if (done == WEFT_OK && request->compare) hand_linear(self, request);
        if (done == WEFT_OK && request->metered && is_best(request, effort)) meter(self);
        if (done != WEFT_OK) target = -1;
        bool fair = done == WEFT_OK && whole && weft_raster_info(self->raster).compiled == compiled;
        if (fair) learn(self, request, effort, clock_now() - start);
    }
    if (!whole) return; /* interrupted by another request */
    const char *refusal = frame_refusal(self, &request->state);
    if (result == WEFT_OK) snprintf(error.text, sizeof error.text, "%s", refusal ? refusal : "");
    bool best = is_best(request, effort) || request->reference;
    self->sums = best && result == WEFT_OK && is_summed(request);
    self->drawn_at = clock_now();
    publish(self, request, best ? EFFORT_SMOOTH : effort, number, target, clock_now() - start, &error);
    focus(self, request);
}

void frame_draw(Renderer *self, const FrameRequest *request, unsigned number) {
    draw(self, request, number);
    reference_stand_in(self->reference, 0);
    survey(self, request);
}

/* Shows the mean of the frames so far. */
static WeftResult show_sum(Renderer *self, const FrameRequest *request, WeftError *error) {
    const int target = take_target(self, request->view.width, request->view.height);
    const bool numeric = request->view.part >= WEFT_PART_BASE_COLOR;
    const WeftRasterShow show = {.framebuffer = self->targets[target],
                                 .background = {request->behind[0], request->behind[1], request->behind[2]},
                                 .tonemap = numeric ? WEFT_TONEMAP_NONE : request->tonemap,
                                 .exposure = numeric ? 0.0f : request->exposure,
                                 .white = {numeric ? 0.0f : request->white[0], numeric ? 0.0f : request->white[1]}};
    const WeftResult result = weft_raster_show(self->raster, &show, error);
    glFinish();
    if (result == WEFT_OK) publish_sum(self, request, target);
    return result;
}

void frame_sum(Renderer *self) {
    const FrameRequest *request = &self->drawn;
    WeftRasterView view = request->view;
    WeftError error = {0};
    WeftResult result = WEFT_OK;
    int done = 0;
    view.camera = request->camera;
    if (!self->sum_begun) {
        result = weft_raster_accumulate_begin(self->raster, &view, request->accumulate, &error);
        self->summed = 0;
    } else if (weft_raster_accumulate(self->raster, 0.0, &done, NULL) != WEFT_OK) {
        self->sum_begun = false; /* a task has drawn something else */
        return;
    }
    self->sum_begun = result == WEFT_OK;
    if (result == WEFT_OK && done > self->summed) {
        self->summed = done;
        result = show_sum(self, request, &error);
    }
    self->sums = result == WEFT_OK && self->summed < request->accumulate;
    if (result != WEFT_OK) renderer_log(self).fn(self, error.message, error.text); /* the picture stays as it is */
}
