#include "view/state/bakings.h"

#include <stdio.h>
#include <string.h>

#include "view/render/still.h"
#include "view/state/states.h"

bool bakings_possible(const Viewer *v) {
    const SceneState *state = &v->edit->state;
    for (int k = 0; v->shown->any && k < state->material_count; k++)
        if (scene_state_material(state, k)->cloth) return true;
    return false;
}

/* Forgets a file whose scene is still to be saved. */
static void forget_due(BakingsState *bakings) {
    if (bakings->has_due) still_discard(bakings->scene);
    bakings->has_due = false;
}

void bakings_save(Viewer *v, const char *path) {
    BakingsState *bakings = &v->states->bakings;
    if (bakings->baking || (bakings->has_due && bakings->number == v->shown->number)) {
        viewer_report(v, true, "a file is being baked: wait for it");
        return;
    }
    forget_due(bakings); /* of a scene before this one */
    if (!still_folder(bakings->scene)) {
        viewer_report(v, true, "no temporary folder can be made for a copy of the scene");
        return;
    }
    Task task = {.kind = TASK_COPY, .scene = v->shown->number};
    snprintf(task.path, sizeof task.path, "%s", bakings->scene);
    snprintf(bakings->path, sizeof bakings->path, "%s", path);
    bakings->number = v->shown->number;
    bakings->has_due = renderer_add_task(v->renderer, &task);
    if (bakings->has_due) {
        viewer_report(v, false, "baking into %.400s ...", path);
        return;
    }
    still_discard(bakings->scene);
    viewer_report(v, true, "too much is still to be done: try again");
}

void bakings_copied(Viewer *v, const char *scene, bool failed) {
    BakingsState *bakings = &v->states->bakings;
    if (!bakings->has_due || strcmp(scene, bakings->scene) != 0) return;
    bakings->has_due = false;
    if (failed) {
        still_discard(scene);
        return;
    }
    bakings->baking = baking_start(scene, bakings->path, v->window);
    if (!bakings->baking) viewer_report(v, true, "out of memory");
}

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
    forget_due(&v->states->bakings);
}
