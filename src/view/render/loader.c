#define _POSIX_C_SOURCE 200809L
#include "view/render/loader.h"

#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/path.h"
#include "base/printable.h"
#include "view/files/paths.h"
#include "view/files/session_file.h"
#include "view/files/survey.h"
#include "view/render/session_state.h"
#include "weft/weft.h"

struct Loader {
    Window *window;
    const ViewDesc *desc;
    bool configured;
    float aspect;
    pthread_t thread;
    atomic_int thousandths; /* done; -1: unknown */
    atomic_bool done, stop;
    char session[SESSION_PATH];
    Loaded loaded;
};

typedef const char *NameOf(const WeftScene *scene, int index);

/* Returns the file name of texture k, counted from 0, or NULL. Textures may share a file. */
static const char *file_name(const WeftScene *scene, int k) {
    const char *path = weft_scene_texture_path(scene, k + 1);
    return path ? path_name(path) : NULL;
}

/* Replaces control characters, those that have a meaning in a label, and bytes that are no UTF-8, such as a character
 * that was cut. */
static void make_fit(char *name) {
    for (int length; *name; name += length ? length : 1) {
        unsigned code;
        length = utf8_read((const unsigned char *)name, &code);
        if (length == 0) *name = '?';
        if (length == 1 && (code < 0x20 || code == '/' || code == '#')) *name = ' ';
    }
}

/* Appends a number to names that occur already. */
static void make_unique(FactName *names, int k) {
    for (int j = 0; j < k; j++) {
        if (strcmp(names[j], names[k]) != 0) continue;
        char stem[FACTS_NAME];
        memcpy(stem, names[k], sizeof stem);
        snprintf(names[k], FACTS_NAME, "%.48s (%d)", stem, k);
        make_fit(names[k]);
        return;
    }
}

static FactName *copy_names(const WeftScene *scene, int count, NameOf *name, const char *kind) {
    FactName *names = calloc((size_t)count + 1, sizeof *names);
    for (int k = 0; k < count && names; k++) {
        const char *text = name(scene, k);
        if (text && text[0])
            snprintf(names[k], FACTS_NAME, "%s", text);
        else
            snprintf(names[k], FACTS_NAME, "%s %d", kind, k);
        make_fit(names[k]);
        if (k < FACTS_MOST && name != file_name) make_unique(names, k);
    }
    return names;
}

/* Converts a texel to what is displayed: the first three channels, or grey from one or two. */
static void texel_shown(const WeftImage *image, int x, int y, unsigned char out[3]) {
    size_t at = ((size_t)y * (size_t)image->width + (size_t)x) * (size_t)image->channels;
    for (int c = 0; c < 3; c++) {
        size_t k = at + (size_t)(image->channels >= 3 ? c : 0);
        float value = image->type == WEFT_PIXEL_F32 ? ((const float *)image->pixels)[k] : 0.0f;
        out[c] = image->type == WEFT_PIXEL_U8    ? ((const unsigned char *)image->pixels)[k]
                 : image->type == WEFT_PIXEL_U16 ? (unsigned char)(((const uint16_t *)image->pixels)[k] >> 8)
                                                 : (unsigned char)(255.0f * fminf(fmaxf(value, 0.0f), 1.0f));
    }
}

/* Makes a thumbnail, whose texels are means of a few texels each. */
static void make_thumb(const WeftImage *image, unsigned char *out) {
    enum { SIDE = FACTS_THUMB, FINER = 4 };
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++, out += 3) {
            int sum[3] = {0};
            for (int k = 0; k < FINER * FINER; k++) {
                unsigned char texel[3];
                int across = (FINER * x + k % FINER) * 2 + 1, down = (FINER * y + k / FINER) * 2 + 1;
                texel_shown(image, (int)((long long)across * image->width / (2 * SIDE * FINER)),
                            (int)((long long)down * image->height / (2 * SIDE * FINER)), texel);
                for (int c = 0; c < 3; c++) sum[c] += texel[c];
            }
            for (int c = 0; c < 3; c++) out[c] = (unsigned char)(sum[c] / (FINER * FINER));
        }
}

/* Makes the thumbnails; none if memory is short. */
static void read_thumbs(Facts *facts, const WeftScene *scene) {
    int count = facts->map_count < FACTS_THUMBS ? facts->map_count : FACTS_THUMBS;
    if (!count ||
        weft_image_create(FACTS_THUMB, FACTS_THUMB * count, 3, WEFT_PIXEL_U8, &facts->thumbs, NULL) != WEFT_OK)
        return;
    for (int k = 0; k < count; k++) {
        WeftImage image = weft_scene_texture(scene, k + 1);
        make_thumb(&image, (unsigned char *)facts->thumbs.pixels + (size_t)k * FACTS_THUMB * FACTS_THUMB * 3);
    }
}

static void free_paths(Facts *facts) {
    for (int k = 0; k < facts->map_count && facts->map_paths; k++) free(facts->map_paths[k]);
    free(facts->map_paths);
    facts->map_paths = NULL;
}

static char **copy_paths(const WeftScene *scene, int count) {
    char **paths = calloc((size_t)count + 1, sizeof *paths);
    for (int k = 0; k < count && paths; k++) {
        const char *path = weft_scene_texture_path(scene, k + 1);
        if (path) paths[k] = strdup(path);
    }
    return paths;
}

static void free_cloths(Facts *facts) {
    for (int k = 0; k < facts->cloth_count; k++) {
        weft_draft_free(facts->cloths[k].draft);
        free(facts->cloths[k].text);
    }
    free(facts->cloths);
    facts->cloths = NULL;
    facts->cloth_count = 0;
}

/* Copies the cloths; fewer if memory is short. */
static void read_cloths(Facts *facts, const WeftScene *scene) {
    int count = 0;
    free_cloths(facts);
    while (weft_scene_cloth(scene, count + 1, NULL)) count++;
    facts->cloths = calloc((size_t)count + 1, sizeof *facts->cloths);
    for (int k = 0; facts->cloths && k < count; k++) {
        FactCloth *cloth = &facts->cloths[k];
        const WeftDraft *draft = weft_scene_cloth(scene, k + 1, cloth->yarns);
        if (weft_draft_copy(draft, &cloth->draft, NULL) != WEFT_OK) return;
        cloth->info = weft_scene_cloth_info(scene, k + 1);
        cloth->text = weft_scene_weave_text(scene, k + 1);
        facts->cloth_count++;
    }
}

static int count_maps(const WeftScene *scene) {
    int count = 0;
    while (weft_scene_texture(scene, count + 1).pixels) count++;
    return count;
}

void facts_read_maps(Facts *facts, const WeftScene *scene) {
    const int count = count_maps(scene);
    FactName *names = copy_names(scene, count, file_name, "map");
    char **paths = copy_paths(scene, count);
    if (!names || !paths) {
        free(names);
        free(paths);
        return;
    }
    free_paths(facts);
    free(facts->maps);
    facts->maps = names;
    facts->map_paths = paths;
    facts->map_count = count;
    weft_image_free(&facts->thumbs);
    read_thumbs(facts, scene);
    read_cloths(facts, scene);
}

bool facts_read(Facts *facts, const WeftScene *scene, const char *path) {
    *facts = (Facts){.info = weft_scene_info(scene), .stage = weft_scene_stage(scene)};
    snprintf(facts->path, sizeof facts->path, "%s", path);
    facts->materials = copy_names(scene, facts->info.material_count, weft_scene_material_name, "material");
    facts->cameras = copy_names(scene, facts->info.camera_count, weft_scene_camera_name, "camera");
    facts->variants = copy_names(scene, facts->info.variant_count, weft_scene_variant_name, "variant");
    facts_read_maps(facts, scene);
    if (facts->materials && facts->cameras && facts->variants) return true;
    facts_free(facts);
    return false;
}

void facts_free(Facts *facts) {
    free(facts->materials);
    free(facts->cameras);
    free(facts->variants);
    free(facts->maps);
    free_paths(facts);
    weft_image_free(&facts->thumbs);
    free(facts->coverage);
    free_cloths(facts);
    *facts = (Facts){0};
}

static void on_warning(void *user, WeftMessage message, const char *text) {
    Loaded *loaded = user;
    size_t used = loaded->warnings ? strlen(loaded->warnings) : 0;
    if (used > 16384) return;
    char *grown = realloc(loaded->warnings, used + strlen(text) + 2);
    if (!grown) return;
    loaded->warnings = grown;
    sprintf(grown + used, "%s\n", text);
}

static int on_progress(void *user, double fraction) {
    Loader *self = user;
    atomic_store(&self->thousandths, (int)(1000.0 * fraction));
    window_wake(self->window);
    return atomic_load(&self->stop);
}

/* Returns the camera of the command line if it was given for this scene, else the first of a built-in scene, else one
 * that frames everything. */
static const char *first_camera(const Loader *self) {
    bool builtin = path_is_on_builtin(self->loaded.path);
    if (self->configured && self->desc->camera) return self->desc->camera;
    return builtin && self->loaded.facts.info.camera_count ? "0" : "auto";
}

/* Surveys which material covers most of the picture. A survey that fails is no failure of the load. */
static void survey(Loader *self) {
    Loaded *loaded = &self->loaded;
    WeftPick *pick;
    if (weft_pick_create(loaded->scene, &pick, NULL) != WEFT_OK) return;
    loaded->facts.coverage = survey_take(pick, loaded->scene, loaded->camera, self->aspect);
    weft_pick_free(pick);
}

/* Binds the folders of maps. A folder that no longer exists, or has no maps, is dropped with a warning. */
static void bind_folders(Loaded *loaded, const WeftLog *log) {
    Folders *folders = &loaded->folders;
    int kept = 0;
    for (int k = 0; k < folders->count; k++) {
        char target[16];
        WeftError error = {0};
        snprintf(target, sizeof target, "%d", folders->materials[k]);
        WeftResult result = weft_scene_bind_maps(loaded->scene, folders->materials[k] < 0 ? NULL : target,
                                                 folders->paths[k], NULL, log, &error);
        if (result != WEFT_OK) log->fn(log->user, error.message, error.text);
        if (result != WEFT_OK) continue;
        memmove(folders->paths[kept], folders->paths[k], STATE_PATH);
        folders->materials[kept++] = folders->materials[k];
    }
    folders->count = kept;
}

/* Returns true if the session is that of the file as it is now. */
static bool belongs(const json_t *session, const Facts *facts) {
    const json_t *names = json_object_get(session, "names");
    bool same = json_integer_value(json_object_get(session, "maps")) == facts->own_maps &&
                json_array_size(names) == (size_t)facts->info.material_count;
    for (int k = 0; same && k < facts->info.material_count; k++) {
        const char *name = json_string_value(json_array_get(names, (size_t)k));
        same = name && strcmp(name, facts->materials[k]) == 0;
    }
    return same;
}

static void restored_free(Restored *restored) {
    json_decref(restored->session);
    scene_state_free(&restored->state);
    scene_state_free(&restored->other);
    restored->session = NULL;
}

/* Loads the lobes of a session that the program does not have. One that fails leaves choices unknown, which is reported
 * then. */
static void load_lobes(const Loader *self, const json_t *session, const WeftLog *log) {
    const json_t *lobes = json_object_get(session, "lobes");
    for (size_t k = 0; k < json_array_size(lobes); k++) {
        const char *path = json_string_value(json_array_get(lobes, k));
        const char *const *has = self->desc->lobes;
        while (path && has && *has && strcmp(*has, path) != 0) has++;
        if (path && !(has && *has)) weft_lobe_load(path, NULL, log, NULL);
    }
}

/* Keeps a session that cannot be restored beside its file, which the window writes anew. */
static void keep_aside(const char *session) {
    char aside[SESSION_PATH + 16];
    snprintf(aside, sizeof aside, "%s.unrestored", session);
    unlink(aside);
    if (link(session, aside) != 0) return; /* a file system without links: nothing better can be done */
}

/* Reads the session, if there is one, before the scene is read. */
static void read_session(Loader *self, const WeftLog *log) {
    Restored *restored = &self->loaded.restored;
    bool damaged = false;
    if (!self->session[0]) return;
    restored->session = session_file_read(self->session, &damaged);
    if (damaged) keep_aside(self->session);
    if (damaged)
        snprintf(restored->complaint, sizeof restored->complaint, "%.300s: is damaged: nothing is restored of it",
                 self->session);
    load_lobes(self, restored->session, log);
}

/* Restores the states of the session. */
static void restore(Loader *self) {
    Loaded *loaded = &self->loaded;
    Restored *restored = &loaded->restored;
    WeftError error = {.text = "out of memory"};
    if (!restored->session) return;
    const json_t *other = json_object_get(restored->session, "other");
    WeftResult result = WEFT_INPUT;
    if (!belongs(restored->session, &loaded->facts))
        snprintf(error.text, sizeof error.text, "the file of the scene has changed since");
    else
        result = session_state_read(json_object_get(restored->session, "state"), self->session, 0, loaded->scene,
                                    &loaded->state, &restored->state, &error);
    if (result == WEFT_OK && other)
        result = session_state_read(other, self->session, STATE_NAPS, loaded->scene, &loaded->state, &restored->other,
                                    &error);
    facts_read_maps(&loaded->facts, loaded->scene);
    if (result == WEFT_OK) return;
    keep_aside(self->session);
    snprintf(restored->complaint, sizeof restored->complaint, "what was not saved is not restored: %.400s", error.text);
    restored_free(restored);
}

static WeftResult load(Loader *self, WeftError *error) {
    Loaded *loaded = &self->loaded;
    const WeftLog log = {on_warning, loaded};
    const ViewDesc *desc = self->desc;
    EnvironmentState environment = environment_state_studio();
    WeftResult result = loaded->lobe[0] ? weft_lobe_load(loaded->lobe, NULL, &log, error) : WEFT_OK;
    if (result != WEFT_OK) return result;
    loaded->taken = loaded->lobe[0] != 0;
    read_session(self, &log);
    result = weft_scene_load_moment(loaded->path, self->configured ? desc->moment : NULL, on_progress, self,
                                    &loaded->scene, &log, error);
    if (result == WEFT_OK && atomic_load(&self->stop)) result = WEFT_INTERRUPTED;
    const int own_maps = result == WEFT_OK ? count_maps(loaded->scene) : 0;
    if (result == WEFT_OK && self->configured && desc->configure)
        result = desc->configure(desc->user, loaded->scene, &environment, &log, error);
    if (result != WEFT_OK) return result;
    bind_folders(loaded, &log);
    if (!scene_state_read(&loaded->state, loaded->scene) || !facts_read(&loaded->facts, loaded->scene, loaded->path)) {
        snprintf(error->text, sizeof error->text, "%.300s: out of memory", loaded->path);
        return WEFT_RESOURCES;
    }
    loaded->facts.own_maps = own_maps;
    loaded->state.environment = environment;
    restore(self);
    loaded->camera = first_camera(self);
    survey(self);
    return WEFT_OK;
}

static void *work(void *user) {
    Loader *self = user;
    WeftError error = {0};
    self->loaded.result = load(self, &error);
    if (self->loaded.result != WEFT_OK) {
        weft_scene_free(self->loaded.scene);
        self->loaded.scene = NULL;
        snprintf(self->loaded.failure, sizeof self->loaded.failure, "%s", error.text);
    }
    atomic_store(&self->done, true);
    window_wake(self->window);
    return NULL;
}

Loader *loader_start(Window *window, const ViewDesc *desc, const Reading *reading) {
    Loader *self = calloc(1, sizeof *self);
    if (!self) return NULL;
    self->window = window;
    self->desc = desc;
    self->configured = reading->configured;
    self->aspect = reading->aspect;
    self->loaded.reread = reading->reread;
    self->loaded.folders = *reading->folders;
    snprintf(self->loaded.path, sizeof self->loaded.path, "%s", reading->path);
    snprintf(self->loaded.lobe, sizeof self->loaded.lobe, "%s", reading->lobe ? reading->lobe : "");
    snprintf(self->session, sizeof self->session, "%s", reading->session);
    atomic_init(&self->thousandths, -1);
    atomic_init(&self->done, false);
    atomic_init(&self->stop, false);
    if (pthread_create(&self->thread, NULL, work, self) == 0) return self;
    free(self);
    return NULL;
}

float loader_progress(Loader *self) { return (float)atomic_load(&self->thousandths) / 1000.0f; }

bool loader_done(Loader *self) { return atomic_load(&self->done); }

const char *loader_path(const Loader *self, bool *reread) {
    *reread = self->loaded.reread;
    return self->loaded.path;
}

void loader_stop(Loader *self) { atomic_store(&self->stop, true); }

void loader_finish(Loader *self, Loaded *loaded) {
    atomic_store(&self->stop, true);
    pthread_join(self->thread, NULL);
    if (loaded)
        *loaded = self->loaded;
    else
        loaded_free(&self->loaded);
    free(self);
}

void loaded_free(Loaded *loaded) {
    weft_scene_free(loaded->scene);
    scene_state_free(&loaded->state);
    facts_free(&loaded->facts);
    restored_free(&loaded->restored);
    free(loaded->warnings);
    *loaded = (Loaded){0};
}
