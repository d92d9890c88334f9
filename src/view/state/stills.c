#include "view/state/stills.h"

#include <stdio.h>
#include <string.h>

#include "view/state/states.h"

/* Forgets a picture whose scene is still to be saved. */
static void forget_due(StillsState *stills) {
    if (stills->has_due) still_discard(stills->due.scene);
    stills->has_due = false;
}

void stills_make(Viewer *v, const char *path, int width, int height, int samples, bool denoised, bool transparent) {
    StillsState *stills = &v->states->stills;
    const FrameRequest *shown = &v->requests->request;
    if (stills->still || (stills->has_due && stills->scene == v->shown->number)) {
        viewer_report(v, true, "a picture is being made; cancel it, or wait for it");
        return;
    }
    StillDesc due = {.environment = v->edit->state.environment,
                     .samples = samples,
                     .denoised = denoised,
                     .tonemap = v->options->tonemap,
                     .exposure = v->options->exposure,
                     .desc = {.width = width,
                              .height = height,
                              .background = transparent ? WEFT_BACKGROUND_TRANSPARENT : v->options->background,
                              .floor = shown->view.floor,
                              .hide_lights = shown->view.hide_lights}};
    memcpy(due.desc.background_color, v->options->background_color, sizeof due.desc.background_color);
    orbit_text(&v->camera->orbit, due.camera);
    snprintf(due.path, sizeof due.path, "%s", path);
    if (!weft_image_suffix_known(path)) {
        viewer_report(v, true, "%.300s: %s", path, weft_message_text(WEFT_MESSAGE_OUTPUT_SUFFIX));
        return;
    }
    if (!still_folder(due.scene)) {
        viewer_report(v, true, "no temporary folder can be made for a copy of the scene");
        return;
    }
    Task task = {.kind = TASK_COPY, .scene = v->shown->number};
    snprintf(task.path, sizeof task.path, "%s", due.scene);
    forget_due(stills); /* of a scene before this one */
    stills->due = due;
    stills->scene = v->shown->number;
    stills->has_due = renderer_add_task(v->renderer, &task);
    if (stills->has_due) return;
    still_discard(due.scene);
    viewer_report(v, true, "too much is still to be done: try again");
}

void stills_saved(Viewer *v, const char *scene, bool failed) {
    StillsState *stills = &v->states->stills;
    if (!stills->has_due || strcmp(scene, stills->due.scene) != 0) return;
    stills->has_due = false;
    stills->share = 0.0;
    if (failed) {
        still_discard(scene);
        return;
    }
    stills->still = still_start(&stills->due, v->window);
    if (!stills->still) viewer_report(v, true, "out of memory");
}

bool stills_poll(Viewer *v) {
    StillsState *stills = &v->states->stills;
    char line[512];
    bool ended;
    if (!stills->still) return false;
    const double share = still_progress(stills->still, &ended);
    const bool changed = ended || share > stills->share;
    stills->share = share;
    if (!ended) return changed;
    const bool made = still_end(stills->still, line);
    stills->still = NULL;
    viewer_report(v, !made, "%s", line);
    return true;
}

void stills_cancel(Viewer *v) {
    StillsState *stills = &v->states->stills;
    char line[512];
    if (!stills->still) return;
    still_end(stills->still, line);
    stills->still = NULL;
    viewer_report(v, false, "%s", line);
}

void stills_end(Viewer *v) {
    stills_cancel(v);
    forget_due(&v->states->stills);
}
