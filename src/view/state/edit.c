/* The state of the scene that is edited, or two of them, with their history and the chosen material and light. */
#include <string.h>

#include "view/state/frame_requests.h"
#include "view/state/rooms.h"

SceneState *edit_state(Viewer *v) { return &v->rooms->edit.state; }

void edit_begin(Viewer *v, const SceneState *state, const SceneState *before, const SceneState *first) {
    v->rooms->edit.state = *state;
    v->rooms->edit.before = *before;
    v->rooms->edit.first = *first;
    v->rooms->edit.split = SPLIT_NONE;
    v->rooms->edit.side = 0;
}

void edit_forget(Viewer *v) {
    EditRoom *edit = &v->rooms->edit;
    scene_state_free(&edit->state);
    scene_state_free(&edit->first);
    scene_state_free(&edit->before);
    scene_state_free(&edit->other);
    history_free(&edit->history);
    history_free(&edit->other_history);
    edit->assignment_count = 0;
}

void edit_choose_material(Viewer *v, int material) { v->rooms->edit.material = material; }
void edit_choose_light(Viewer *v, int light) { v->rooms->edit.light = light; }
void edit_forget_copy(Viewer *v) { v->rooms->edit.has_copied = false; }

/* ---- history ---- */

void edit_note_changes(Viewer *v, bool held) {
    EditRoom *edit = &v->rooms->edit;
    if (v->shown->any && !scene_state_same(&edit->state, &edit->before)) {
        if (edit->state.material_count == edit->before.material_count)
            history_keep(&edit->history, &edit->before);
        SceneState copy;
        if (scene_state_copy(&copy, &edit->state)) {
            scene_state_free(&edit->before);
            edit->before = copy;
        }
    }
    if (!held) history_close(&edit->history);
}

/* Accepts a state that history holds already. */
static void accept_state(Viewer *v) {
    scene_state_free(&v->rooms->edit.before);
    scene_state_copy(&v->rooms->edit.before, &v->rooms->edit.state);
    requests_due(v);
}

void viewer_undo(Viewer *v) {
    bool done = history_undo(&v->rooms->edit.history, &v->rooms->edit.state);
    if (done) accept_state(v);
    viewer_say(v, false, done ? "undone" : "nothing to undo");
}

void viewer_redo(Viewer *v) {
    bool done = history_redo(&v->rooms->edit.history, &v->rooms->edit.state);
    if (done) accept_state(v);
    viewer_say(v, false, done ? "redone" : "nothing to redo");
}

void viewer_next_material(Viewer *v, int by) {
    const float *coverage = v->shown->facts.coverage;
    int count = v->rooms->edit.state.material_count, k = v->rooms->edit.material;
    for (int step = 0; step < count; step++) {
        k = (k + by + count) % count;
        if (!coverage || coverage[k] >= 0.0f) break;
    }
    if (!count) return;
    v->rooms->edit.material = k;
    viewer_say(v, false, "%s", v->shown->facts.materials[k]);
}

void viewer_make_fibre(Viewer *v) {
    if (v->rooms->edit.material >= v->rooms->edit.state.material_count) return;
    WeftMaterial m = *scene_state_material(&v->rooms->edit.state, v->rooms->edit.material);
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
    viewer_set_material(v, v->rooms->edit.material, &m);
    viewer_say(v, false, "%s now has a sheen of fibres to brush",
               v->shown->facts.materials[v->rooms->edit.material]);
}

void viewer_split(Viewer *v, Split split) {
    if (!v->shown->any) return;
    if (split != SPLIT_NONE && !v->rooms->edit.other.materials &&
        !scene_state_copy(&v->rooms->edit.other, &v->rooms->edit.state))
        return;
    v->rooms->edit.split = split;
    requests_due(v);
}

void viewer_swap(Viewer *v) {
    SceneState before;
    if (v->rooms->edit.split == SPLIT_NONE || !scene_state_copy(&before, &v->rooms->edit.other)) return;
    SceneState kept = v->rooms->edit.state;
    v->rooms->edit.state = v->rooms->edit.other;
    v->rooms->edit.other = kept;
    v->rooms->edit.side = !v->rooms->edit.side;
    scene_state_free(&v->rooms->edit.before);
    v->rooms->edit.before = before;
    History history = v->rooms->edit.history;
    v->rooms->edit.history = v->rooms->edit.other_history;
    v->rooms->edit.other_history = history;
    requests_due(v);
}

void viewer_set_material(Viewer *v, int index, const WeftMaterial *material) {
    if (!scene_state_set_material(&v->rooms->edit.state, index, material))
        viewer_say(v, true, "out of memory");
}

void viewer_copy_material(Viewer *v) {
    if (!v->rooms->edit.state.material_count) return;
    v->rooms->edit.copied = *scene_state_material(&v->rooms->edit.state, v->rooms->edit.material);
    v->rooms->edit.has_copied = true;
    viewer_say(v, false, "copied %s", v->shown->facts.materials[v->rooms->edit.material]);
}

void viewer_paste_material(Viewer *v) {
    if (v->rooms->edit.has_copied && v->rooms->edit.state.material_count)
        viewer_set_material(v, v->rooms->edit.material, &v->rooms->edit.copied);
}

/* ---- what a task has made ---- */

/* Makes the current state a step of its own. */
static void keep_step(Viewer *v) {
    history_close(&v->rooms->edit.history);
    history_keep(&v->rooms->edit.history, &v->rooms->edit.state);
    history_close(&v->rooms->edit.history);
}

static bool lit_by(const SceneState *state, const char *path) {
    return state->environment.kind == ENVIRONMENT_FILE && strcmp(state->environment.path, path) == 0;
}

void edit_take_light(Viewer *v, const EnvironmentState *environment) {
    EditRoom *edit = &v->rooms->edit;
    if (!lit_by(&edit->state, environment->path)) keep_step(v);
    if (lit_by(&edit->other, environment->path))
        environment_state_take_source(&edit->other.environment, environment);
    environment_state_take_source(&edit->state.environment, environment);
    accept_state(v);
}

unsigned edit_assign(Viewer *v, int material) {
    EditRoom *edit = &v->rooms->edit;
    if (edit->assignment_count == ASSIGNMENTS || material < 0 || material >= edit->state.material_count)
        return 0;
    const Assignment fresh = {++edit->stamp, material, *scene_state_material(&edit->state, material)};
    edit->assignments[edit->assignment_count++] = fresh;
    return fresh.stamp;
}

static Assignment *assignment_of(EditRoom *edit, unsigned stamp) {
    for (int k = 0; k < edit->assignment_count; k++)
        if (stamp && edit->assignments[k].stamp == stamp) return &edit->assignments[k];
    return NULL;
}

void edit_end_assign(Viewer *v, unsigned stamp) {
    EditRoom *edit = &v->rooms->edit;
    Assignment *ended = assignment_of(edit, stamp);
    if (!ended) return;
    size_t behind = (size_t)(edit->assignments + edit->assignment_count - (ended + 1));
    memmove(ended, ended + 1, behind * sizeof *ended);
    edit->assignment_count--;
}

/* Makes of a task's state the one that is edited, with the task's material merged into it. To tasks that follow, what
 * this one made was there before. */
static void keep_later_changes(EditRoom *edit, const Assignment *task, SceneState *state) {
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
    EditRoom *edit = &v->rooms->edit;
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
    scene_state_free(&v->rooms->edit.other);
    scene_state_copy(&v->rooms->edit.other, &v->rooms->edit.state);
    requests_due(v);
}
