/* Sends requests to the renderer and the path tracer, and takes their results. */
#define _POSIX_C_SOURCE 200809L
#include "view/frame_requests.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/steady_clock.h"
#include "view/opening.h"

static void add_warnings(Viewer *v, const char *lines) {
    size_t used = strlen(v->warnings);
    if (lines) snprintf(v->warnings + used, sizeof v->warnings - used, "%s", lines);
}

static bool same_request(const FrameRequest *a, const FrameRequest *b) {
    WeftRasterView x = a->view, y = b->view;
    x.camera = y.camera = NULL;
    bool same = a->split == b->split && a->scene == b->scene && a->tonemap == b->tonemap &&
                a->reference == b->reference && a->compare == b->compare &&
                strcmp(a->camera, b->camera) == 0 &&
                memcmp((const char *)&x, (const char *)&y, sizeof x) == 0 &&
                memcmp((const char *)a->behind, (const char *)b->behind, sizeof a->behind) == 0;
    return same && !(a->at < b->at) && !(a->at > b->at) && !(a->exposure < b->exposure) &&
           !(a->exposure > b->exposure);
}

/* Both states and how they are seen; the states are borrowed. */
static FrameRequest make_request(const Viewer *v) {
    FrameRequest request = {.scene = v->scene,
                            .edited = v->side,
                            .split = v->split,
                            .at = v->split_at,
                            .tonemap = v->tonemap,
                            .exposure = v->exposure};
    request.state = v->side == 0 || v->split == SPLIT_NONE ? v->state : v->other;
    request.other = v->side == 0 || v->split == SPLIT_NONE ? v->other : v->state;
    request.view.width = (int)fmaxf(v->stage.width, 16.0f);
    request.view.height = (int)fmaxf(v->stage.height, 16.0f);
    static const float dark[3] = {0.0219f, 0.0219f, 0.0246f};
    bool color = v->background == WEFT_BACKGROUND_COLOR;
    request.view.background = color ? WEFT_BACKGROUND_TRANSPARENT : v->background;
    request.view.floor = v->floor;
    request.view.hide_lights = v->hide_lights;
    request.view.part = v->part;
    request.view.ambient = v->ambient;
    request.reference = v->mode != MODE_LIVE;
    request.compare = v->mode == MODE_DIFFERENCE;
    if (v->mode != MODE_LIVE) {
        request.split = SPLIT_NONE;
        request.edited = 0;
        request.state = v->state;
        request.view.part = WEFT_PART_ALL;
    }
    request.laid_behind = color && request.view.part == WEFT_PART_ALL;
    memcpy(request.behind, request.laid_behind ? v->background_color : dark, sizeof request.behind);
    orbit_text(&v->orbit, request.camera);
    return request;
}

static void request_reference(Viewer *v, const FrameRequest *request) {
    ReferenceRequest t;
    memset(&t, 0, sizeof t); /* compared byte by byte */
    t.wanted = v->mode != MODE_LIVE && v->has_scene;
    t.desc.width = request->view.width, t.desc.height = request->view.height;
    t.desc.background = request->view.background;
    t.desc.floor = request->view.floor;
    t.desc.hide_lights = request->view.hide_lights;
    snprintf(t.camera, sizeof t.camera, "%s", request->camera);
    t.tonemap = request->tonemap, t.exposure = request->exposure;
    memcpy(t.behind, request->behind, sizeof t.behind);
    t.difference = v->mode == MODE_DIFFERENCE;
    t.samples = TRACE_SAMPLES;
    reference_request(v->reference, &t);
    bool moved = strcmp(v->request.camera, request->camera) != 0 ||
                 v->request.view.width != request->view.width ||
                 v->request.view.height != request->view.height ||
                 v->request.reference != request->reference || !scene_state_same(&v->state, &v->sent);
    if (moved) v->traced.samples = 0.0; /* until there are some of this view */
}

/* Returns true if the picture shown is of the latest request but could be drawn more finely. */
bool requests_can_refine(const Viewer *v) {
    return v->has_scene && v->rendered.number == v->requested && v->rendered.texture &&
           v->rendered.effort < EFFORT_SMOOTH;
}

/* Sends what is wanted where it is something else than before. */
void requests_send(Viewer *v) {
    if (!v->has_scene || v->stage.width < 1.0f) return;
    FrameRequest request = make_request(v);
    bool changed = v->ask || !same_request(&request, &v->request) || !scene_state_same(&v->state, &v->sent);
    if (changed) v->changed = clock_now();
    bool finer = requests_can_refine(v) && clock_now() - v->changed > 0.12;
    if (!changed && !finer) return;
    request.effort = finer ? (Effort)(v->rendered.effort + 1) : EFFORT_COARSE;
    v->requested = renderer_request(v->renderer, &request);
    request_reference(v, &request);
    scene_state_free(&v->sent);
    if (!scene_state_copy(&v->sent, &v->state)) v->sent = (SceneState){0};
    request.state = request.other = (SceneState){0};
    v->request = request;
    v->ask = false;
    if (changed) v->has_probe = false;
}

/* The place of a camera of the scene is known once a frame was drawn through it. */
void requests_read_camera(Viewer *v) {
    const RenderedFrame *p = &v->rendered;
    if (!v->orbit.name[0] || p->number != v->requested || !p->texture) return;
    memcpy(v->orbit.eye, p->eye, sizeof p->eye);
    memcpy(v->orbit.target, p->target, sizeof p->target);
    if (p->fov > 0.0f) v->orbit.fov = p->fov;
    if (v->at_home || !p->focused) return;
    v->at_home = true;
    opening_home(v, p->eye, p->target);
}

/* A newer picture is waited for a little: of what was just asked for, or of the frame before, while the
 * renderer is at this one's. So window and renderer work side by side, and no picture is more than two frames
 * behind. */
void requests_wait_frame(Viewer *v) {
    double until = clock_now() + 0.04;
    unsigned before = v->rendered.number;
    renderer_take_frame(v->renderer, &v->rendered);
    bool waits = v->has_scene && !v->late && v->mode == MODE_LIVE;
    while (waits && v->rendered.number == before && before != v->requested && clock_now() < until) {
        window_wait(v->window, 0.004);
        renderer_take_frame(v->renderer, &v->rendered);
    }
    v->late = v->rendered.number == before && before != v->requested;
}

void requests_take_reference(Viewer *v) {
    ReferenceFrame picture;
    if (!reference_take_frame(v->reference, &picture)) return;
    if (picture.image.pixels) {
        viewer_upload(&v->reference_texture, &picture.image);
        v->reference_width = picture.image.width, v->reference_height = picture.image.height;
        weft_image_free(&picture.image);
    }
    v->traced = picture;
    if (picture.failure[0]) viewer_say(v, true, "%s", picture.failure);
}

/* A step of its own. */
static void keep_step(Viewer *v) {
    history_close(&v->history);
    history_keep(&v->history, &v->state);
    history_close(&v->history);
}

static bool lit_by(const SceneState *state, const char *path) {
    return state->environment.kind == ENVIRONMENT_FILE && strcmp(state->environment.path, path) == 0;
}

/* A file that was read again makes no step of history, since its earlier contents are gone. */
static void take_light(Viewer *v, const EnvironmentState *environment) {
    if (!lit_by(&v->state, environment->path)) keep_step(v);
    if (lit_by(&v->other, environment->path))
        environment_state_take_source(&v->other.environment, environment);
    environment_state_take_source(&v->state.environment, environment);
    viewer_accept_state(v);
}

/* RenderEvent keep what was there, to be released with them. */
static void take_maps(Viewer *v, RenderEvent *event) {
    const Facts was = v->facts;
    v->facts.maps = event->maps.maps, v->facts.map_count = event->maps.map_count;
    v->facts.thumbs = event->maps.thumbs;
    event->maps.maps = was.maps, event->maps.thumbs = was.thumbs;
    viewer_show_maps(v);
}

static void take_assigned(Viewer *v, RenderEvent *event) {
    EnvironmentState environment = v->state.environment;
    if (!scene_state_same(&v->state, &event->state)) keep_step(v);
    scene_state_free(&v->state);
    v->state = event->state;
    v->state.environment = environment;
    event->state_changed = false;
    viewer_accept_state(v);
}

void requests_take_events(Viewer *v) {
    RenderEvent event;
    while (renderer_take_event(v->renderer, &event)) {
        if (event.text[0]) viewer_say(v, event.failed, "%s", event.text);
        if (event.kind == TASK_SCENE) opening_take(v, &event);
        if (event.scene != v->scene) { /* of one that is gone */
            render_event_free(&event);
            continue;
        }
        if (event.maps.maps) take_maps(v, &event);
        if (event.state_changed && event.kind == TASK_LIGHT)
            take_light(v, &event.state.environment);
        else if (event.state_changed)
            take_assigned(v, &event);
        if (event.kind == TASK_BIND_MAPS && !event.failed) folders_keep(&v->folders, event.path, -1);
        if (event.coverage) opening_varied(v, &event.coverage);
        if (event.kind == TASK_PROBE && !event.failed) {
            v->probe = event.probe;
            v->has_probe = event.probe.hit;
        }
        if (event.kind == TASK_PICK && !event.failed && event.stamp) stage_picked(v, &event);
        if (event.kind == TASK_PROFILES && event.image.pixels) {
            viewer_upload(&v->profiles_texture, &event.image);
            v->profiles_width = event.image.width, v->profiles_height = event.image.height;
            weft_image_free(&v->profiles);
            v->profiles = event.image;
            event.image = (WeftImage){0};
            v->profiles_made = true;
        }
        render_event_free(&event);
    }
    char *warnings = renderer_take_warnings(v->renderer);
    add_warnings(v, warnings);
    free(warnings);
    if (strcmp(v->shader_complaint, v->rendered.complaint) != 0) {
        memcpy(v->shader_complaint, v->rendered.complaint, sizeof v->shader_complaint);
        if (v->shader_complaint[0])
            viewer_say(v, true, "shader: %s", v->shader_complaint);
        else
            viewer_say(v, false, "shaders compile again");
    }
    if (strcmp(v->failure, v->rendered.failure) != 0) {
        memcpy(v->failure, v->rendered.failure, sizeof v->failure);
        viewer_say(v, v->failure[0] != '\0', "%s", v->failure);
    }
}
