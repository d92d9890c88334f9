#include "cli/operands/model.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/path.h"
#include "cli/console/names.h"
#include "cli/console/report.h"

/* The kinds that a name is looked up in, in this order. */
static const char *const taken[] = {"lobe", "profile", "workflow", "preset"};
enum { KINDS = sizeof taken / sizeof *taken };

/* The parts of what was typed: kind, name and settings, each NULL if absent. */
typedef struct Parts {
    char text[1024];
    const Kind *kind;
    char *name, *settings;
} Parts;

/* Splits a name into kind, name, a file's material and settings. Settings follow a colon with a '=' after it; otherwise
 * a kind stands before a colon, or a file's material after it. */
static int split_name(const char *typed, Parts *parts) {
    *parts = (Parts){.kind = NULL};
    parts->name = parts->text;
    if (strlen(typed) >= sizeof parts->text) return report(WEFT_USAGE, "%.60s...: is too long a name", typed);
    snprintf(parts->text, sizeof parts->text, "%s", typed);
    for (size_t k = 0; k < KINDS; k++) {
        size_t n = strlen(taken[k]);
        if (strncmp(typed, taken[k], n) != 0 || typed[n] != ':') continue;
        parts->kind = kind_of(taken[k]);
        parts->name = parts->text + n + 1;
    }
    char *equals = strchr(parts->name, '='), *colon = NULL;
    if (equals)
        for (char *at = parts->name; at < equals; at++)
            if (*at == ':') colon = at;
    if (equals && !colon) return report(WEFT_USAGE, "%.200s: write " MODEL_FORM, typed);
    if (colon) {
        *colon = '\0';
        parts->settings = colon + 1;
    }
    return 0;
}

static void warned(void *user, WeftMessage message, const char *text) {
    char *last = user;
    (void)message;
    if (strcmp(last, text) != 0) report(0, "warning: %s", text);
    snprintf(last, sizeof((WeftError *)0)->text, "%s", text);
}

static int set_one(Model *model, const char *key, const char *value, const WeftLog *log) {
    WeftError error;
    WeftResult result = model->kind == MODEL_LOBE ? weft_lobe_set(&model->lobe, key, value, log, &error)
                                                  : weft_material_set(&model->material, key, value, log, &error);
    return result == WEFT_OK ? 0 : report_error(&error);
}

/* Applies KEY=VALUE,KEY=VALUE. A part without '=' belongs to the value before it, as the green in color=1,0.8,0.3. */
static int set_all(Model *model, char *settings) {
    WeftError last = {0};
    const WeftLog log = {.fn = warned, .user = last.text};
    int result = 0;
    for (char *key = settings; result == 0 && key;) {
        char *value = strchr(key, '='), *next = value ? value : key;
        if (!value || value == key) return report(WEFT_USAGE, "%.200s: \"%.80s\" is not KEY=VALUE", model->words, key);
        *value++ = '\0';
        do next = strchr(next == value - 1 ? value : next + 1, ',');
        while (next && !memchr(next + 1, '=', strcspn(next + 1, ",")));
        if (next) *next++ = '\0';
        result = set_one(model, key, value, &log);
        key = next;
    }
    return result;
}

static int of_lobe(Model *model, const char *id) {
    WeftError error;
    model->kind = MODEL_LOBE;
    return weft_lobe_init(id, &model->lobe, &error) == WEFT_OK ? 0 : report_error(&error);
}

/* Makes the material of a profile or workflow; choice is "profile" or "workflow". The material is a grey cloth unless
 * it is to be bare. */
static int of_choice(Model *model, const char *choice, const char *id) {
    static const char *const cloth[][2] = {
        {"base_color", "0.2"}, {"sheen_color", "1"}, {"sheen_roughness", "0.5"}, {"roughness", "1"}};
    WeftError error;
    weft_material_default(&model->material);
    WeftResult result = weft_material_set(&model->material, choice, id, NULL, &error);
    for (size_t k = 0; result == WEFT_OK && !model->bare && k < sizeof cloth / sizeof *cloth; k++)
        result = weft_material_set(&model->material, cloth[k][0], cloth[k][1], NULL, &error);
    return result == WEFT_OK ? 0 : report_error(&error);
}

static int of_material(Model *model, const char *path) {
    WeftError error, last = {0};
    const WeftLog log = {.fn = warned, .user = last.text};
    model->kind = MODEL_MATERIAL;
    WeftResult result = model->weaves ? weft_material_read_woven(path, &model->material, &model->cloth, &log, &error)
                                      : weft_material_read(path, &model->material, &log, &error);
    return result == WEFT_OK ? 0 : report_error(&error);
}

/* Returns the index of the material with that name or index; wanted may be NULL if there is only one. -1 after one
 * line. */
static int material_index(const WeftScene *scene, const char *path, const char *wanted) {
    int count = weft_scene_info(scene).material_count;
    if (!wanted && count == 1) return 0;
    if (!wanted) {
        report(WEFT_USAGE, "%.200s: has %d materials: name one as %.200s:MATERIAL", path, count, path);
        return -1;
    }
    char *end;
    for (int k = 0; k < count; k++)
        if (strcmp(weft_scene_material_name(scene, k), wanted) == 0) return k;
    long index = strtol(wanted, &end, 10);
    if (*wanted && !*end && index >= 0 && index < count) return (int)index;
    Nearest nearest = {.typed = wanted};
    char hint[96];
    for (int k = 0; k < count; k++) nearest_offer(&nearest, weft_scene_material_name(scene, k));
    report(WEFT_USAGE, "%.200s: is not a material of %.200s%s", wanted, path,
           nearest_hint(&nearest, hint, sizeof hint));
    return -1;
}

/* Takes the material without its textures, under its own name if it has one. */
static void take_material(Model *model, const char *name, const char *path) {
    bool textured = false;
    for (int k = 0; k < WEFT_INPUTS_MAX; k++) {
        textured |= model->material.inputs[k].texture != 0;
        model->material.inputs[k].texture = 0;
    }
    if (textured) report(0, "warning: %.200s: its textures are left out: only its numbers count here", path);
    if (*name) snprintf(model->name, sizeof model->name, "%s", name);
}

/* Takes the cloth that a material of a scene is woven of, if it is woven and the model allows it. */
static int take_cloth(Model *model, const WeftScene *scene, const char *path) {
    WeftError error;
    if (!weft_scene_cloth(scene, model->material.cloth, NULL)) return 0;
    if (!model->weaves) {
        report(0, "warning: %.200s: its weave is left out: only its numbers count here", path);
        return 0;
    }
    WeftResult result = weft_scene_cloth_copy(scene, model->material.cloth, &model->cloth, &error);
    return result == WEFT_OK ? 0 : report_error(&error);
}

static int of_scene(Model *model, const char *path, const char *wanted) {
    WeftError error;
    WeftScene *scene;
    model->kind = MODEL_MATERIAL;
    if (weft_scene_load(path, &scene, NULL, &error) != WEFT_OK) return report_error(&error);
    int index = material_index(scene, path, wanted), result = index < 0 ? WEFT_USAGE : 0;
    if (result == 0 && weft_scene_material(scene, index, &model->material, &error) != WEFT_OK)
        result = report_error(&error);
    if (result == 0) result = take_cloth(model, scene, path);
    if (result == 0) take_material(model, weft_scene_material_name(scene, index), path);
    weft_scene_free(scene);
    return result;
}

/* Returns true for words that begin with the name of a weave and name no file. */
static bool is_notation(const char *typed) {
    if (access(typed, F_OK) == 0) return false;
    for (int k = 0; weft_weave_name(k); k++) {
        const size_t size = strlen(weft_weave_name(k));
        if (strncmp(typed, weft_weave_name(k), size) == 0 && strchr(" ;", typed[size])) return true;
    }
    return false;
}

/* Makes the material of a draft that is woven of cotton, as the key draft of a weave does. Words are named by their
 * weave. */
static int of_draft(Model *model, const char *typed) {
    WeftError error, last = {0};
    const WeftLog log = {.fn = warned, .user = last.text};
    WeftScene *scene;
    model->kind = MODEL_MATERIAL;
    if (!path_is_draft(typed)) snprintf(model->name, sizeof model->name, "%.*s", (int)strcspn(typed, " ;"), typed);
    if (weft_scene_load("builtin:ball", &scene, NULL, &error) != WEFT_OK) return report_error(&error);
    WeftResult result = weft_scene_weave(scene, "ball", "draft", typed, &log, &error);
    if (result == WEFT_OK) result = weft_scene_weave(scene, "ball", "metres", "1", &log, &error);
    if (result == WEFT_OK) result = weft_scene_material(scene, 0, &model->material, &error);
    if (result == WEFT_OK) result = weft_scene_cloth_copy(scene, model->material.cloth, &model->cloth, &error);
    weft_scene_free(scene);
    return result == WEFT_OK ? 0 : report_error(&error);
}

/* Returns the end of the scene's path in "chair.glb:fabric"; NULL if text is not of that form. */
static char *scene_end(char *text) {
    for (char *end = text + strcspn(text, ":");; end += 1 + strcspn(end + 1, ":")) {
        char after = *end;
        *end = '\0';
        bool scene = path_ends(text, ".gltf") || path_ends(text, ".glb");
        *end = after;
        if (scene || !after) return scene ? end : NULL;
    }
}

static int report_unknown(const char *name) {
    char hint[96];
    Nearest nearest = {.typed = name};
    for (size_t k = 0; k < KINDS; k++)
        for (int n = 0; kind_of(taken[k])->name(n); n++) nearest_offer(&nearest, kind_of(taken[k])->name(n));
    return report(WEFT_USAGE, "%.200s: is not a lobe, a profile, a workflow, a preset or a file%s", name,
                  nearest.name ? nearest_hint(&nearest, hint, sizeof hint) : "; `weft models` lists them");
}

static int of_kind(Model *model, const Kind *kind, const char *name) {
    char path[160];
    const int index = kind_named(kind, name);
    if (index < 0) return WEFT_USAGE;
    name = kind->name(index); /* where an alias was typed */
    if (kind == kind_of("lobe")) return of_lobe(model, name);
    if (kind != kind_of("preset")) {
        model->kind = kind == kind_of("profile") ? MODEL_PROFILE : MODEL_WORKFLOW;
        return of_choice(model, kind->id, name);
    }
    snprintf(path, sizeof path, "preset:%.120s", name);
    return of_material(model, path);
}

static int of_name(Model *model, const Parts *parts) {
    if (parts->kind) return of_kind(model, parts->kind, parts->name);
    for (size_t k = 0; k < KINDS; k++)
        if (kind_find(kind_of(taken[k]), parts->name) >= 0) return of_kind(model, kind_of(taken[k]), parts->name);
    char *end = scene_end(parts->name);
    if (end) {
        const char *wanted = *end ? end + 1 : NULL;
        *end = '\0';
        return of_scene(model, parts->name, wanted);
    }
    if (path_ends(parts->name, ".json") || path_is_cloth(parts->name)) return of_material(model, parts->name);
    if (model->weaves && (path_is_draft(parts->name) || is_notation(parts->name))) return of_draft(model, parts->name);
    if (!weft_reflection_readable(parts->name)) return report_unknown(parts->name);
    model->kind = MODEL_MEASURED;
    snprintf(model->path, sizeof model->path, "%s", parts->name);
    return parts->settings ? report(WEFT_USAGE, "%.200s: nothing can be set in a measurement", parts->name) : 0;
}

/* Names the model by the last part of a path, up to its suffix; an id stays whole. */
static void name_after(Model *model, const char *path) {
    const char *slash = strrchr(path, '/'), *file = slash ? slash + 1 : path, *point = strchr(file, '.');
    size_t length = point && point > file ? (size_t)(point - file) : strlen(file);
    if (length >= sizeof model->name) length = sizeof model->name - 1;
    memcpy(model->name, file, length);
    model->name[length] = '\0';
}

static int parse(const char *typed, bool bare, bool weaves, Model *out) {
    Parts parts;
    memset(out, 0, sizeof *out);
    out->bare = bare;
    out->weaves = weaves;
    int result = split_name(typed, &parts);
    if (result != 0) return result;
    out->given = parts.settings != NULL;
    snprintf(out->words, sizeof out->words, "%s", typed);
    name_after(out, parts.name);
    result = of_name(out, &parts);
    if (result == 0 && parts.settings) result = set_all(out, parts.settings);
    if (result == 0) model_warn(out);
    return result;
}

void model_warn(const Model *model) {
    WeftError last = {0};
    const WeftLog log = {.fn = warned, .user = last.text};
    if (model->kind == MODEL_LOBE)
        weft_lobe_fitted(&model->lobe, model->name, &log);
    else if (model_is_material(model))
        weft_material_fitted(&model->material, model->name, &log);
}

int model_parse(const char *typed, Model *out) { return parse(typed, false, false, out); }

int model_parse_bare(const char *typed, Model *out) { return parse(typed, true, true, out); }

int model_prepare(Model *model) {
    WeftError error;
    weft_reflection_free(model->reflection);
    model->reflection = NULL;
    WeftResult result = model->kind == MODEL_LOBE ? weft_reflection_of_lobe(&model->lobe, &model->reflection, &error)
                        : model->kind == MODEL_MEASURED
                            ? weft_reflection_read(model->path, &model->reflection, &error)
                            : weft_reflection_create_woven(&model->material, model->cloth, &model->reflection, &error);
    return result == WEFT_OK ? 0 : report_error(&error);
}

int model_read(const char *typed, Model *out) {
    int result = parse(typed, false, true, out);
    return result == 0 ? model_prepare(out) : result;
}

bool model_is_material(const Model *model) { return model->kind != MODEL_LOBE && model->kind != MODEL_MEASURED; }

void model_free(Model *model) {
    weft_cloth_free(model->cloth);
    model->cloth = NULL;
    weft_reflection_free(model->reflection);
    model->reflection = NULL;
}
