#define _POSIX_C_SOURCE 200809L
#include "view/state/frame_requests.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <epoxy/gl.h>

#include "base/steady_clock.h"
#include "view/state/states.h"

void requests_due(Viewer *v) { v->states->requests.due = true; }
void requests_forget_probe(Viewer *v) { v->states->requests.has_probe = false; }
void requests_forget(Viewer *v) { scene_state_free(&v->states->requests.sent); }
void requests_end(Viewer *v) {
    if (v->window) glDeleteTextures(1, &v->states->requests.reference_texture);
}

void requests_picture_size(const Viewer *v, int *width, int *height) {
    *width = (int)fmaxf(v->frame->stage.width, 16.0f);
    *height = (int)fmaxf(v->frame->stage.height, 16.0f);
}

Shows requests_shown(const Viewer *v) {
    bool traced = v->options->mode != MODE_LIVE, instead = v->requests->traced.number > v->requests->rendered.number;
    if (v->requests->reference_texture && (traced || instead)) return SHOWS_TRACED;
    return v->requests->rendered.texture && v->requests->rendered.scene == v->shown->number ? SHOWS_DRAWN
                                                                                            : SHOWS_NOTHING;
}

const char *shows_name(Shows shows) {
    static const char *const names[] = {"nothing", "drawn", "traced"};
    return names[shows];
}

static bool same_request(const FrameRequest *a, const FrameRequest *b) {
    WeftRasterView x = a->view, y = b->view;
    x.camera = y.camera = NULL;
    bool same = a->split == b->split && a->scene == b->scene && a->tonemap == b->tonemap &&
                a->reference == b->reference && a->metered == b->metered &&
                memcmp((const char *)a->white, (const char *)b->white, sizeof a->white) == 0 &&
                a->compare == b->compare && strcmp(a->camera, b->camera) == 0 &&
                memcmp((const char *)&x, (const char *)&y, sizeof x) == 0 &&
                memcmp((const char *)a->behind, (const char *)b->behind, sizeof a->behind) == 0;
    return same && !(a->at < b->at) && !(a->at > b->at) && !(a->exposure < b->exposure) && !(a->exposure > b->exposure);
}

/* Makes a request of both states and the view; the states are borrowed. */
static FrameRequest make_request(const Viewer *v) {
    FrameRequest request = {.scene = v->shown->number,
                            .edited = v->edit->side,
                            .split = v->edit->split,
                            .at = v->options->split_at,
                            .tonemap = v->options->tonemap,
                            .exposure = v->options->exposure,
                            .metered = v->options->metered || v->options->balanced,
                            .accumulate = v->desc->accumulate};
    request.state = v->edit->side == 0 || v->edit->split == SPLIT_NONE ? v->edit->state : v->edit->other;
    request.other = v->edit->side == 0 || v->edit->split == SPLIT_NONE ? v->edit->other : v->edit->state;
    options_white(v->options, request.white);
    requests_picture_size(v, &request.view.width, &request.view.height);
    static const float dark[3] = {0.0219f, 0.0219f, 0.0246f};
    bool color = v->options->background == WEFT_BACKGROUND_COLOR;
    request.view.background = color ? WEFT_BACKGROUND_TRANSPARENT : v->options->background;
    request.view.floor = v->options->floor;
    request.view.hide_lights = v->options->hide_lights;
    request.view.part = v->options->part;
    request.view.ambient = v->options->ambient;
    request.view.bounces = v->options->bounced ? 1 : 0;
    request.reference = v->options->mode != MODE_LIVE;
    request.compare = v->options->mode == MODE_DIFFERENCE;
    if (v->options->mode != MODE_LIVE) {
        request.split = SPLIT_NONE;
        request.edited = 0;
        request.state = v->edit->state;
        request.view.part = WEFT_PART_ALL;
    }
    request.laid_behind = color && request.view.part == WEFT_PART_ALL;
    memcpy(request.behind, request.laid_behind ? v->options->background_color : dark, sizeof request.behind);
    orbit_text(&v->camera->orbit, request.camera);
    return request;
}

/* Returns the number of the view (reference_request). */
static unsigned send_reference(Viewer *v, const FrameRequest *request) {
    ReferenceRequest t;
    memset(&t, 0, sizeof t); /* compared byte by byte */
    t.wanted = v->options->mode != MODE_LIVE && v->shown->any;
    t.desc.width = request->view.width, t.desc.height = request->view.height;
    t.desc.background = request->view.background;
    t.desc.floor = request->view.floor;
    t.desc.hide_lights = request->view.hide_lights;
    t.desc.halves = t.desc.first_hits = 1; /* to show it denoised */
    snprintf(t.camera, sizeof t.camera, "%s", request->camera);
    t.tonemap = request->tonemap, t.exposure = request->exposure;
    memcpy(t.white, request->white, sizeof t.white);
    memcpy(t.behind, request->behind, sizeof t.behind);
    t.difference = v->options->mode == MODE_DIFFERENCE;
    t.samples = TRACE_SAMPLES;
    return reference_request(v->reference, &t);
}

bool requests_can_refine(const Viewer *v) {
    return v->shown->any && v->states->requests.rendered.number == v->states->requests.requested &&
           v->states->requests.rendered.texture && v->states->requests.rendered.effort < EFFORT_SMOOTH;
}

void requests_send(Viewer *v) {
    if (!v->shown->any || v->frame->stage.width < 1.0f) return;
    FrameRequest request = make_request(v);
    const FrameRequest *last = &v->states->requests.request;
    bool other_state = !scene_state_same(&v->edit->state, &v->states->requests.sent);
    bool changed = v->states->requests.due || other_state || !same_request(&request, last);
    if (changed) v->states->requests.changed = clock_now();
    bool finer = requests_can_refine(v) && clock_now() - v->states->requests.changed > 0.12;
    if (!changed && !finer) return;
    request.effort = finer ? (Effort)(v->states->requests.rendered.effort + 1) : EFFORT_COARSE;
    request.state_number = last->state_number + (other_state ? 1 : 0);
    request.view_number = send_reference(v, &request);
    if (other_state || request.view_number != last->view_number)
        v->states->requests.traced.samples = 0.0; /* until there are some of this view and state */
    v->states->requests.requested = renderer_request(v->renderer, &request);
    scene_state_free(&v->states->requests.sent);
    if (!scene_state_copy(&v->states->requests.sent, &v->edit->state)) v->states->requests.sent = (SceneState){0};
    request.state = request.other = (SceneState){0};
    v->states->requests.request = request;
    v->states->requests.due = false;
    if (changed) v->states->requests.has_probe = false;
}

void requests_read_camera(Viewer *v) {
    const RenderedFrame *p = &v->states->requests.rendered;
    if (!v->camera->orbit.name[0] || p->number != v->states->requests.requested || !p->texture) return;
    camera_found(v, p);
}

/* Takes what was metered in the picture that is seen, if it shows the last request. */
static void take_metered(Viewer *v) {
    const RenderedFrame *p = &v->states->requests.rendered;
    const bool seen = v->options->mode == MODE_LIVE && p->metered && p->number == v->states->requests.requested;
    if (seen) options_take_metered(v, p->exposure, p->white);
}

/* Waits up to 0.04 s for a picture newer than the last, which may be that of the previous frame while the renderer
 * works on this one. So window and renderer work in parallel, and no picture is more than two frames old. */
void requests_wait_frame(Viewer *v) {
    double until = clock_now() + 0.04;
    unsigned before = v->states->requests.rendered.number, faded = v->states->requests.rendered.before;
    renderer_take_frame(v->renderer, &v->states->requests.rendered);
    bool waits = v->shown->any && !v->states->requests.late && v->options->mode == MODE_LIVE;
    while (waits && v->states->requests.rendered.number == before && before != v->states->requests.requested &&
           clock_now() < until) {
        window_wait(v->window, 0.004);
        renderer_take_frame(v->renderer, &v->states->requests.rendered);
    }
    v->states->requests.late = v->states->requests.rendered.number == before && before != v->states->requests.requested;
    if (!v->states->requests.rendered.before)
        v->states->requests.glide = 0;
    else if (v->states->requests.rendered.before != faded)
        v->states->requests.glide = GLIDE - 1;
    else if (v->states->requests.glide)
        v->states->requests.glide--;
    take_metered(v);
}

float requests_glide(const Viewer *v) { return (float)v->requests->glide / (float)GLIDE; }

void requests_take_reference(Viewer *v) {
    ReferenceFrame picture;
    if (!reference_take_frame(v->reference, &picture)) return;
    if (picture.image.pixels) {
        viewer_upload(&v->states->requests.reference_texture, &picture.image);
        weft_image_free(&picture.image);
        if (v->options->mode == MODE_REFERENCE) options_take_metered(v, picture.exposure, picture.white);
    }
    const FrameRequest *last = &v->states->requests.request;
    bool current = picture.view == last->view_number && picture.state == last->state_number;
    if (!current) picture.samples = 0.0; /* they are of an earlier view or state */
    v->states->requests.traced = picture;
    if (picture.failure[0]) viewer_report(v, true, "%s", picture.failure);
}

void requests_take_events(Viewer *v) {
    RenderEvent event;
    while (renderer_take_event(v->renderer, &event)) {
        if (event.text[0]) viewer_report(v, event.failed, "%s", event.text);
        if (event.kind == TASK_SCENE) opening_take(v, &event);
        if (event.scene != v->shown->number) { /* of an earlier scene */
            render_event_free(&event);
            continue;
        }
        if (event.maps.maps) {
            opening_take_maps(v, &event);
            requests_forget(v); /* pixels differ, though the state may be the same */
        }
        if (event.state_changed && event.kind == TASK_LIGHT) {
            edit_take_light(v, &event.state.environment);
        } else if (event.state_changed) {
            edit_take_assigned(v, &event.state, event.stamp);
            event.state_changed = false;
        }
        if (event.kind == TASK_ASSIGN || event.kind == TASK_WEAVE || event.kind == TASK_WEAVE_KEY)
            edit_end_assign(v, event.stamp);
        if (event.kind == TASK_SAVE) edit_end_saving(v, event.stamp, event.failed), leaving_saved(v, event.failed);
        if (event.kind == TASK_COPY)
            stills_saved(v, event.path, event.failed), bakings_copied(v, event.path, event.failed);
        if (event.kind == TASK_BIND_MAPS && !event.failed) opening_keep_folder(v, event.path);
        if (event.coverage) opening_varied(v, &event.coverage);
        if (event.kind == TASK_PROBE && !event.failed) {
            v->states->requests.probe = event.probe;
            v->states->requests.has_probe = event.probe.hit;
        }
        if (event.kind == TASK_PICK && !event.failed && event.stamp) stage_picked(v, &event);
        if (event.kind == TASK_PROFILES && event.image.pixels) dialogs_take_profiles(v, &event.image);
        render_event_free(&event);
    }
    char *warnings = renderer_take_warnings(v->renderer);
    opening_warn(v, warnings);
    free(warnings);
    if (strcmp(v->states->requests.shader_complaint, v->states->requests.rendered.complaint) != 0) {
        memcpy(v->states->requests.shader_complaint, v->states->requests.rendered.complaint,
               sizeof v->states->requests.shader_complaint);
        if (v->states->requests.shader_complaint[0])
            viewer_report(v, true, "shader: %s", v->states->requests.shader_complaint);
        else
            viewer_report(v, false, "shaders compile again");
    }
    if (strcmp(v->states->requests.failure, v->states->requests.rendered.failure) != 0) {
        memcpy(v->states->requests.failure, v->states->requests.rendered.failure, sizeof v->states->requests.failure);
        viewer_report(v, v->states->requests.failure[0] != '\0', "%s", v->states->requests.failure);
    }
}
