/* Files: a scene is read in the background, handed to the renderer, and shown once that can draw it. */
#define _POSIX_C_SOURCE 200809L
#include "view/state/opening.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <epoxy/gl.h>

#include "view/files/paths.h"
#include "view/files/survey.h"
#include "view/state/frame_requests.h"
#include "view/state/rooms.h"

enum { WATCH_SCENE, WATCH_LIGHT, WATCH_LOBES };

/* Watches the files of scene, light and lobes; the renderer watches those of textures. */
static void watch_files(Viewer *v) {
    file_watch_clear(v->rooms->opening.file_watch);
    if (strncmp(v->rooms->shown.facts.path, "builtin:", 8) != 0)
        file_watch_add(v->rooms->opening.file_watch, v->rooms->shown.facts.path, WATCH_SCENE);
    if (v->edit->state.environment.kind == ENVIRONMENT_FILE)
        file_watch_add(v->rooms->opening.file_watch, v->edit->state.environment.path, WATCH_LIGHT);
    for (int k = 0; k < v->rooms->opening.lobe_count; k++)
        file_watch_add(v->rooms->opening.file_watch, v->rooms->opening.lobes[k], WATCH_LOBES + k);
    snprintf(v->rooms->opening.watched, sizeof v->rooms->opening.watched, "%s",
             v->edit->state.environment.path);
}

/* Adds a lobe's file to those that are watched. */
static void keep_lobe(Viewer *v, const char *path) {
    for (int k = 0; k < v->rooms->opening.lobe_count; k++)
        if (strcmp(v->rooms->opening.lobes[k], path) == 0) return;
    if (v->rooms->opening.lobe_count == STATE_LOBES) return;
    snprintf(v->rooms->opening.lobes[v->rooms->opening.lobe_count++], STATE_PATH, "%s", path);
    if (v->rooms->shown.any) watch_files(v);
}

/* Drops a scene that is no longer needed; its lobe is kept if the library has taken it. */
static void leave(Viewer *v) {
    Loaded loaded;
    loader_finish(v->rooms->opening.leaving, &loaded);
    v->rooms->opening.leaving = NULL;
    if (loaded.taken)
        keep_lobe(v, loaded.lobe);
    else if (loaded.lobe[0])
        viewer_say(v, true, "%s", loaded.failure);
    loaded_free(&loaded);
}

/* Stops the loader without waiting for it; another one takes its place. */
static void let_go(Viewer *v) {
    if (v->rooms->opening.leaving) leave(v);
    loader_stop(v->rooms->opening.loader);
    v->rooms->opening.leaving = v->rooms->opening.loader;
    v->rooms->opening.loader = NULL;
}

static void start_reading(Viewer *v, const char *path, const char *lobe, bool again) {
    if (v->rooms->opening.loader) let_go(v);
    bool configured = !v->rooms->opening.configured[0] || strcmp(v->rooms->opening.configured, path) == 0;
    if (!v->rooms->opening.configured[0])
        snprintf(v->rooms->opening.configured, sizeof v->rooms->opening.configured, "%s", path);
    Folders folders = {0};
    if (configured && !v->rooms->shown.any && v->desc->materials)
        folders_keep(&folders, v->desc->materials, -1);
    const Reading reading = {
        path, lobe, again, configured, again ? &v->rooms->shown.folders : &folders, viewer_aspect(v)};
    v->rooms->opening.loader = loader_start(v->window, v->desc, &reading);
    if (v->rooms->opening.loader) return;
    v->rooms->opening.opened = WEFT_RESOURCES;
    viewer_say(v, true, "%.300s: out of memory", path);
}

void opening_start(Viewer *v, const char *path, bool again) { start_reading(v, path, NULL, again); }

/* Reads the lobe with the scene that is being read, else the one that the renderer prepares, else the one that is
 * shown. */
void opening_lobe(Viewer *v, const char *path) {
    bool again = true;
    const char *scene = v->rooms->shown.facts.path;
    if (v->rooms->opening.loader) {
        scene = loader_path(v->rooms->opening.loader, &again);
    } else if (v->rooms->opening.has_pending) {
        scene = v->rooms->opening.pending.path;
        again = v->rooms->opening.pending.again;
    }
    start_reading(v, scene, path, again);
}

bool opening_begin(Viewer *v) {
    v->rooms->opening.file_watch = file_watch_start();
    if (!v->rooms->opening.file_watch) return false;
    for (const char *const *lobe = v->desc->lobes; lobe && *lobe; lobe++) keep_lobe(v, *lobe);
    opening_start(v, v->desc->scene ? v->desc->scene : "builtin:cloth", false);
    return true;
}

/* Guesses the input that an image is for by its name, such as "velvet_normal.png". */
static int guess_input(const char *path) {
    static const char *const words[][2] = {{"normal", "normal"},     {"sheenrough", "sheen_roughness"},
                                           {"sheen", "sheen_color"}, {"rough", "roughness"},
                                           {"metal", "metallic"},    {"specular", "specular_color"},
                                           {"emissi", "emission"},   {"opacity", "opacity"},
                                           {"nap", "nap_direction"}, {"occlusion", "occlusion"}};
    for (size_t k = 0; k < sizeof words / sizeof *words; k++)
        if (path_contains(path, words[k][0])) return weft_material_input_find(words[k][1]);
    return weft_material_input_find("base_color");
}

void viewer_open(Viewer *v, const char *path) {
    PathKind kind = path_kind(path);
    if (!v->rooms->shown.any && kind != PATH_SCENE) {
        viewer_say(v, true, "%.300s: open a scene first", path);
        return;
    }
    switch (kind) {
    case PATH_SCENE: opening_start(v, path, false); break;
    case PATH_LIGHT: viewer_light_by(v, path); break;
    case PATH_MATERIAL: viewer_task(v, TASK_ASSIGN, path, v->edit->material, -1); break;
    case PATH_LOBE: opening_lobe(v, path); break;
    case PATH_PICTURE: dialogs_ask_use(v, path, guess_input(path)); break;
    case PATH_FOLDER:
        if (path_is_cubemap(path))
            viewer_light_by(v, path);
        else
            viewer_task(v, TASK_BIND_MAPS, path, -1, -1);
        break;
    case PATH_UNKNOWN:
        viewer_say(
            v, true,
            "%.300s: is not a scene (.gltf .glb), light (.hdr .exr), material (.json), lobe (.h) or picture",
            path);
        break;
    }
}

/* Keeps the edits when the scene is read again; maps, weaves and measurements are those of the file. */
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
    facts_free(&v->rooms->shown.facts);
}

static void show_maps(Viewer *v) {
    ShownRoom *shown = &v->rooms->shown;
    if (shown->facts.thumbs.pixels) viewer_upload(&shown->maps_texture, &shown->facts.thumbs);
}

void opening_take_maps(Viewer *v, RenderEvent *event) {
    Facts *facts = &v->rooms->shown.facts;
    const Facts was = *facts;
    facts->maps = event->maps.maps, facts->map_count = event->maps.map_count;
    facts->thumbs = event->maps.thumbs;
    facts->cloths = event->maps.cloths, facts->cloth_count = event->maps.cloth_count;
    event->maps.maps = was.maps, event->maps.thumbs = was.thumbs;
    event->maps.cloths = was.cloths, event->maps.cloth_count = was.cloth_count;
    show_maps(v);
}

void opening_keep_folder(Viewer *v, const char *path) { folders_keep(&v->rooms->shown.folders, path, -1); }

void opening_warn(Viewer *v, const char *lines) {
    char *warnings = v->rooms->shown.warnings;
    size_t used = strlen(warnings);
    if (lines) snprintf(warnings + used, sizeof v->rooms->shown.warnings - used, "%s", lines);
}

void opening_end(Viewer *v) {
    OpeningRoom *opening = &v->rooms->opening;
    if (opening->loader) loader_finish(opening->loader, NULL);
    if (opening->leaving) loader_finish(opening->leaving, NULL);
    if (opening->has_pending) loaded_free(&opening->pending);
    file_watch_stop(opening->file_watch);
    if (v->window) glDeleteTextures(1, &v->rooms->shown.maps_texture);
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
    edit_choose_material(v, largest_seen(state, v->rooms->shown.facts.coverage));
    edit_choose_light(v, 0);
    edit_forget_copy(v);
    requests_forget_probe(v);
    dialogs_forget_paths(v);
}

/* Chooses the most visible material that the variant has put on. If there is none and the chosen material is no longer
 * used, it chooses the most visible one. */
void opening_varied(Viewer *v, float **coverage) {
    int count = v->edit->state.material_count;
    const float *is = *coverage, *was = v->rooms->shown.facts.coverage;
    char *put_on = calloc((size_t)count + 1, 1);
    for (int k = 0; k < count && put_on && was; k++) put_on[k] = (char)(was[k] < 0.0f && is[k] >= 0.0f);
    int other = put_on ? survey_largest(is, count, put_on) : -1;
    if (other < 0 && v->edit->material < count && is[v->edit->material] < 0.0f)
        other = survey_largest(is, count, NULL);
    if (other >= 0) edit_choose_material(v, other);
    free(put_on);
    free(v->rooms->shown.facts.coverage);
    v->rooms->shown.facts.coverage = *coverage;
    *coverage = NULL;
}

bool opening_watch(Viewer *v, double seconds) {
    if (v->rooms->shown.any && strcmp(v->rooms->opening.watched, v->edit->state.environment.path) != 0)
        watch_files(v);
    if (v->rooms->opening.loader || v->rooms->opening.has_pending) return false;
    int changed = file_watch_poll(v->rooms->opening.file_watch, seconds);
    if (changed == WATCH_SCENE) opening_start(v, v->rooms->shown.facts.path, true);
    if (changed == WATCH_LIGHT) viewer_light_by(v, v->edit->state.environment.path);
    if (changed >= WATCH_LOBES) opening_lobe(v, v->rooms->opening.lobes[changed - WATCH_LOBES]);
    return changed >= 0;
}

/* Sends the scene that was read to the renderer; it is shown when the renderer is ready. */
static void hand_over(Viewer *v, Loaded *loaded) {
    if (v->rooms->opening.has_pending) loaded_free(&v->rooms->opening.pending);
    if (!loaded->again || !v->rooms->shown.any) camera_begin(v, loaded->scene, loaded->camera);
    renderer_set_scene(v->renderer, loaded->scene, &loaded->state, &loaded->folders,
                       ++v->rooms->opening.scenes);
    loaded->scene = NULL;
    v->rooms->opening.pending = *loaded;
    v->rooms->opening.has_pending = true;
    *loaded = (Loaded){0};
}

static void show_scene(Viewer *v, Loaded *loaded) {
    SceneState state, before;
    bool again = loaded->again && v->rooms->shown.any &&
                 loaded->state.material_count == v->edit->state.material_count &&
                 strcmp(loaded->path, v->rooms->shown.facts.path) == 0;
    if (!scene_state_copy(&state, &loaded->state)) return;
    if (again) keep_edits(v, &state);
    if (!scene_state_copy(&before, &state)) {
        scene_state_free(&state);
        return;
    }
    forget_scene(v);
    doctor_forget(v);
    edit_begin(v, &state, &before, &loaded->state);
    v->rooms->shown.facts = loaded->facts;
    v->rooms->shown.folders = loaded->folders;
    show_maps(v);
    loaded->state = (SceneState){0};
    loaded->facts = (Facts){0};
    if (!again) choose_first(v, &v->edit->state);
    v->rooms->shown.any = true;
    requests_due(v);
    dialogs_take_profiles(v, NULL);
    snprintf(v->rooms->shown.warnings, sizeof v->rooms->shown.warnings, "%s",
             loaded->warnings ? loaded->warnings : "");
    viewer_opened(v, v->rooms->shown.facts.path);
    watch_files(v);
}

void opening_take(Viewer *v, const RenderEvent *event) {
    if (!v->rooms->opening.has_pending || event->scene != v->rooms->opening.scenes) return;
    Loaded loaded = v->rooms->opening.pending;
    v->rooms->opening.has_pending = false;
    if (!event->failed) {
        char title[300];
        show_scene(v, &loaded);
        v->rooms->shown.number = event->scene;
        viewer_say(v, false, "%.200s: %lld triangles, %d materials%s%.200s", v->rooms->shown.facts.path,
                   v->rooms->shown.facts.info.triangle_count, v->rooms->shown.facts.info.material_count,
                   v->rooms->shown.folders.count ? ", maps of " : "",
                   v->rooms->shown.folders.count ? v->rooms->shown.folders.paths[0] : "");
        if (loaded.lobe[0]) viewer_say(v, false, "%.300s: read again, with the scene", loaded.lobe);
        snprintf(title, sizeof title, "weft - %.200s", path_name(v->rooms->shown.facts.path));
        window_title(v->window, title);
    }
    v->rooms->opening.opened = event->result;
    loaded_free(&loaded);
}

void opening_poll(Viewer *v) {
    Loaded loaded;
    if (v->rooms->opening.leaving && loader_done(v->rooms->opening.leaving)) leave(v);
    if (!v->rooms->opening.loader || !loader_done(v->rooms->opening.loader)) return;
    loader_finish(v->rooms->opening.loader, &loaded);
    v->rooms->opening.loader = NULL;
    v->rooms->opening.opened = loaded.result;
    if (loaded.taken) keep_lobe(v, loaded.lobe);
    if (loaded.scene)
        hand_over(v, &loaded);
    else
        viewer_say(v, true, "%s", loaded.failure);
    loaded_free(&loaded);
}
