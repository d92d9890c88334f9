#include "view/state/stills.h"

#include <stdio.h>
#include <string.h>

#include "view/state/states.h"

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
    if (stills->still || copy_is_due(v, &stills->copy)) {
        viewer_report(v, true, "a picture is being made; cancel it, or wait for it");
        return;
    }
    StillDesc due = desc_of(v, choice);
    snprintf(due.path, sizeof due.path, "%s", path);
    if (!weft_image_suffix_known(path)) {
        viewer_report(v, true, "%.300s: %s", path, weft_message_text(WEFT_MESSAGE_OUTPUT_SUFFIX));
        return;
    }
    if (!copy_request(v, &stills->copy)) return;
    snprintf(due.scene, sizeof due.scene, "%s", stills->copy.path);
    stills->share = 0.0;
    stills->due = due;
}

void stills_saved(Viewer *v, const char *scene, bool failed) {
    StillsState *stills = &v->states->stills;
    if (!copy_arrives(&stills->copy, scene, failed)) return;
    stills->share = 0.0;
    stills->still = still_start(&stills->due, v->window);
    if (!stills->still) viewer_report(v, true, "out of memory");
}

bool stills_busy(const Viewer *v) { return v->stills->still || copy_is_due(v, &v->stills->copy); }

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
    copy_forget(&v->states->stills.copy);
}
