#include "view/state/photographs.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include <epoxy/gl.h>

#include "base/pi.h"
#include "view/files/paths.h"
#include "view/state/states.h"

void photographs_begin(Viewer *v) {
    v->states->photographs.view = (PhotographView){.at = 0.5f, .opacity = 0.5f, .size = 1.0f, .follows = true};
}

static void stop_reading(PhotographsState *self) {
    WeftImage image;
    char why[512];
    if (self->load) photograph_end(self->load, &image, why);
    if (self->load) weft_image_free(&image);
    self->load = NULL;
}

void photographs_end(Viewer *v) {
    stop_reading(&v->states->photographs);
    if (v->window) glDeleteTextures(1, &v->states->photographs.texture);
}

/* Returns the height of what the camera sees at its target, m. */
static float reach_of(const Orbit *orbit) {
    float distance = 0.0f;
    for (int k = 0; k < 3; k++) distance = hypotf(distance, orbit->eye[k] - orbit->target[k]);
    return 2.0f * distance * tanf(0.5f * orbit->fov * (float)RADIANS);
}

static void read_anew(Viewer *v) {
    PhotographsState *self = &v->states->photographs;
    stop_reading(self);
    self->tonemap = v->options->tonemap;
    self->exposure = v->options->exposure;
    self->load = photograph_start(self->path, self->tonemap, self->exposure, v->window);
    if (!self->load) viewer_report(v, true, "%.300s: out of memory", self->path);
}

void photographs_open(Viewer *v, const char *path) {
    PhotographsState *self = &v->states->photographs;
    if (strlen(path) >= sizeof self->path) return;
    memmove(self->path, path, strlen(path) + 1);
    self->linear = weft_image_suffix_linear(path) != 0;
    if (self->view.place == PHOTOGRAPH_OFF) self->view.place = PHOTOGRAPH_BESIDE;
    self->view.reach = 0.0f;
    read_anew(v);
}

void photographs_remove(Viewer *v) {
    PhotographsState *self = &v->states->photographs;
    stop_reading(self);
    self->path[0] = '\0';
    self->width = self->height = 0;
    self->view.place = PHOTOGRAPH_OFF;
}

static float within(float x, float low, float high) { return fminf(fmaxf(x, low), high); }

void photographs_set(Viewer *v, const PhotographView *view) {
    PhotographView *own = &v->states->photographs.view;
    const float now = reach_of(&v->camera->orbit);
    const bool followed = own->follows;
    *own = *view;
    if (own->follows && !followed) own->reach = now;
    if (followed && !own->follows && own->reach > 0.0f && now > 0.0f) own->size *= own->reach / now;
    own->at = within(own->at, 0.02f, 0.98f);
    own->opacity = within(own->opacity, 0.0f, 1.0f);
    own->size = within(own->size, 0.01f, 100.0f);
    own->reach = within(own->reach, 0.0f, 1e9f);
    for (int k = 0; k < 2; k++) own->shift[k] = within(own->shift[k], -10.0f, 10.0f);
}

void photographs_reach(Viewer *v, float reach) { v->states->photographs.view.reach = within(reach, 0.0f, 1e9f); }

void photographs_reframed(Viewer *v, const Orbit *before) {
    const float then = reach_of(before), now = reach_of(&v->camera->orbit);
    if (then > 0.0f) photographs_reach(v, v->states->photographs.view.reach * now / then);
}

static void take(PhotographsState *self, WeftImage *image) {
    viewer_upload(&self->texture, image);
    glBindTexture(GL_TEXTURE_2D, self->texture);
    glGenerateMipmap(GL_TEXTURE_2D);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    glBindTexture(GL_TEXTURE_2D, 0);
    self->width = image->width;
    self->height = image->height;
    weft_image_free(image);
}

bool photographs_poll(Viewer *v) {
    PhotographsState *self = &v->states->photographs;
    const bool other = self->tonemap != v->options->tonemap || self->exposure < v->options->exposure ||
                       self->exposure > v->options->exposure;
    WeftImage image;
    char why[512];
    if (!self->path[0]) return false;
    if (!self->load && self->linear && self->width && other) read_anew(v);
    if (!self->load || !photograph_done(self->load)) return false;
    const bool good = photograph_end(self->load, &image, why);
    self->load = NULL;
    if (good) {
        take(self, &image);
        if (!(self->view.reach > 0.0f)) self->view.reach = reach_of(&v->camera->orbit);
    } else {
        photographs_remove(v);
        viewer_report(v, true, "%s", why);
    }
    return true;
}

UiBox photographs_box(const Viewer *v) {
    const PhotographsState *self = v->photographs;
    const UiBox box = self->view.place == PHOTOGRAPH_BESIDE ? v->frame->beside : v->frame->stage;
    const float now = reach_of(&v->camera->orbit);
    if (!self->width || self->view.place == PHOTOGRAPH_OFF) return (UiBox){0};
    float scale = fminf(box.width / (float)self->width, box.height / (float)self->height) * self->view.size;
    if (self->view.follows && self->view.reach > 0.0f && now > 0.0f) scale *= self->view.reach / now;
    const float width = scale * (float)self->width, height = scale * (float)self->height;
    return (UiBox){box.x + 0.5f * (box.width - width) + self->view.shift[0] * box.height,
                   box.y + 0.5f * (box.height - height) + self->view.shift[1] * box.height, width, height};
}

static void draw_in(const Viewer *v, UiBox part, float opacity) {
    const float scale = ui_scale(), pad = 5.0f * scale;
    const char *name = path_name(v->photographs->path);
    const float width = ui_text_width(name) + 2.0f * pad;
    ui_clip(&part);
    ui_picture_faint(v->photographs->texture, photographs_box(v), false, opacity);
    ui_fill(
        (UiBox){part.x + part.width - width - 8.0f * scale, part.y + part.height - 30.0f * scale, width, 22.0f * scale},
        0xB0000000u);
    ui_label(part.x + part.width - width - 8.0f * scale + pad, part.y + part.height - 27.0f * scale, 0xFFFFFFFFu, name);
    ui_clip(NULL);
}

void photographs_draw(const Viewer *v) {
    const PhotographView *view = &v->photographs->view;
    const UiBox stage = v->frame->stage, beside = v->frame->beside;
    const float x = stage.x + floorf(view->at * stage.width);
    if (!v->photographs->width) return;
    switch (view->place) {
    case PHOTOGRAPH_OFF: break;
    case PHOTOGRAPH_BESIDE:
        draw_in(v, beside, 1.0f);
        ui_line(beside.x, beside.y, beside.x, beside.y + beside.height, 0xD0FFFFFFu, 1.0f);
        break;
    case PHOTOGRAPH_WIPE:
        draw_in(v, (UiBox){x, stage.y, stage.x + stage.width - x, stage.height}, 1.0f);
        ui_line(x, stage.y, x, stage.y + stage.height, 0xD0FFFFFFu, 1.0f);
        ui_disc(x, stage.y + 0.5f * stage.height, 6.0f * ui_scale(), 0xFFFFFFFFu);
        break;
    case PHOTOGRAPH_OVER: draw_in(v, stage, view->opacity); break;
    }
}
