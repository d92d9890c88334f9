/* Actions of menus, keys and replays. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "view/browser.h"
#include "view/paths.h"
#include "view/viewer.h"

void viewer_task(Viewer *v, TaskKind kind, const char *path, int index, int input) {
    Task task = {.kind = kind, .scene = v->scene, .index = index, .input = input};
    if (path && strlen(path) >= sizeof task.path) {
        viewer_say(v, true, "%.100s...: is too long a path", path);
        return;
    }
    if (path) snprintf(task.path, sizeof task.path, "%s", path);
    renderer_add_task(v->renderer, &task);
}

/* Accepts a state that history holds already. */
void viewer_accept_state(Viewer *v) {
    scene_state_free(&v->before);
    scene_state_copy(&v->before, &v->state);
    v->ask = true;
}

void viewer_undo(Viewer *v) {
    bool done = history_undo(&v->history, &v->state);
    if (done) viewer_accept_state(v);
    viewer_say(v, false, done ? "undone" : "nothing to undo");
}

void viewer_redo(Viewer *v) {
    bool done = history_redo(&v->history, &v->state);
    if (done) viewer_accept_state(v);
    viewer_say(v, false, done ? "redone" : "nothing to redo");
}

void viewer_mode(Viewer *v, Mode mode) { v->mode = v->mode == mode ? MODE_LIVE : mode; }

void viewer_next_material(Viewer *v, int by) {
    const float *coverage = v->facts.coverage;
    int count = v->state.material_count, k = v->material;
    for (int step = 0; step < count; step++) {
        k = (k + by + count) % count;
        if (!coverage || coverage[k] >= 0.0f) break;
    }
    if (!count) return;
    v->material = k;
    viewer_say(v, false, "%s", v->facts.materials[k]);
}

void viewer_make_fibre(Viewer *v) {
    if (v->material >= v->state.material_count) return;
    WeftMaterial m = *scene_state_material(&v->state, v->material);
    int lobe = weft_material_choice_find("sheen_lobe"), value = 0;
    while (weft_material_choice_value(lobe, value) &&
           strcmp(weft_material_choice_value(lobe, value), "fibre") != 0)
        value++;
    weft_material_choose(&m, lobe, value);
    WeftInput *color = &m.inputs[weft_material_input_find("sheen_color")],
              *rough = &m.inputs[weft_material_input_find("sheen_roughness")];
    bool black = !(color->value[0] + color->value[1] + color->value[2] > 0.0f);
    for (int c = 0; c < 3 && black; c++) color->value[c] = 0.5f;
    if (black) color->given = 1;
    if (!(rough->value[0] > 0.0f)) rough->value[0] = 0.6f, rough->given = 1;
    viewer_set_material(v, v->material, &m);
    viewer_say(v, false, "%s now has a sheen of fibres to brush", v->facts.materials[v->material]);
}

/* The state that is not edited is kept while the comparison is off. */
void viewer_split(Viewer *v, Split split) {
    if (!v->has_scene) return;
    if (split != SPLIT_NONE && !v->other.materials && !scene_state_copy(&v->other, &v->state)) return;
    v->split = split;
    v->ask = true;
}

void viewer_swap(Viewer *v) {
    SceneState before;
    if (v->split == SPLIT_NONE || !scene_state_copy(&before, &v->other)) return;
    SceneState kept = v->state;
    v->state = v->other;
    v->other = kept;
    v->side = !v->side;
    scene_state_free(&v->before);
    v->before = before;
    History history = v->history;
    v->history = v->other_history;
    v->other_history = history;
    v->ask = true;
}

void viewer_frame_selection(Viewer *v) {
    if (v->has_scene) orbit_frame(&v->orbit, v->facts.info.low, v->facts.info.high, viewer_aspect(v));
}

void viewer_reset_camera(Viewer *v) {
    snprintf(v->orbit.name, sizeof v->orbit.name, "%s", v->facts.info.camera_count ? "0" : "auto");
}

static void offer_path(Viewer *v, char *path, const char *suffix) {
    if (path[0]) return;
    char stem[200];
    path_stem(v->facts.path, stem, sizeof stem);
    snprintf(path, STATE_PATH, "%s%s", stem, suffix);
}

void viewer_shot(Viewer *v, const char *path) {
    if (!path) {
        offer_path(v, v->shot_path, "-weft.png");
        v->shot_width = (int)v->stage.width, v->shot_height = (int)v->stage.height;
        v->shot_traced = v->mode == MODE_REFERENCE;
        viewer_dialog(v, "Save a picture");
        return;
    }
    Task task = {.kind = TASK_SHOT,
                 .scene = v->scene,
                 .width = v->shot_width,
                 .height = v->shot_height,
                 .transparent = v->shot_transparent,
                 .reference = v->shot_traced};
    snprintf(task.path, sizeof task.path, "%s", path);
    if (!weft_image_suffix_known(path))
        viewer_say(v, true, "%.300s: %s", path, weft_message_text(WEFT_MESSAGE_OUTPUT_SUFFIX));
    else
        renderer_add_task(v->renderer, &task);
}

void viewer_save(Viewer *v, const char *path) {
    if (!v->has_scene) return;
    if (!path) {
        offer_path(v, v->save_path, "-weft.glb");
        viewer_dialog(v, "Save the scene");
        return;
    }
    viewer_task(v, TASK_SAVE, path, v->material, -1);
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

void viewer_profiles(Viewer *v) {
    v->profiles_open = true;
    v->profiles_made = false;
    viewer_task(v, TASK_PROFILES, NULL, v->material, -1);
}

void viewer_dialog(Viewer *v, const char *name) {
    browser_refresh(v->browser);
    snprintf(v->open_dialog, sizeof v->open_dialog, "%s", name);
}

void viewer_set_material(Viewer *v, int index, const WeftMaterial *material) {
    if (!scene_state_set_material(&v->state, index, material)) viewer_say(v, true, "out of memory");
}

bool viewer_is_idle(Viewer *v) {
    return !v->loader && !v->has_pending && renderer_is_idle(v->renderer) &&
           (!v->has_scene || v->rendered.number == v->requested) && !v->rendered.busy && !doctor_busy(v) &&
           (v->mode != MODE_LIVE || v->rendered.effort == EFFORT_SMOOTH) && !v->ask &&
           (v->mode == MODE_LIVE || reference_is_idle(v->reference));
}

void viewer_copy_material(Viewer *v) {
    if (!v->state.material_count) return;
    v->copied = *scene_state_material(&v->state, v->material);
    v->has_copied = true;
    viewer_say(v, false, "copied %s", v->facts.materials[v->material]);
}

void viewer_paste_material(Viewer *v) {
    if (v->has_copied && v->state.material_count) viewer_set_material(v, v->material, &v->copied);
}

void viewer_light_by(Viewer *v, const char *path) { viewer_task(v, TASK_LIGHT, path, -1, -1); }
