#include "view/state/stills.h"

#include <stdio.h>
#include <string.h>

#include "view/state/states.h"

/* Forgets a picture whose scene is still to be saved. */
static void forget_due(StillsState *stills) {
    if (stills->has_due) still_discard(stills->due.scene);
    stills->has_due = false;
}

/* Returns what the window shows, in the size and quality of a choice. */
static StillDesc desc_of(const Viewer *v, const StillChoice *choice) {
    const bool color = v->options->background == WEFT_BACKGROUND_COLOR;
    StillDesc desc = {
        .choice = *choice,
        .environment = v->edit->state.environment,
        .tonemap = v->options->tonemap,
        .exposure = v->options->exposure,
        .laid_behind = color && !choice->transparent,
        .desc = {.width = choice->width,
                 .height = choice->height,
                 .background = color || choice->transparent ? WEFT_BACKGROUND_TRANSPARENT : v->options->background,
                 .floor = v->options->floor,
                 .hide_lights = v->options->hide_lights}};
    desc.desc.floor.on = choice->floor;
    memcpy(desc.desc.background_color, v->options->background_color, sizeof desc.desc.background_color);
    options_white(v->options, desc.white);
    orbit_text(&v->camera->orbit, desc.camera);
    return desc;
}

void stills_make(Viewer *v, const char *path, const StillChoice *choice) {
    StillsState *stills = &v->states->stills;
    if (stills->still || (stills->has_due && stills->scene == v->shown->number)) {
        viewer_report(v, true, "a picture is being made; cancel it, or wait for it");
        return;
    }
    StillDesc due = desc_of(v, choice);
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
