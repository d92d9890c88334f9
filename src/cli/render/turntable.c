#include "cli/render/turntable.h"

#include "base/path.h"
#include "cli/console/interrupt.h"

WeftResult turntable_run(Job *job, WeftError *error) {
    int count = job->request->turntable;
    WeftRenderInfo first = {0};
    double seconds = 0.0;
    WeftResult result = job_open(job, error);
    for (int k = 0; k < count && result == WEFT_OK && !job->interrupted; k++) {
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
