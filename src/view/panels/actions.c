/* Actions of menus, keys and replays. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "view/state/viewer.h"

void viewer_task(Viewer *v, TaskKind kind, const char *path, int index, int input) {
    Task task = {.kind = kind, .scene = v->shown->number, .index = index, .input = input};
    if (path && strlen(path) >= sizeof task.path) {
        viewer_say(v, true, "%.100s...: is too long a path", path);
        return;
    }
    if (path) snprintf(task.path, sizeof task.path, "%s", path);
    if (kind == TASK_ASSIGN) task.stamp = edit_assign(v, index);
    renderer_add_task(v->renderer, &task);
}

void viewer_copy_command(Viewer *v) {
    bool lost = false;
    char *line = command_line(v, &lost);
    if (!line) return;
    const UiClipboard *clip = window_clipboard(v->window);
    clip->set(clip->user, line);
    viewer_say(v, lost,
               lost ? "copied, but for brushed nap and maps: save the scene and render that"
                    : "copied: %.400s",
               line);
    free(line);
}

bool viewer_is_idle(const Viewer *v) {
    return !v->opening->loader && !v->opening->has_pending && renderer_is_idle(v->renderer) &&
           (!v->shown->any || v->requests->rendered.number == v->requests->requested) &&
           !v->requests->rendered.busy && !doctor_busy(v) &&
           (v->options->mode != MODE_LIVE || v->requests->rendered.effort == EFFORT_SMOOTH) &&
           !v->requests->ask && (v->options->mode == MODE_LIVE || reference_is_idle(v->reference));
}

void viewer_light_by(Viewer *v, const char *path) { viewer_task(v, TASK_LIGHT, path, -1, -1); }
