#define _POSIX_C_SOURCE 200809L
#include "view/state/opening.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <epoxy/gl.h>

#include "base/path.h"
#include "view/files/paths.h"
#include "view/files/survey.h"
#include "view/state/actions.h"
#include "view/state/states.h"

enum { WATCH_SCENE, WATCH_LIGHT, WATCH_LOBES };

/* Watches the files of scene, light and lobes; the renderer watches those of textures. */
static void watch_files(Viewer *v) {
    file_watch_clear(v->states->opening.file_watch);
    if (!path_builtin(v->states->shown.facts.path))
        file_watch_add(v->states->opening.file_watch, v->states->shown.facts.path, WATCH_SCENE);
    if (v->edit->state.environment.kind == ENVIRONMENT_FILE)
        file_watch_add(v->states->opening.file_watch, v->edit->state.environment.path, WATCH_LIGHT);
    for (int k = 0; k < v->states->opening.lobe_count; k++)
        file_watch_add(v->states->opening.file_watch, v->states->opening.lobes[k], WATCH_LOBES + k);
    snprintf(v->states->opening.watched, sizeof v->states->opening.watched, "%s", v->edit->state.environment.path);
}

/* Adds a lobe's file to those that are watched. */
static void keep_lobe(Viewer *v, const char *path) {
    for (int k = 0; k < v->states->opening.lobe_count; k++)
        if (strcmp(v->states->opening.lobes[k], path) == 0) return;
    if (v->states->opening.lobe_count == STATE_LOBES) return;
    snprintf(v->states->opening.lobes[v->states->opening.lobe_count++], STATE_PATH, "%s", path);
    if (v->states->shown.any) watch_files(v);
}

/* Drops a scene that is no longer needed; its lobe is kept if the library has taken it. */
static void leave(Viewer *v) {
    Loaded loaded;
    loader_finish(v->states->opening.leaving, &loaded);
    v->states->opening.leaving = NULL;
    if (loaded.taken)
        keep_lobe(v, loaded.lobe);
    else if (loaded.lobe[0])
        viewer_report(v, true, "%s", loaded.failure);
    loaded_free(&loaded);
}

/* Stops the loader without waiting for it; another one takes its place. */
static void let_go(Viewer *v) {
    if (v->states->opening.leaving) leave(v);
    loader_stop(v->states->opening.loader);
    v->states->opening.leaving = v->states->opening.loader;
    v->states->opening.loader = NULL;
}

static void start_reading(Viewer *v, const char *path, const char *lobe, bool reread) {
    if (v->states->opening.loader) let_go(v);
    bool configured = !v->states->opening.configured[0] || strcmp(v->states->opening.configured, path) == 0;
    if (!v->states->opening.configured[0])
        snprintf(v->states->opening.configured, sizeof v->states->opening.configured, "%s", path);
    Folders folders = {0};
    if (configured && !v->states->shown.any && v->desc->materials) folders_keep(&folders, v->desc->materials, -1);
    const Reading reading = {.path = path,
                             .lobe = lobe,
                             .reread = reread,
                             .configured = configured,
                             .folders = reread ? &v->states->shown.folders : &folders,
                             .aspect = viewer_aspect(v),
                             .session = reread ? "" : sessions_claim(v, path)};
    v->states->opening.loader = loader_start(v->window, v->desc, &reading);
    if (v->states->opening.loader) return;
    v->states->opening.opened = WEFT_RESOURCES;
    viewer_report(v, true, "%.300s: out of memory", path);
}

void opening_start(Viewer *v, const char *path, bool reread) { start_reading(v, path, NULL, reread); }

/* Reads the lobe with the scene that is being read, else the one that the renderer prepares, else the one that is
 * shown. */
void opening_lobe(Viewer *v, const char *path) {
    bool reread = true;
    const char *scene = v->states->shown.facts.path;
    if (v->states->opening.loader) {
        scene = loader_path(v->states->opening.loader, &reread);
    } else if (v->states->opening.has_pending) {
        scene = v->states->opening.pending.path;
        reread = v->states->opening.pending.reread;
    }
    start_reading(v, scene, path, reread);
}

bool opening_begin(Viewer *v) {
    v->states->opening.file_watch = file_watch_start();
    if (!v->states->opening.file_watch) return false;
    for (const char *const *lobe = v->desc->lobes; lobe && *lobe; lobe++) keep_lobe(v, *lobe);
    char last[STATE_PATH];
    const bool plain = !v->desc->scene && !v->desc->forget && !(v->desc->options && v->desc->options[0]);
    v->states->opening.resumes = plain && sessions_last(last);
    opening_start(v, v->desc->scene ? v->desc->scene : v->states->opening.resumes ? last : "builtin:cloth", false);
    return true;
}

/* Guesses the input that an image is for by its name, such as "velvet_normal.png". */
static int guess_input(const char *path) {
    static const char *const words[][2] = {
        {"normal", "normal"},     {"sheenrough", "sheen_roughness"}, {"sheen", "sheen_color"}, {"rough", "roughness"},
        {"metal", "metallic"},    {"specular", "specular_color"},    {"emissi", "emission"},   {"opacity", "opacity"},
        {"nap", "nap_direction"}, {"occlusion", "occlusion"}};
    for (size_t k = 0; k < sizeof words / sizeof *words; k++)
        if (path_contains(path, words[k][0])) return weft_material_input_find(words[k][1]);
    return weft_material_input_find("base_color");
}

void opening_ask(Viewer *v, const char *path) {
    if (path_kind(path) != PATH_SCENE || !leaving_asks(v, path)) opening_open(v, path);
}

void opening_open(Viewer *v, const char *path) {
    PathKind kind = path_kind(path);
    if (!v->states->shown.any && kind != PATH_SCENE) {
        viewer_report(v, true, "%.300s: open a scene first", path);
        return;
    }
    switch (kind) {
    case PATH_SCENE: opening_start(v, path, false); break;
    case PATH_LIGHT: actions_light_by(v, path); break;
    case PATH_MATERIAL: actions_send(v, TASK_ASSIGN, path, v->edit->material, -1); break;
    case PATH_LOBE: opening_lobe(v, path); break;
    case PATH_DRAFT: actions_weave_file(v, path); break;
    case PATH_PICTURE: dialogs_choose_use(v, path, guess_input(path)); break;
    case PATH_FOLDER:
        if (path_is_cubemap(path))
            actions_light_by(v, path);
        else
            actions_send(v, TASK_BIND_MAPS, path, -1, -1);
        break;
    case PATH_UNKNOWN:
        viewer_report(v, true,
                      "%.300s: is not a scene (.gltf .glb), light (.hdr .exr), material (.json), lobe (.h) or picture",
                      path);
        break;
    }
}

/* Copies the edits to a reread scene; maps, weaves and measurements are those of the file. */
static void keep_edits(const Viewer *v, SceneState *state) {
    for (int k = 0; k < state->material_count; k++) {
        if (scene_state_same_material(&v->edit->state, &v->edit->first, k)) continue;
        WeftMaterial m = *scene_state_material(&v->edit->state, k);
        for (int i = 0; i < WEFT_INPUTS_MAX; i++)
            if (m.inputs[i].texture) m.inputs[i].texture = scene_state_material(state, k)->inputs[i].texture;
        m.cloth = scene_state_material(state, k)->cloth;
        m.measured = scene_state_material(state, k)->measured;
        scene_state_set_material(state, k, &m);
        scene_state_set_preset(state, k, scene_state_preset(&v->edit->state, k));
    }
    state->variant = v->edit->state.variant;
    state->light_count = v->edit->state.light_count;
    memcpy(state->lights, v->edit->state.lights, sizeof state->lights);
    state->environment = v->edit->state.environment;
    scene_state_take_naps(state, &v->edit->state);
}

static void forget_scene(Viewer *v) {
    edit_forget(v);
    requests_forget(v);
    facts_free(&v->states->shown.facts);
}

static void show_maps(Viewer *v) {
    ShownScene *shown = &v->states->shown;
    if (shown->facts.thumbs.pixels) viewer_upload(&shown->maps_texture, &shown->facts.thumbs);
}

void opening_take_maps(Viewer *v, RenderEvent *event) {
    Facts *facts = &v->states->shown.facts;
    const Facts was = *facts;
    facts->maps = event->maps.maps, facts->map_count = event->maps.map_count;
    facts->map_paths = event->maps.map_paths;
    facts->thumbs = event->maps.thumbs;
    facts->cloths = event->maps.cloths, facts->cloth_count = event->maps.cloth_count;
    event->maps.maps = was.maps, event->maps.thumbs = was.thumbs;
    event->maps.map_paths = was.map_paths, event->maps.map_count = was.map_count;
    event->maps.cloths = was.cloths, event->maps.cloth_count = was.cloth_count;
    show_maps(v);
}

void opening_keep_folder(Viewer *v, const char *path) { folders_keep(&v->states->shown.folders, path, -1); }

void opening_warn(Viewer *v, const char *lines) {
    char *warnings = v->states->shown.warnings;
    size_t used = strlen(warnings);
    if (lines) snprintf(warnings + used, sizeof v->states->shown.warnings - used, "%s", lines);
}

void opening_end(Viewer *v) {
    OpeningState *opening = &v->states->opening;
    if (opening->loader) loader_finish(opening->loader, NULL);
    if (opening->leaving) loader_finish(opening->leaving, NULL);
    if (opening->has_pending) loaded_free(&opening->pending);
    file_watch_stop(opening->file_watch);
    if (v->window) glDeleteTextures(1, &v->states->shown.maps_texture);
    forget_scene(v);
}

/* Returns the material with the largest visible share, preferring materials with a sheen, since a backdrop is larger
 * than the object before it. */
static int largest_seen(const SceneState *state, const float *coverage) {
    int count = state->material_count, largest = -1;
    char *sheens = calloc((size_t)count + 1, 1);
    for (int k = 0; k < count && sheens; k++)
        sheens[k] = (char)(weft_material_reads(scene_state_material(state, k),
                                               weft_material_input_find("sheen_roughness")) != 0);
    if (sheens && coverage) largest = survey_largest(coverage, count, sheens);
    if (largest < 0 && coverage) largest = survey_largest(coverage, count, NULL);
    free(sheens);
    return largest > 0 ? largest : 0;
}

/* Chooses material and light of a new scene for the panels. */
static void choose_first(Viewer *v, const SceneState *state) {
    edit_choose_material(v, largest_seen(state, v->states->shown.facts.coverage));
    edit_choose_light(v, 0);
    edit_forget_copy(v);
    requests_forget_probe(v);
    dialogs_forget_paths(v);
}

void opening_varied(Viewer *v, float **coverage) {
    int count = v->edit->state.material_count;
    const float *is = *coverage, *was = v->states->shown.facts.coverage;
    char *put_on = calloc((size_t)count + 1, 1);
    for (int k = 0; k < count && put_on && was; k++) put_on[k] = (char)(was[k] < 0.0f && is[k] >= 0.0f);
    int other = put_on ? survey_largest(is, count, put_on) : -1;
    if (other < 0 && v->edit->material < count && is[v->edit->material] < 0.0f) other = survey_largest(is, count, NULL);
    if (other >= 0) edit_choose_material(v, other);
    free(put_on);
    free(v->states->shown.facts.coverage);
    v->states->shown.facts.coverage = *coverage;
    *coverage = NULL;
}

bool opening_watch(Viewer *v, double seconds) {
    if (v->states->shown.any && strcmp(v->states->opening.watched, v->edit->state.environment.path) != 0)
        watch_files(v);
    if (v->states->opening.loader || v->states->opening.has_pending) return false;
    int changed = file_watch_poll(v->states->opening.file_watch, seconds);
    if (changed == WATCH_SCENE) opening_start(v, v->states->shown.facts.path, true);
    if (changed == WATCH_LIGHT) actions_light_by(v, v->edit->state.environment.path);
    if (changed >= WATCH_LOBES) opening_lobe(v, v->states->opening.lobes[changed - WATCH_LOBES]);
    return changed >= 0;
}

/* Sends the scene that was read to the renderer; it is shown when the renderer is ready. */
static void hand_over(Viewer *v, Loaded *loaded) {
    if (v->states->opening.has_pending) loaded_free(&v->states->opening.pending);
    if (!loaded->reread || !v->states->shown.any) camera_begin(v, loaded->scene, loaded->camera);
    renderer_set_scene(v->renderer, loaded->scene, &loaded->state, &loaded->folders, ++v->states->opening.scenes);
    loaded->scene = NULL;
    v->states->opening.pending = *loaded;
    v->states->opening.has_pending = true;
    *loaded = (Loaded){0};
}

/* Takes the lobes that a session has loaded. */
static void keep_lobes(Viewer *v, const json_t *session) {
    const json_t *lobes = json_object_get(session, "lobes");
    for (size_t k = 0; k < json_array_size(lobes); k++)
        if (json_is_string(json_array_get(lobes, k))) keep_lobe(v, json_string_value(json_array_get(lobes, k)));
}

/* Shows the scene that was read. What a session restores differs from the state before, and so becomes a step of
 * history: undo gives the scene of the file. */
static void show_scene(Viewer *v, Loaded *loaded) {
    SceneState state, before;
    bool reread = loaded->reread && v->states->shown.any &&
                  loaded->state.material_count == v->edit->state.material_count &&
                  strcmp(loaded->path, v->states->shown.facts.path) == 0;
    const SceneState *shown = loaded->restored.session ? &loaded->restored.state : &loaded->state;
    if (!scene_state_copy(&state, shown)) return;
    if (reread) keep_edits(v, &state);
    if (!scene_state_copy(&before, loaded->restored.session ? &loaded->state : &state)) {
        scene_state_free(&state);
        return;
    }
    forget_scene(v);
    edit_begin(v, &state, &before, &loaded->state);
    v->states->shown.facts = loaded->facts;
    v->states->shown.folders = loaded->folders;
    show_maps(v);
    loaded->state = (SceneState){0};
    loaded->facts = (Facts){0};
    if (!reread) options_set_stage(v, &v->states->shown.facts.stage);
    if (!reread) choose_first(v, &v->edit->state);
    v->states->shown.any = true;
    requests_due(v);
    dialogs_take_profiles(v, NULL);
    snprintf(v->states->shown.warnings, sizeof v->states->shown.warnings, "%s",
             loaded->warnings ? loaded->warnings : "");
    viewer_add_recent(v, v->states->shown.facts.path);
    keep_lobes(v, loaded->restored.session);
    if (!reread) sessions_begin(v, loaded);
    watch_files(v);
}

void opening_take(Viewer *v, const RenderEvent *event) {
    if (!v->states->opening.has_pending || event->scene != v->states->opening.scenes) return;
    Loaded loaded = v->states->opening.pending;
    v->states->opening.has_pending = false;
    if (!event->failed) {
        char title[300];
        show_scene(v, &loaded);
        v->states->shown.number = event->scene;
        viewer_report(v, false, "%.200s: %lld triangles, %d materials%s%.200s", v->states->shown.facts.path,
                      v->states->shown.facts.info.triangle_count, v->states->shown.facts.info.material_count,
                      v->states->shown.folders.count ? ", maps of " : "",
                      v->states->shown.folders.count ? v->states->shown.folders.paths[0] : "");
        if (loaded.restored.session)
            viewer_report(v, false, "%.200s: restored what was not saved; undo (Ctrl+Z) gives the file as it is",
                          path_name(v->states->shown.facts.path));
        if (loaded.restored.complaint[0]) viewer_report(v, true, "%s", loaded.restored.complaint);
        if (loaded.lobe[0]) viewer_report(v, false, "%.300s: read again, with the scene", loaded.lobe);
        snprintf(title, sizeof title, "weft - %.200s", path_name(v->states->shown.facts.path));
        window_title(v->window, title);
    }
    v->states->opening.opened = event->result;
    loaded_free(&loaded);
}

void opening_poll(Viewer *v) {
    Loaded loaded;
    if (v->states->opening.leaving && loader_done(v->states->opening.leaving)) leave(v);
    if (!v->states->opening.loader || !loader_done(v->states->opening.loader)) return;
    loader_finish(v->states->opening.loader, &loaded);
    v->states->opening.loader = NULL;
    v->states->opening.opened = loaded.result;
    if (loaded.taken) keep_lobe(v, loaded.lobe);
    const bool instead = v->states->opening.resumes && !loaded.scene && !v->states->shown.any;
    v->states->opening.resumes = false;
    if (loaded.scene)
        hand_over(v, &loaded);
    else
        viewer_report(v, true, "%s", loaded.failure);
    if (instead) v->states->opening.opened = WEFT_OK, opening_start(v, "builtin:cloth", false);
    loaded_free(&loaded);
}
