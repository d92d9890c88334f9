/* The camera that the scene is seen through. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "view/state/rooms.h"

void camera_set(Viewer *v, const Orbit *orbit) { v->rooms->camera.orbit = *orbit; }

/* Sets the centre of the scene, and its size: half the distance of the camera. */
static void set_home(Viewer *v, const float eye[3], const float target[3]) {
    memcpy(v->rooms->camera.home, target, sizeof v->rooms->camera.home);
    v->rooms->camera.reach = 0.0f;
    for (int k = 0; k < 3; k++) v->rooms->camera.reach = hypotf(v->rooms->camera.reach, eye[k] - target[k]);
    v->rooms->camera.reach = fmaxf(0.5f * v->rooms->camera.reach, 1e-3f);
}

/* Sets the first camera, and the size of things until the renderer knows the centre of the picture. */
void camera_begin(Viewer *v, const WeftScene *scene, const char *name) {
    if (!orbit_at(&v->rooms->camera.orbit, scene, name, viewer_aspect(v))) {
        viewer_say(v, true, "%.100s: %s", name, weft_message_text(WEFT_MESSAGE_CAMERA_NAME));
        orbit_at(&v->rooms->camera.orbit, scene, "auto", viewer_aspect(v));
    }
    v->rooms->camera.at_home = false;
    set_home(v, v->rooms->camera.orbit.eye, v->rooms->camera.orbit.target);
}

void viewer_frame_selection(Viewer *v) {
    if (v->shown->any)
        orbit_frame(&v->rooms->camera.orbit, v->shown->facts.info.low, v->shown->facts.info.high,
                    viewer_aspect(v));
}

void camera_stand_at(Viewer *v, const char *name) {
    snprintf(v->rooms->camera.orbit.name, sizeof v->rooms->camera.orbit.name, "%s", name);
}

void viewer_reset_camera(Viewer *v) { camera_stand_at(v, v->shown->facts.info.camera_count ? "0" : "auto"); }

void camera_found(Viewer *v, const RenderedFrame *frame) {
    CameraRoom *camera = &v->rooms->camera;
    memcpy(camera->orbit.eye, frame->eye, sizeof frame->eye);
    memcpy(camera->orbit.target, frame->target, sizeof frame->target);
    if (frame->fov > 0.0f) camera->orbit.fov = frame->fov;
    if (camera->at_home || !frame->focused) return;
    camera->at_home = true;
    set_home(v, frame->eye, frame->target);
}
