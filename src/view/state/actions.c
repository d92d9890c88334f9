#include "view/state/actions.h"

#include <stdio.h>
#include <string.h>

#include "view/files/paths.h"
#include "view/state/edit.h"
#include "view/state/opening.h"

void actions_send(Viewer *v, TaskKind kind, const char *path, int index, int input) {
    Task task = {.kind = kind, .scene = v->shown->number, .index = index, .input = input};
    if (path && strlen(path) >= sizeof task.path) {
        viewer_report(v, true, "%.100s...: is too long a path", path);
        return;
    }
    if (path) snprintf(task.path, sizeof task.path, "%s", path);
    if (kind == TASK_ASSIGN) task.stamp = edit_assign(v, index);
    if (kind == TASK_SAVE) task.stamp = edit_saving(v, path_kind(path) == PATH_MATERIAL ? index : -1);
    renderer_add_task(v->renderer, &task);
}

void actions_weave(Viewer *v, const char *key, const char *value) {
    Task task = {.kind = TASK_WEAVE_KEY, .scene = v->shown->number, .index = v->edit->material};
    if (strlen(value) >= sizeof task.path) {
        viewer_report(v, true, "%.100s...: is too long", value);
        return;
    }
    snprintf(task.key, sizeof task.key, "%s", key);
    snprintf(task.path, sizeof task.path, "%s", value);
    task.stamp = edit_assign(v, task.index);
    renderer_add_task(v->renderer, &task);
}

void actions_weave_file(Viewer *v, const char *path) { actions_weave(v, "draft", path); }

void actions_light_by(Viewer *v, const char *path) { actions_send(v, TASK_LIGHT, path, -1, -1); }
