#include "view/state/edit.h"

#include <string.h>

#include "view/state/states.h"

void edit_begin(Viewer *v, const SceneState *state, const SceneState *before, const SceneState *first) {
    v->states->edit.state = *state;
    v->states->edit.before = *before;
    v->states->edit.first = *first;
    v->states->edit.split = SPLIT_NONE;
    v->states->edit.side = 0;
    if (!scene_state_copy(&v->states->edit.saved, first)) v->states->edit.saved = (SceneState){0};
}

void edit_restore_other(Viewer *v, const SceneState *other, Split split, int side) {
    EditState *edit = &v->states->edit;
    scene_state_free(&edit->other);
    if (!other->materials || !scene_state_copy(&edit->other, other)) edit->other = (SceneState){0};
    if (!edit->other.materials) return;
    edit->split = split;
    edit->side = side;
}

bool edit_is_unsaved(const Viewer *v) {
    const EditState *edit = v->edit;
    const bool other = edit->other.materials && !scene_state_same(&edit->other, &edit->saved);
    return v->shown->any && (other || !scene_state_same(&edit->state, &edit->saved));
}

unsigned edit_saving(Viewer *v, int material) {
    EditState *edit = &v->states->edit;
    scene_state_free(&edit->saving);
    if (!scene_state_copy(&edit->saving, &edit->state)) edit->saving = (SceneState){0};
    edit->saving_material = material;
    return ++edit->saving_stamp;
}

void edit_end_saving(Viewer *v, unsigned stamp, bool failed) {
    EditState *edit = &v->states->edit;
    const int k = edit->saving_material;
    if (failed || stamp != edit->saving_stamp || !edit->saving.materials) return;
    if (k < 0) {
        scene_state_free(&edit->saved);
        edit->saved = edit->saving;
        edit->saving = (SceneState){0};
    } else if (k < edit->saved.material_count && k < edit->saving.material_count) {
        scene_state_set_material(&edit->saved, k, scene_state_material(&edit->saving, k));
    }
}

void edit_forget(Viewer *v) {
    EditState *edit = &v->states->edit;
    scene_state_free(&edit->state);
    scene_state_free(&edit->first);
    scene_state_free(&edit->before);
    scene_state_free(&edit->other);
    scene_state_free(&edit->saved);
    scene_state_free(&edit->saving);
    history_free(&edit->history);
    history_free(&edit->other_history);
    edit->assignment_count = 0;
}

void edit_choose_material(Viewer *v, int material) { v->states->edit.material = material; }
void edit_choose_light(Viewer *v, int light) { v->states->edit.light = light; }
void edit_forget_copy(Viewer *v) { v->states->edit.has_copied = false; }

void edit_note_changes(Viewer *v, bool goes_on) {
    EditState *edit = &v->states->edit;
    if (v->shown->any && !scene_state_same(&edit->state, &edit->before)) {
        if (edit->state.material_count == edit->before.material_count) history_keep(&edit->history, &edit->before);
        SceneState copy;
        if (scene_state_copy(&copy, &edit->state)) {
            scene_state_free(&edit->before);
            edit->before = copy;
        }
    }
    if (!goes_on) history_close(&edit->history);
}

/* Accepts a state that is in the history already. */
static void accept_state(Viewer *v) {
    scene_state_free(&v->states->edit.before);
    scene_state_copy(&v->states->edit.before, &v->states->edit.state);
    requests_due(v);
}

void edit_undo(Viewer *v) {
    bool done = history_undo(&v->states->edit.history, &v->states->edit.state);
    if (done) accept_state(v);
    viewer_report(v, false, done ? "undone" : "nothing to undo");
}

void edit_redo(Viewer *v) {
    bool done = history_redo(&v->states->edit.history, &v->states->edit.state);
    if (done) accept_state(v);
    viewer_report(v, false, done ? "redone" : "nothing to redo");
}

void edit_next_material(Viewer *v, int by) {
    const float *coverage = v->shown->facts.coverage;
    int count = v->states->edit.state.material_count, k = v->states->edit.material;
    for (int step = 0; step < count; step++) {
        k = (k + by + count) % count;
        if (!coverage || coverage[k] >= 0.0f) break;
    }
    if (!count) return;
    v->states->edit.material = k;
    viewer_report(v, false, "%s", v->shown->facts.materials[k]);
}

void edit_make_fibre(Viewer *v) {
    if (v->states->edit.material >= v->states->edit.state.material_count) return;
    WeftMaterial m = *scene_state_material(&v->states->edit.state, v->states->edit.material);
    int lobe = weft_material_choice_find("sheen_lobe"), value = 0;
    while (weft_material_choice_value(lobe, value) && strcmp(weft_material_choice_value(lobe, value), "fibre") != 0)
        value++;
    weft_material_choose(&m, lobe, value);
    WeftInput *color = &m.inputs[weft_material_input_find("sheen_color")],
              *rough = &m.inputs[weft_material_input_find("sheen_roughness")];
    bool black = !(color->value[0] + color->value[1] + color->value[2] > 0.0f);
    for (int c = 0; c < 3 && black; c++) color->value[c] = 0.5f;
    if (black) color->given = 1;
    if (!(rough->value[0] > 0.0f)) rough->value[0] = 0.6f, rough->given = 1;
    edit_set_material(v, v->states->edit.material, &m);
    viewer_report(v, false, "%s now has a sheen of fibres to brush",
                  v->shown->facts.materials[v->states->edit.material]);
}

void edit_set_split(Viewer *v, Split split) {
    if (!v->shown->any) return;
    if (split != SPLIT_NONE && !v->states->edit.other.materials &&
        !scene_state_copy(&v->states->edit.other, &v->states->edit.state))
        return;
    v->states->edit.split = split;
    requests_due(v);
}

void edit_swap_sides(Viewer *v) {
    SceneState before;
    if (v->states->edit.split == SPLIT_NONE || !scene_state_copy(&before, &v->states->edit.other)) return;
    SceneState kept = v->states->edit.state;
    v->states->edit.state = v->states->edit.other;
    v->states->edit.other = kept;
    v->states->edit.side = !v->states->edit.side;
    scene_state_free(&v->states->edit.before);
    v->states->edit.before = before;
    History history = v->states->edit.history;
    v->states->edit.history = v->states->edit.other_history;
    v->states->edit.other_history = history;
    requests_due(v);
}

void edit_set_material(Viewer *v, int index, const WeftMaterial *material) {
    if (!scene_state_set_material(&v->states->edit.state, index, material)) viewer_report(v, true, "out of memory");
}

void edit_set_preset(Viewer *v, int material, int preset) {
    scene_state_set_preset(&v->states->edit.state, material, preset);
}

void edit_set_variant(Viewer *v, int variant) { v->states->edit.state.variant = variant; }

void edit_set_environment(Viewer *v, const EnvironmentState *environment) {
    v->states->edit.state.environment = *environment;
}

void edit_set_light(Viewer *v, int index, const WeftLight *light) { v->states->edit.state.lights[index] = *light; }

void edit_add_light(Viewer *v, const WeftLight *light) {
    EditState *edit = &v->states->edit;
    edit->light = edit->state.light_count++;
    edit->state.lights[edit->light] = *light;
}

void edit_remove_light(Viewer *v, int index) {
    EditState *edit = &v->states->edit;
    WeftLight *lights = edit->state.lights;
    const int count = --edit->state.light_count;
    memmove(lights + index, lights + index + 1, (size_t)(count - index) * sizeof *lights);
    memset(&lights[count], 0, sizeof *lights);
    if (edit->light >= index && edit->light > 0) edit->light--;
}

bool edit_set_nap(Viewer *v, BrushedNap *nap) { return scene_state_set_nap(&v->states->edit.state, nap); }

void edit_copy_material(Viewer *v) {
    if (!v->states->edit.state.material_count) return;
    v->states->edit.copied = *scene_state_material(&v->states->edit.state, v->states->edit.material);
    v->states->edit.has_copied = true;
    viewer_report(v, false, "copied %s", v->shown->facts.materials[v->states->edit.material]);
}

void edit_paste_material(Viewer *v) {
    if (v->states->edit.has_copied && v->states->edit.state.material_count)
        edit_set_material(v, v->states->edit.material, &v->states->edit.copied);
}

/* Makes the current state a step of its own. */
static void keep_step(Viewer *v) {
    history_close(&v->states->edit.history);
    history_keep(&v->states->edit.history, &v->states->edit.state);
    history_close(&v->states->edit.history);
}

static bool lit_by(const SceneState *state, const char *path) {
    return state->environment.kind == ENVIRONMENT_FILE && strcmp(state->environment.path, path) == 0;
}

void edit_take_light(Viewer *v, const EnvironmentState *environment) {
    EditState *edit = &v->states->edit;
    if (!lit_by(&edit->state, environment->path)) keep_step(v);
    if (lit_by(&edit->other, environment->path)) environment_state_take_source(&edit->other.environment, environment);
    environment_state_take_source(&edit->state.environment, environment);
    accept_state(v);
}

unsigned edit_assign(Viewer *v, int material) {
    EditState *edit = &v->states->edit;
    if (edit->assignment_count == ASSIGNMENTS || material < 0 || material >= edit->state.material_count) return 0;
    const Assignment fresh = {++edit->stamp, material, *scene_state_material(&edit->state, material)};
    edit->assignments[edit->assignment_count++] = fresh;
    return fresh.stamp;
}

static Assignment *assignment_of(EditState *edit, unsigned stamp) {
    for (int k = 0; k < edit->assignment_count; k++)
        if (stamp && edit->assignments[k].stamp == stamp) return &edit->assignments[k];
    return NULL;
}

void edit_end_assign(Viewer *v, unsigned stamp) {
    EditState *edit = &v->states->edit;
    Assignment *ended = assignment_of(edit, stamp);
    if (!ended) return;
    size_t behind = (size_t)(edit->assignments + edit->assignment_count - (ended + 1));
    memmove(ended, ended + 1, behind * sizeof *ended);
    edit->assignment_count--;
}

/* Turns a task's state into the edited state, with the task's material merged into it. For the tasks that
 * follow, the result of this one becomes the material they started from. */
static void keep_later_changes(EditState *edit, const Assignment *task, SceneState *state) {
    SceneState merged;
    const int k = task->material, preset = scene_state_preset(state, k);
    const WeftMaterial now = *scene_state_material(&edit->state, k),
                       made = material_merged(&task->was, &now, scene_state_material(state, k));
    if (!scene_state_copy(&merged, &edit->state)) return;
    scene_state_set_material(&merged, k, &made);
    scene_state_set_preset(&merged, k, preset);
    scene_state_free(state);
    *state = merged;
    for (int other = 0; other < edit->assignment_count; other++) {
        Assignment *later = &edit->assignments[other];
        if (later->material == k && later != task) later->was = material_merged(&now, &later->was, &made);
    }
}

void edit_take_assigned(Viewer *v, SceneState *state, unsigned stamp) {
    EditState *edit = &v->states->edit;
    const Assignment *task = assignment_of(edit, stamp);
    if (task && state->material_count == edit->state.material_count) keep_later_changes(edit, task, state);
    EnvironmentState environment = edit->state.environment;
    if (!scene_state_same(&edit->state, state)) keep_step(v);
    scene_state_free(&edit->state);
    edit->state = *state;
    edit->state.environment = environment;
    accept_state(v);
}

void edit_match_other(Viewer *v) {
    scene_state_free(&v->states->edit.other);
    scene_state_copy(&v->states->edit.other, &v->states->edit.state);
    requests_due(v);
}
