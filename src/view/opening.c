/* Files: a scene is read in the background, handed to the renderer, and shown once that can draw it. */
#define _POSIX_C_SOURCE 200809L
#include "view/opening.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "view/examine.h"
#include "view/paths.h"
#include "view/survey.h"

enum { WATCH_SCENE, WATCH_LIGHT, WATCH_LOBES };

/* The files of scene, light and lobes; those of textures are the renderer's to watch. */
static void watch_files(Viewer *v) {
    file_watch_clear(v->file_watch);
    if (strncmp(v->facts.path, "builtin:", 8) != 0) file_watch_add(v->file_watch, v->facts.path, WATCH_SCENE);
    if (v->state.environment.kind == ENVIRONMENT_FILE)
        file_watch_add(v->file_watch, v->state.environment.path, WATCH_LIGHT);
    for (int k = 0; k < v->lobe_count; k++) file_watch_add(v->file_watch, v->lobes[k], WATCH_LOBES + k);
    snprintf(v->watched, sizeof v->watched, "%s", v->state.environment.path);
}

/* It is watched from now on. */
static void keep_lobe(Viewer *v, const char *path) {
    for (int k = 0; k < v->lobe_count; k++)
        if (strcmp(v->lobes[k], path) == 0) return;
    if (v->lobe_count == STATE_LOBES) return;
    snprintf(v->lobes[v->lobe_count++], STATE_PATH, "%s", path);
    if (v->has_scene) watch_files(v);
}

/* A scene that nobody waits for; its lobe is taken all the same, or was not. */
static void leave(Viewer *v) {
    Loaded loaded;
    loader_finish(v->leaving, &loaded);
    v->leaving = NULL;
    if (loaded.taken)
        keep_lobe(v, loaded.lobe);
    else if (loaded.lobe[0])
        viewer_say(v, true, "%s", loaded.failure);
    loaded_free(&loaded);
}

/* Another one takes its place; it may take a while to stop, which is not waited for. */
static void let_go(Viewer *v) {
    if (v->leaving) leave(v);
    loader_stop(v->loader);
    v->leaving = v->loader;
    v->loader = NULL;
}

static void start_reading(Viewer *v, const char *path, const char *lobe, bool again) {
    if (v->loader) let_go(v);
    bool configured = !v->configured[0] || strcmp(v->configured, path) == 0;
    if (!v->configured[0]) snprintf(v->configured, sizeof v->configured, "%s", path);
    Folders folders = {0};
    if (configured && !v->has_scene && v->desc->materials) folders_keep(&folders, v->desc->materials, -1);
    const Reading reading = {path, lobe, again, configured, again ? &v->folders : &folders, viewer_aspect(v)};
    v->loader = loader_start(v->window, v->desc, &reading);
    if (v->loader) return;
    v->opened = WEFT_RESOURCES;
    viewer_say(v, true, "%.300s: out of memory", path);
}

void opening_start(Viewer *v, const char *path, bool again) { start_reading(v, path, NULL, again); }

/* With the scene that is being read, that is with the renderer, or that is there. */
void opening_lobe(Viewer *v, const char *path) {
    bool again = true;
    const char *scene = v->facts.path;
    if (v->loader) {
        scene = loader_path(v->loader, &again);
    } else if (v->has_pending) {
        scene = v->pending.path;
        again = v->pending.again;
    }
    start_reading(v, scene, path, again);
}

void opening_begin(Viewer *v) {
    for (const char *const *lobe = v->desc->lobes; lobe && *lobe; lobe++) keep_lobe(v, *lobe);
    opening_start(v, v->desc->scene ? v->desc->scene : "builtin:cloth", false);
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
    if (!v->has_scene && kind != PATH_SCENE) {
        viewer_say(v, true, "%.300s: open a scene first", path);
        return;
    }
    switch (kind) {
    case PATH_SCENE: opening_start(v, path, false); break;
    case PATH_LIGHT: viewer_light_by(v, path); break;
    case PATH_MATERIAL: viewer_task(v, TASK_ASSIGN, path, v->material, -1); break;
    case PATH_LOBE: opening_lobe(v, path); break;
    case PATH_PICTURE:
        snprintf(v->dropped, sizeof v->dropped, "%s", path);
        v->dropped_input = guess_input(path);
        viewer_dialog(v, "Use a picture");
        break;
    case PATH_FOLDER:
        if (path_is_cubemap(path))
            viewer_light_by(v, path);
        else
            viewer_task(v, TASK_BIND_MAPS, path, -1, -1);
        break;
    case PATH_UNKNOWN:
        viewer_say(
            v, true,
            "%.300s: is no scene (.gltf .glb), light (.hdr .exr), material (.json), lobe (.h) or picture",
            path);
        break;
    }
}

void opening_home(Viewer *v, const float eye[3], const float target[3]) {
    memcpy(v->home, target, sizeof v->home);
    v->reach = 0.0f;
    for (int k = 0; k < 3; k++) v->reach = hypotf(v->reach, eye[k] - target[k]);
    v->reach = fmaxf(0.5f * v->reach, 1e-3f);
}

/* Sets the first camera, and the size of things until the renderer knows the centre of the picture. */
static void start_seeing(Viewer *v, const Loaded *loaded) {
    if (!orbit_at(&v->orbit, loaded->scene, loaded->camera, viewer_aspect(v))) {
        viewer_say(v, true, "%.100s: %s", loaded->camera, weft_message_text(WEFT_MESSAGE_CAMERA_NAME));
        orbit_at(&v->orbit, loaded->scene, "auto", viewer_aspect(v));
    }
    v->at_home = false;
    opening_home(v, v->orbit.eye, v->orbit.target);
}

/* Keeps the edits when the scene is read again; maps are those of the file. */
static void keep_edits(const Viewer *v, SceneState *state) {
    for (int k = 0; k < state->material_count; k++) {
        if (scene_state_same_material(&v->state, &v->first, k)) continue;
        WeftMaterial m = *scene_state_material(&v->state, k);
        for (int i = 0; i < WEFT_INPUTS_MAX; i++)
            if (m.inputs[i].texture) m.inputs[i].texture = scene_state_material(state, k)->inputs[i].texture;
        scene_state_set_material(state, k, &m);
        scene_state_set_preset(state, k, scene_state_preset(&v->state, k));
    }
    state->variant = v->state.variant;
    state->light_count = v->state.light_count;
    memcpy(state->lights, v->state.lights, sizeof state->lights);
    state->environment = v->state.environment;
    scene_state_take_naps(state, &v->state);
}

void opening_forget(Viewer *v) {
    scene_state_free(&v->state);
    scene_state_free(&v->first);
    scene_state_free(&v->before);
    scene_state_free(&v->sent);
    scene_state_free(&v->other);
    history_free(&v->history);
    history_free(&v->other_history);
    facts_free(&v->facts);
}

/* The material that is seen largest, of those with a sheen where one is seen: a backdrop is larger than what
 * stands before it. */
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

/* Those of the panels, of a scene that is another one. */
static void choose_first(Viewer *v, const SceneState *state) {
    v->material = largest_seen(state, v->facts.coverage);
    v->light = 0;
    v->has_probe = v->has_copied = false;
    v->save_path[0] = v->shot_path[0] = '\0';
}

/* The choice goes to what the variant has put on, and away from what nothing wears any more. */
void opening_varied(Viewer *v, float **coverage) {
    int count = v->state.material_count;
    const float *is = *coverage, *was = v->facts.coverage;
    char *put_on = calloc((size_t)count + 1, 1);
    for (int k = 0; k < count && put_on && was; k++) put_on[k] = (char)(was[k] < 0.0f && is[k] >= 0.0f);
    int other = put_on ? survey_largest(is, count, put_on) : -1;
    if (other < 0 && v->material < count && is[v->material] < 0.0f) other = survey_largest(is, count, NULL);
    if (other >= 0) v->material = other;
    free(put_on);
    free(v->facts.coverage);
    v->facts.coverage = *coverage;
    *coverage = NULL;
}

bool opening_watch(Viewer *v, double seconds) {
    if (v->has_scene && strcmp(v->watched, v->state.environment.path) != 0) watch_files(v);
    if (v->loader || v->has_pending) return false;
    int changed = file_watch_poll(v->file_watch, seconds);
    if (changed == WATCH_SCENE) opening_start(v, v->facts.path, true);
    if (changed == WATCH_LIGHT) viewer_light_by(v, v->state.environment.path);
    if (changed >= WATCH_LOBES) opening_lobe(v, v->lobes[changed - WATCH_LOBES]);
    return changed >= 0;
}

/* The scene that was read goes to the renderer; it is shown once that can draw it. */
static void hand_over(Viewer *v, Loaded *loaded) {
    if (v->has_pending) loaded_free(&v->pending);
    if (!loaded->again || !v->has_scene) start_seeing(v, loaded);
    renderer_set_scene(v->renderer, loaded->scene, &loaded->state, &loaded->folders, ++v->scenes);
    loaded->scene = NULL;
    v->pending = *loaded;
    v->has_pending = true;
    *loaded = (Loaded){0};
}

static void show_scene(Viewer *v, Loaded *loaded) {
    SceneState state, before;
    bool again = loaded->again && v->has_scene && loaded->state.material_count == v->state.material_count &&
                 strcmp(loaded->path, v->facts.path) == 0;
    if (!scene_state_copy(&state, &loaded->state)) return;
    if (again) keep_edits(v, &state);
    if (!scene_state_copy(&before, &state)) {
        scene_state_free(&state);
        return;
    }
    opening_forget(v);
    examination_free(v->examination); /* of the file as it was */
    v->examination = NULL;
    v->state = state;
    v->before = before;
    v->first = loaded->state;
    v->facts = loaded->facts;
    v->folders = loaded->folders;
    viewer_show_maps(v);
    loaded->state = (SceneState){0};
    loaded->facts = (Facts){0};
    v->split = SPLIT_NONE;
    v->side = 0;
    if (!again) choose_first(v, &v->state);
    v->has_scene = v->ask = true;
    v->profiles_made = false;
    snprintf(v->warnings, sizeof v->warnings, "%s", loaded->warnings ? loaded->warnings : "");
    settings_opened(&v->settings, v->facts.path);
    watch_files(v);
}

/* The renderer has taken the scene, or could not: then the old one stays. */
void opening_take(Viewer *v, const RenderEvent *event) {
    if (!v->has_pending || event->scene != v->scenes) return;
    Loaded loaded = v->pending;
    v->has_pending = false;
    if (!event->failed) {
        char title[300];
        show_scene(v, &loaded);
        v->scene = event->scene;
        viewer_say(v, false, "%.200s: %lld triangles, %d materials%s%.200s", v->facts.path,
                   v->facts.info.triangle_count, v->facts.info.material_count,
                   v->folders.count ? ", maps of " : "", v->folders.count ? v->folders.paths[0] : "");
        if (loaded.lobe[0]) viewer_say(v, false, "%.300s: read, and the scene again", loaded.lobe);
        snprintf(title, sizeof title, "weft - %.200s", path_name(v->facts.path));
        window_title(v->window, title);
    }
    v->opened = event->result;
    loaded_free(&loaded);
}

void opening_poll(Viewer *v) {
    Loaded loaded;
    if (v->leaving && loader_done(v->leaving)) leave(v);
    if (!v->loader || !loader_done(v->loader)) return;
    loader_finish(v->loader, &loaded);
    v->loader = NULL;
    v->opened = loaded.result;
    if (loaded.taken) keep_lobe(v, loaded.lobe);
    if (loaded.scene)
        hand_over(v, &loaded);
    else
        viewer_say(v, true, "%s", loaded.failure);
    loaded_free(&loaded);
}
