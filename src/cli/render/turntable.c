#include "cli/render/turntable.h"
#include "base/pi.h"

#include <math.h>
#include <stdio.h>

#include "cli/console/interrupt.h"

/* Writes the camera of picture k of `count`, which rotates that of the first about its target. */
static void rotated_camera(const WeftRenderInfo *first, int k, int count, char camera[256]) {
    const float *e = first->camera_eye, *t = first->camera_target;
    double angle = 2.0 * PI_DOUBLE * k / count, c = cos(angle), s = sin(angle);
    double x = (double)e[0] - (double)t[0], z = (double)e[2] - (double)t[2];
    snprintf(camera, 256, "%.9g,%.9g,%.9g;%.9g,%.9g,%.9g;%.9g", (double)t[0] + c * x + s * z, (double)e[1],
             (double)t[2] - s * x + c * z, (double)t[0], (double)t[1], (double)t[2], (double)first->camera_fov);
}

WeftResult turntable_run(Job *job, WeftError *error) {
    int count = job->request->turntable;
    WeftRenderInfo first = {0};
    double seconds = 0.0;
    WeftResult result = job_open(job, error);
    for (int k = 0; k < count && result == WEFT_OK && !job->interrupted; k++) {
        char camera[256], number[16];
        if (k) rotated_camera(&first, k, count, camera);
        result = job_draw(job, k ? camera : NULL, error);
        if (!k) first = job->info;
        seconds += job->info.render_seconds;
        snprintf(number, sizeof number, "%0*d", count > 1000 ? 4 : 3, k);
        if (result == WEFT_OK) result = job_write(job, number, error);
        job->interrupted |= interrupt_seen();
    }
    job->info.render_seconds = seconds;
    return result;
}
