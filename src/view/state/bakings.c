#include "view/state/bakings.h"

#include <stdio.h>

#include "view/state/states.h"

bool bakings_possible(const Viewer *v) {
    const SceneState *state = &v->edit->state;
    for (int k = 0; v->shown->any && k < state->material_count; k++)
        if (scene_state_material(state, k)->cloth) return true;
    return false;
}

void bakings_save(Viewer *v, const char *path) {
    BakingsState *bakings = &v->states->bakings;
    if (bakings->baking || copy_is_due(v, &bakings->copy)) {
        viewer_report(v, true, "a file is being baked: wait for it");
        return;
    }
    if (!copy_request(v, &bakings->copy)) return;
    snprintf(bakings->path, sizeof bakings->path, "%s", path);
    viewer_report(v, false, "baking into %.400s ...", path);
}

void bakings_copied(Viewer *v, const char *scene, bool failed) {
    BakingsState *bakings = &v->states->bakings;
    if (!copy_arrives(&bakings->copy, scene, failed)) return;
    bakings->baking = baking_start(scene, bakings->path, v->window);
    if (!bakings->baking) viewer_report(v, true, "out of memory");
}

bool bakings_busy(const Viewer *v) { return v->bakings->baking || copy_is_due(v, &v->bakings->copy); }

static void take_end(Viewer *v) {
    BakingsState *bakings = &v->states->bakings;
    char line[512];
    const bool made = baking_end(bakings->baking, line);
    bakings->baking = NULL;
    viewer_report(v, !made, "%s", line);
}

bool bakings_poll(Viewer *v) {
    BakingsState *bakings = &v->states->bakings;
    if (!bakings->baking || !baking_done(bakings->baking)) return false;
    take_end(v);
    return true;
}

void bakings_end(Viewer *v) {
    if (v->states->bakings.baking) take_end(v);
    copy_forget(&v->states->bakings.copy);
}
