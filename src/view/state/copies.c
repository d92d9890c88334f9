#include "view/state/copies.h"

#include <stdio.h>
#include <string.h>

#include "view/render/renderer.h"
#include "view/render/still.h"
#include "view/state/opening.h"

bool copy_is_due(const Viewer *v, const SceneCopy *copy) { return copy->due && copy->scene == v->shown->number; }

bool copy_request(Viewer *v, SceneCopy *copy) {
    copy_forget(copy); /* of a scene before this one */
    if (!still_folder(copy->path)) {
        viewer_report(v, true, "no temporary folder can be made for a copy of the scene");
        return false;
    }
    Task task = {.kind = TASK_COPY, .scene = v->shown->number};
    snprintf(task.path, sizeof task.path, "%s", copy->path);
    copy->scene = v->shown->number;
    copy->due = renderer_add_task(v->renderer, &task);
    if (copy->due) return true;
    still_discard(copy->path);
    viewer_report(v, true, "too much is still to be done: try again");
    return false;
}

bool copy_arrives(SceneCopy *copy, const char *path, bool failed) {
    if (!copy->due || strcmp(path, copy->path) != 0) return false;
    copy->due = false;
    if (failed) still_discard(path);
    return !failed;
}

void copy_forget(SceneCopy *copy) {
    if (copy->due) still_discard(copy->path);
    copy->due = false;
}
