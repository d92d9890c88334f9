#include "cli/render/turntable.h"

#include "base/path.h"
#include "cli/console/interrupt.h"
#include "weft/weft.h"

/* Finds the camera of the first picture, which a part without it does not draw. */
static WeftResult first_find(const Job *job, WeftRenderInfo *first, WeftError *error) {
    const WeftRenderDesc *desc = &job->request->desc;
    WeftCamera camera;
    WeftResult result =
        weft_scene_camera(job->scene, job_camera(job, NULL), (float)desc->width / (float)desc->height, &camera, error);
    if (result != WEFT_OK) return result;
    for (int c = 0; c < 3; c++) first->camera_eye[c] = camera.eye[c], first->camera_target[c] = camera.target[c];
    first->camera_fov = camera.fov;
    return WEFT_OK;
}

WeftResult turntable_run(Job *job, WeftError *error) {
    int count = job->request->turntable;
    WeftRenderInfo first = {0};
    double seconds = 0.0;
    WeftResult result = job_open(job, error);
    const int parts = job->request->frame_count ? job->request->frame_count : 1;
    if (result == WEFT_OK && job->request->frame_index) result = first_find(job, &first, error);
    for (int k = job->request->frame_index; k < count && result == WEFT_OK && !job->interrupted; k += parts) {
        char camera[WEFT_CAMERA_TEXT], number[PATH_NUMBER];
        if (k) weft_camera_rotated(first.camera_eye, first.camera_target, first.camera_fov, k, count, camera);
        result = job_draw(job, k ? camera : NULL, error);
        if (!k) first = job->info;
        seconds += job->info.render_seconds;
        if (result == WEFT_OK) result = job_write(job, path_number(k, count, number), error);
        job->interrupted |= interrupt_seen();
    }
    job->info.render_seconds = seconds;
    return result;
}
