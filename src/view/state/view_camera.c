#include "view/state/view_camera.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "view/state/states.h"

void camera_set(Viewer *v, const Orbit *orbit) {
    v->states->camera.orbit = *orbit;
    v->states->camera.found = false;
}

/* Sets the centre of the scene, and its size: half the distance of the camera. */
static void set_home(Viewer *v, const float eye[3], const float target[3]) {
    memcpy(v->states->camera.home, target, sizeof v->states->camera.home);
    v->states->camera.reach = 0.0f;
    for (int k = 0; k < 3; k++) v->states->camera.reach = hypotf(v->states->camera.reach, eye[k] - target[k]);
    v->states->camera.reach = fmaxf(0.5f * v->states->camera.reach, 1e-3f);
}

void camera_begin(Viewer *v, const WeftScene *scene, const char *name) {
    if (!orbit_at(&v->states->camera.orbit, scene, name, viewer_aspect(v))) {
        viewer_report(v, true, "%.100s: %s", name, weft_message_text(WEFT_MESSAGE_CAMERA_NAME));
        orbit_at(&v->states->camera.orbit, scene, "auto", viewer_aspect(v));
    }
    v->states->camera.at_home = v->states->camera.found = false;
    set_home(v, v->states->camera.orbit.eye, v->states->camera.orbit.target);
}

void camera_frame_all(Viewer *v) {
    if (v->shown->any)
        orbit_frame(&v->states->camera.orbit, v->shown->facts.info.low, v->shown->facts.info.high, viewer_aspect(v));
}

void camera_stand_at(Viewer *v, const char *name) {
    snprintf(v->states->camera.orbit.name, sizeof v->states->camera.orbit.name, "%s", name);
    v->states->camera.found = false;
}

void camera_reset(Viewer *v) { camera_stand_at(v, v->shown->facts.info.camera_count ? "0" : "auto"); }

void camera_found(Viewer *v, const RenderedFrame *frame) {
    CameraState *camera = &v->states->camera;
    const Orbit before = camera->orbit;
    memcpy(camera->orbit.eye, frame->eye, sizeof frame->eye);
    memcpy(camera->orbit.target, frame->target, sizeof frame->target);
    if (frame->fov > 0.0f) camera->orbit.fov = frame->fov;
    if (camera->found) photographs_reframed(v, &before);
    camera->found = true;
    if (camera->at_home || !frame->focused) return;
    camera->at_home = true;
    set_home(v, frame->eye, frame->target);
}
