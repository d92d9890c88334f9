#define _XOPEN_SOURCE 700 /* realpath */
#include "view/state/sessions.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "base/path.h"
#include "view/files/paths.h"
#include "view/files/record.h"
#include "view/render/session_state.h"
#include "view/state/states.h"

static const double rest_seconds = 2.0;

#define LENGTH(array) (sizeof(array) / sizeof *(array))

static const RecordMember option_members[] = {RECORD_WHOLE(ViewOptions, mode, MODE_DIFFERENCE),
                                              RECORD_FLOATS(ViewOptions, split_at, 1),
                                              RECORD_WHOLE(ViewOptions, background, WEFT_BACKGROUND_BLURRED),
                                              RECORD_FLOATS(ViewOptions, background_color, 3),
                                              RECORD_WHOLE(ViewOptions, floor.on, 1),
                                              RECORD_FLOATS(ViewOptions, floor.reflection, 1),
                                              RECORD_FLOATS(ViewOptions, floor.roughness, 1),
                                              RECORD_SWITCH(ViewOptions, stage),
                                              RECORD_SWITCH(ViewOptions, hide_lights),
                                              RECORD_SWITCH(ViewOptions, bounced),
                                              RECORD_WHOLE(ViewOptions, tonemap, WEFT_TONEMAP_COUNT - 1),
                                              RECORD_FLOATS(ViewOptions, exposure, 1),
                                              RECORD_SWITCH(ViewOptions, metered),
                                              RECORD_FLOATS(ViewOptions, kelvin, 1),
                                              RECORD_FLOATS(ViewOptions, tint, 1),
                                              RECORD_SWITCH(ViewOptions, balanced),
                                              RECORD_WHOLE(ViewOptions, part, WEFT_PART_COUNT - 1),
                                              RECORD_WHOLE(ViewOptions, ambient, WEFT_AMBIENT_NONE),
                                              RECORD_WHOLE(ViewOptions, tool, TOOL_BRUSH),
                                              RECORD_FLOATS(ViewOptions, brush_radius, 1),
                                              RECORD_FLOATS(ViewOptions, brush_strength, 1),
                                              RECORD_WHOLE(ViewOptions, panel, PANEL_DOCTOR)};
static const RecordMember photograph_members[] = {RECORD_WHOLE(PhotographView, place, PHOTOGRAPH_OVER),
                                                  RECORD_FLOATS(PhotographView, at, 1),
                                                  RECORD_FLOATS(PhotographView, opacity, 1),
                                                  RECORD_FLOATS(PhotographView, size, 1),
                                                  RECORD_FLOATS(PhotographView, shift, 2),
                                                  RECORD_SWITCH(PhotographView, follows),
                                                  RECORD_FLOATS(PhotographView, reach, 1)};
static const RecordMember orbit_members[] = {RECORD_FLOATS(Orbit, eye, 3), RECORD_FLOATS(Orbit, target, 3),
                                             RECORD_FLOATS(Orbit, fov, 1)};

const char *sessions_claim(Viewer *v, const char *scene) {
    SessionsState *sessions = &v->states->sessions;
    session_file_release(&sessions->next, false);
    if (v->desc->forget || !session_file_claim(&sessions->next, scene)) return "";
    return sessions->next.path;
}

bool sessions_last(char path[STATE_PATH]) {
    json_t *session = session_file_last();
    const char *scene = json_string_value(json_object_get(session, "scene"));
    const bool there = scene && strlen(scene) < STATE_PATH && path_kind(scene) == PATH_SCENE &&
                       (path_builtin(scene) || path_stamp(scene));
    if (there) snprintf(path, STATE_PATH, "%s", scene);
    json_decref(session);
    return there;
}

/* Returns the camera of the scene by its name, or the one that was moved in numbers. */
static json_t *camera_json(const Orbit *orbit) {
    if (!orbit->name[0]) return record_write(orbit, orbit_members, LENGTH(orbit_members));
    return json_pack("{s:s}", "name", orbit->name);
}

static bool configured(const Viewer *v) {
    return v->desc->options && v->desc->options[0] && strcmp(v->opening->configured, v->shown->facts.path) == 0;
}

/* Returns everything that the session keeps. */
static json_t *session_json(const Viewer *v) {
    const Facts *facts = &v->shown->facts;
    const SceneState *first = configured(v) ? NULL : &v->edit->first;
    json_t *root = json_object(), *names = json_array(), *lobes = json_array();
    char *real = path_builtin(facts->path) ? NULL : realpath(facts->path, NULL);
    for (int k = 0; k < facts->info.material_count; k++) json_array_append_new(names, json_string(facts->materials[k]));
    for (int k = 0; k < v->opening->lobe_count; k++) json_array_append_new(lobes, json_string(v->opening->lobes[k]));
    json_object_set_new(root, "scene", json_string(real ? real : facts->path));
    json_object_set_new(root, "names", names);
    json_object_set_new(root, "maps", json_integer(facts->own_maps));
    json_object_set_new(root, "lobes", lobes);
    json_object_set_new(root, "state", session_state_write(&v->edit->state, first, facts));
    if (v->edit->other.materials)
        json_object_set_new(root, "other", session_state_write(&v->edit->other, first, facts));
    json_object_set_new(root, "split", json_integer(v->edit->split));
    json_object_set_new(root, "side", json_integer(v->edit->side));
    json_object_set_new(root, "material", json_integer(v->edit->material));
    json_object_set_new(root, "light", json_integer(v->edit->light));
    json_object_set_new(root, "camera", camera_json(&v->camera->orbit));
    json_object_set_new(root, "options", record_write(v->options, option_members, LENGTH(option_members)));
    if (v->photographs->path[0]) {
        json_t *photograph = record_write(&v->photographs->view, photograph_members, LENGTH(photograph_members));
        json_object_set_new(photograph, "path", json_string(v->photographs->path));
        json_object_set_new(root, "photograph", photograph);
    }
    free(real);
    return root;
}

static void restore_photograph(Viewer *v, const json_t *photograph) {
    const char *path = json_string_value(json_object_get(photograph, "path"));
    PhotographView view = v->photographs->view;
    if (!path || !record_read(photograph, photograph_members, LENGTH(photograph_members), &view)) return;
    photographs_open(v, path);
    PhotographView first = v->photographs->view;
    first.follows = view.follows; /* so that the size below is not converted once more */
    photographs_set(v, &first);
    photographs_set(v, &view);
    photographs_reach(v, view.reach);
}

static bool is_camera(const Orbit *orbit) {
    float distance = 0.0f;
    for (int k = 0; k < 3; k++) distance = hypotf(distance, orbit->eye[k] - orbit->target[k]);
    return distance > 0.0f && isfinite(distance) && orbit->fov >= 1.0f && orbit->fov <= 170.0f;
}

static void restore_camera(Viewer *v, const json_t *camera) {
    const char *name = json_string_value(json_object_get(camera, "name"));
    Orbit orbit = v->camera->orbit;
    orbit.name[0] = '\0';
    if (name && strlen(name) < sizeof orbit.name)
        camera_stand_at(v, name);
    else if (record_read(camera, orbit_members, LENGTH(orbit_members), &orbit) && is_camera(&orbit))
        camera_set(v, &orbit);
}

/* Restores what is not of the scene: camera, options, A and B, what is chosen. Values that are damaged stay as the scene
 * was opened with. */
static void restore_view(Viewer *v, const Restored *restored) {
    const json_t *session = restored->session;
    ViewOptions options = *v->options;
    int split, side, chosen;
    for (size_t k = 0; k < LENGTH(option_members); k++) /* one that an earlier version did not have stays */
        record_read(json_object_get(session, "options"), &option_members[k], 1, &options);
    options_set(v, &options);
    restore_camera(v, json_object_get(session, "camera"));
    if (record_whole(session, "split", 0, SPLIT_SIDES, &split) && record_whole(session, "side", 0, 1, &side))
        edit_restore_other(v, &restored->other, (Split)split, side);
    restore_photograph(v, json_object_get(session, "photograph"));
    if (record_whole(session, "material", 0, v->edit->state.material_count - 1, &chosen))
        edit_choose_material(v, chosen);
    if (record_whole(session, "light", 0, v->edit->state.light_count - 1, &chosen)) edit_choose_light(v, chosen);
}

static void forget(SessionsState *sessions) {
    json_decref(sessions->kept);
    scene_state_free(&sessions->state);
    scene_state_free(&sessions->other);
    sessions->kept = NULL;
}

void sessions_begin(Viewer *v, const Loaded *loaded) {
    SessionsState *sessions = &v->states->sessions;
    forget(sessions);
    if (!sessions->next.path[0] && session_file_is_of(&sessions->file, v->shown->facts.path)) {
        session_file_forget(&sessions->file); /* the scene is opened anew, and this window has its file */
    } else {
        session_file_release(&sessions->file, true);
        sessions->file = sessions->next;
        sessions->next = (SessionFile){0};
    }
    if (loaded->restored.session) restore_view(v, &loaded->restored);
    sessions->kept = session_json(v);
    sessions->failed = false;
}

/* Returns true if the file holds this session, and the naps of the scene as it is edited. */
static bool is_kept(const Viewer *v, const json_t *now) {
    const SessionsState *sessions = v->sessions;
    return json_equal(now, sessions->kept) && session_state_same_naps(&v->edit->state, &sessions->state) &&
           session_state_same_naps(&v->edit->other, &sessions->other);
}

bool sessions_are_kept(const Viewer *v) {
    if (v->sessions->failed) return false;
    json_t *now = session_json(v);
    const bool kept = is_kept(v, now);
    json_decref(now);
    return kept;
}

/* Writes the session, unless the file has it already. */
static void keep(Viewer *v) {
    SessionsState *sessions = &v->states->sessions;
    json_t *now = session_json(v);
    if (is_kept(v, now)) {
        json_decref(now);
        return;
    }
    sessions->failed = !(session_state_write_naps(&v->edit->state, &sessions->state, sessions->file.path, 0) &&
                         session_state_write_naps(&v->edit->other, &sessions->other, sessions->file.path, STATE_NAPS) &&
                         session_file_write(&sessions->file, now));
    if (sessions->failed)
        viewer_report(v, true, "%.300s: cannot be written: the session is not kept", sessions->file.path);
    forget(sessions);
    sessions->kept = now;
    if (!scene_state_copy(&sessions->state, &v->edit->state)) sessions->state = (SceneState){0};
    if (!scene_state_copy(&sessions->other, &v->edit->other)) sessions->other = (SceneState){0};
}

void sessions_poll(Viewer *v, double seconds) {
    SessionsState *sessions = &v->states->sessions;
    if (!v->shown->any || !sessions->file.path[0] || seconds - sessions->looked < rest_seconds) return;
    sessions->looked = seconds;
    keep(v);
}

void sessions_end(Viewer *v, bool kept) {
    SessionsState *sessions = &v->states->sessions;
    if (kept && v->shown->any && sessions->file.path[0]) keep(v);
    session_file_release(&sessions->next, false);
    session_file_release(&sessions->file, !kept);
    forget(sessions);
}
